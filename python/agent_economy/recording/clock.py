"""When in a recording each step is."""

from agent_economy.recording.foxglove import SECOND_NS


class Clock:
    """Times that only grow, as files in MCAP have them, also if steps become shorter on the way.

    Each step lasts as long as it did when it was taken: a classic run's clock can be changed, and
    its own times are then as if it had always gone so.
    """

    def __init__(self, step_s: float) -> None:
        """Begin at the run's beginning."""
        self._step_s = step_s
        self._since, self._since_ns = 0, 0

    def go_on(self, tick: int, step_s: float) -> None:
        """From a tick on, have steps take so long."""
        if step_s != self._step_s:
            self._since, self._since_ns = tick, self.time_ns(tick)
            self._step_s = step_s

    def time_ns(self, tick: int) -> int:
        """Return when a tick is, which is none before the last change."""
        return self._since_ns + round((tick - self._since) * self._step_s * SECOND_NS)

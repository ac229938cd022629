"""The times of steps in a recording."""

from agent_economy.recording.foxglove import SECOND_NS


class Clock:
    """Ascending times, as MCAP requires, also if the length of a step changes during the run.

    Each step keeps the length that it had when it was taken. The clock of a classic run can be
    changed, and the times of the run itself are then as if it had never been different.
    """

    def __init__(self, step_s: float) -> None:
        """Start at step 0."""
        self._step_s = step_s
        self._since, self._since_ns = 0, 0

    def set_step(self, tick: int, step_s: float) -> None:
        """Set the length of the steps from a tick on."""
        if step_s != self._step_s:
            self._since, self._since_ns = tick, self.time_ns(tick)
            self._step_s = step_s

    def time_ns(self, tick: int) -> int:
        """Return the time of a tick, which must not be before the last change."""
        return self._since_ns + round((tick - self._since) * self._step_s * SECOND_NS)

"""Steps at the pace of the clock."""

from dataclasses import dataclass

MIN_PERIOD = 0.9
"""Shortest time between two steps, as a share of the period: the run makes up for 1 s in 9 s."""


@dataclass
class Pacer:
    """The due times of ticks.

    After a late tick, the run is behind the clock. Ticks are then due 10% earlier until both agree
    again; they never come in a burst, because each needs percepts of its own time.

    Attributes:
        period_s: Time between two ticks.
        start_s: When the drive started: tick 0 is due then, and tick n n periods later.
        due_s: When the next tick is due.
        late_ticks: Number of ticks that were more than a period late.
        behind_s: Time by which the run was behind the clock at the last tick.
        max_behind_s: The longest such time after a late tick.
    """

    period_s: float
    start_s: float
    due_s: float
    late_ticks: int = 0
    behind_s: float = 0.0
    max_behind_s: float = 0.0
    _ticks: int = 0

    @property
    def slew_s(self) -> float:
        """Time in which the run makes up for the time that it is behind."""
        return self.behind_s * MIN_PERIOD / (1 - MIN_PERIOD)

    def counts(self) -> dict[str, float]:
        """Return what the warden reports of ticks that were late."""
        return {
            "late_steps": self.late_ticks,
            "behind_s": self.behind_s,
            "max_behind_s": self.max_behind_s,
        }

    def tick(self, now_s: float) -> float:
        """Take a tick; return by how much it is late, in seconds."""
        late_s = max(0.0, now_s - self.due_s)
        self.behind_s = max(0.0, now_s - self._nominal_s())
        if late_s >= self.period_s:
            self.late_ticks += 1
            self.max_behind_s = max(self.max_behind_s, self.behind_s)
        self._ticks += 1
        self.due_s = max(self._nominal_s(), now_s + MIN_PERIOD * self.period_s)
        return late_s

    def _nominal_s(self) -> float:
        # A product: a sum of periods would drift by its rounding errors.
        return self.start_s + self._ticks * self.period_s

"""Steps at the pace of the clock."""

from dataclasses import dataclass


@dataclass
class Pacer:
    """The due times of ticks. A late tick is never made up for: the run falls behind instead.

    Attributes:
        period_s: Time between two ticks.
        due_s: When the next tick is due.
        late_ticks: Number of ticks that were more than a period late.
        behind_s: Time by which the run is behind the clock.
    """

    period_s: float
    due_s: float
    late_ticks: int = 0
    behind_s: float = 0.0

    def tick(self, now_s: float) -> float:
        """Take a tick; return by how much it is late, in seconds."""
        late_s = max(0.0, now_s - self.due_s)
        self.due_s += self.period_s
        if late_s >= self.period_s:
            self.late_ticks += 1
            self.behind_s += now_s - self.due_s + self.period_s
            self.due_s = now_s + self.period_s
        return late_s

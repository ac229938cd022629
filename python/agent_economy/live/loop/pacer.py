"""Steps at the pace of the clock."""

from dataclasses import dataclass

MIN_PERIOD = 0.9
"""Shortest time between two steps, as a share of the period: the run makes up for 1 s in 9 s."""

REPORTED_S = 5.0
"""Time behind the clock that is reported, as after a suspension, or with brains that are slow."""


@dataclass
class Pacer:
    """The due times of ticks.

    After a late tick, the run is behind the clock. Ticks are then due 10% earlier until both agree
    again; they never come in a burst, because each needs percepts of its own time.

    Attributes:
        period_s: Time between two ticks.
        start_s: When tick 0 is due, a period after the drive started; tick n is n periods later.
        due_s: When the next tick is due.
        late_ticks: Number of ticks that were more than a period later than they were due. The next
            one is due 0.9 periods after each, so that none is late if all take less than 1.9.
        behind_s: Time by which the run was behind the clock at the last tick.
        max_behind_s: The longest such time.
    """

    period_s: float
    start_s: float
    due_s: float
    late_ticks: int = 0
    behind_s: float = 0.0
    max_behind_s: float = 0.0
    _ticks: int = 0
    _first_behind_s: float = 0.0
    _report_s: float = REPORTED_S

    @property
    def slew_s(self) -> float:
        """Time in which the run makes up for the time that it is behind."""
        return self.behind_s * MIN_PERIOD / (1 - MIN_PERIOD)

    @property
    def was_late(self) -> bool:
        """Whether a tick was late, or the run has fallen behind by more than a period.

        It is behind at its first tick already: by the time that the start took.
        """
        return bool(self.late_ticks) or self.max_behind_s > self._first_behind_s + self.period_s

    def counts(self) -> dict[str, float]:
        """Return what the warden reports of ticks that were late."""
        return {
            "was_late": self.was_late,
            "late_steps": self.late_ticks,
            "behind_s": self.behind_s,
            "max_behind_s": self.max_behind_s,
        }

    def tick(self, now_s: float) -> float:
        """Take a tick; return by how much it is late, in seconds."""
        late_s = max(0.0, now_s - self.due_s)
        self.behind_s = max(0.0, now_s - self._nominal_s())
        self.max_behind_s = max(self.max_behind_s, self.behind_s)
        if self._ticks == 0:
            self._first_behind_s = self.behind_s
        self.late_ticks += late_s >= self.period_s
        self._ticks += 1
        self.due_s = max(self._nominal_s(), now_s + MIN_PERIOD * self.period_s)
        return late_s

    def must_report(self) -> bool:
        """Return whether the run is so far behind the clock that it has to be reported.

        It is reported again when it is twice as far behind.
        """
        must = self.behind_s > self._report_s
        limit_s = 2 * self.behind_s
        self._report_s = max(REPORTED_S, limit_s if must else min(self._report_s, limit_s))
        return must

    def _nominal_s(self) -> float:
        # A product: a sum of periods would drift by its rounding errors.
        return self.start_s + self._ticks * self.period_s

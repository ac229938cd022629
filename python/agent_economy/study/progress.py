"""The progress of a study."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.requirement_results import Status
from agent_economy.study.selection import Elimination

MAX_LEADERS = 50
"""Maximum number of configurations with intervals in a progress report."""

MAX_SHOWN = 10
"""Maximum number of its leaders."""

ROUND_S = 0.5
"""Interval of progress reports during a round."""


@dataclass(frozen=True)
class Leader:
    """One of the leading configurations.

    Attributes:
        configuration: Its index.
        runs: Number of runs.
        merit: Mean merit; with a requirement, the share of runs that meet it.
        status: With a requirement, what is known of it; else None.
    """

    configuration: int
    runs: int
    merit: float
    status: Status | None = None

    def facts(self) -> list[int | float | str]:
        """Return what the ledger stores of it."""
        status = [self.status] if self.status else []
        return [self.configuration, self.runs, self.merit, *status]


LeaderInterval = tuple[Leader, Interval]
Range = tuple[float, float]
"""The lower and the upper end of an estimate."""

NOTHING: Range = (0.0, 0.0)
"""What is left of a study that is over."""


@dataclass(frozen=True)
class Progress:
    """The progress of a study, or of a selection, after a round or during a long one.

    Attributes:
        round: Completed rounds.
        runs: Runs of all configurations, including stored ones and those of the current round.
        computed: Those of them that this process computed.
        seconds: Seconds since the start.
        survivors: Remaining configurations.
        leaders: The best of them by their current estimates; with a requirement, the dearest
            configurations that have runs, the cheapest first.
        eliminated: Configurations that the completed round eliminated.
        certified: With a requirement, the certified configurations; else None.
        may_meet: With a requirement, those that are eliminated, but may meet it without tolerance
            to spare.
        is_over: Whether it was the last round.
        estimate_remaining: Returns the range of the number of runs left, which is 0 after the last
            round; None if it is unknown. Takes milliseconds.
        intervals: Returns more of the leaders, each with its mean merit and bounds that hold
            simultaneously with all of the answer's. Takes milliseconds.
    """

    round: int
    runs: int
    computed: int
    seconds: float
    survivors: int
    leaders: tuple[Leader, ...]
    eliminated: tuple[Elimination, ...]
    certified: tuple[int, ...] | None
    may_meet: frozenset[int]
    is_over: bool
    estimate_remaining: Callable[[], Range | None]
    intervals: Callable[[], tuple[LeaderInterval, ...]]

    def facts(self) -> dict[str, Any]:
        """Return what the ledger stores of the round: facts that follow from the data alone."""
        facts: dict[str, Any] = {
            "runs": self.runs,
            "survivors": self.survivors,
            "leaders": [each.facts() for each in self.leaders],
            "eliminated": [[each.configuration, each.by, each.runs] for each in self.eliminated],
            "is_over": self.is_over,
        }
        return facts if self.certified is None else {**facts, "certified": list(self.certified)}

    def time_left_s(self, remaining: Range | None) -> Range | None:
        """Return the range of the time in which a range of runs is computed; None if unknown."""
        if remaining == NOTHING:
            return NOTHING
        if remaining is None or not (self.computed and self.seconds):
            return None
        low, high = remaining
        rate = self.computed / self.seconds
        return low / rate, high / rate

    @classmethod
    def of_facts(
        cls, number: int, facts: Mapping[str, Any], computed: int, seconds: float
    ) -> "Progress":
        """Return a round from the ledger, without intervals; what remains is known of the last."""
        return cls(
            round=number + 1,
            runs=facts["runs"],
            computed=computed,
            seconds=seconds,
            survivors=facts["survivors"],
            leaders=(leaders := tuple(Leader(*each) for each in facts["leaders"])),
            eliminated=tuple(Elimination(*each) for each in facts["eliminated"]),
            certified=tuple(facts["certified"]) if "certified" in facts else None,
            may_meet=frozenset(each.configuration for each in leaders if each.status == "may meet"),
            is_over=facts["is_over"],
            estimate_remaining=lambda: NOTHING if facts["is_over"] else None,
            intervals=tuple,
        )


OnProgress = Callable[[Progress], None]

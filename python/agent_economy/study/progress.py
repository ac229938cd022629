"""The progress of a study."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.selection import Elimination


@dataclass(frozen=True)
class Leader:
    """One of the leading configurations."""

    configuration: int
    runs: int
    merit: float


LeaderInterval = tuple[Leader, Interval]


@dataclass(frozen=True)
class Progress:
    """The progress of a study after a round, or during a long one.

    Attributes:
        round: Completed rounds.
        runs: Runs of all configurations, including stored ones and those of the current round.
        computed: Those of them that this process computed.
        seconds: Seconds since the start.
        survivors: Remaining configurations.
        leaders: The best of them by their current estimates.
        eliminated: Configurations that the completed round eliminated.
        is_over: Whether it was the last round.
        estimate_remaining: Returns the approximate number of runs left; None if it is unknown.
            Takes milliseconds.
        intervals: Returns the best of the survivors, each with its mean merit and bounds that hold
            simultaneously with all of the answer's. Takes milliseconds.
    """

    round: int
    runs: int
    computed: int
    seconds: float
    survivors: int
    leaders: tuple[Leader, ...]
    eliminated: tuple[Elimination, ...]
    is_over: bool
    estimate_remaining: Callable[[], float | None]
    intervals: Callable[[], tuple[LeaderInterval, ...]]

    def facts(self) -> dict[str, Any]:
        """Return what the ledger stores of the round: facts that follow from the data alone."""
        return {
            "runs": self.runs,
            "survivors": self.survivors,
            "leaders": [[each.configuration, each.runs, each.merit] for each in self.leaders],
            "eliminated": [[each.configuration, each.by, each.runs] for each in self.eliminated],
            "is_over": self.is_over,
        }

    @classmethod
    def of_facts(
        cls, number: int, facts: Mapping[str, Any], computed: int, seconds: float
    ) -> "Progress":
        """Return a round from the ledger, without intervals and an estimate of remaining work."""
        return cls(
            round=number + 1,
            runs=facts["runs"],
            computed=computed,
            seconds=seconds,
            survivors=facts["survivors"],
            leaders=tuple(Leader(*each) for each in facts["leaders"]),
            eliminated=tuple(Elimination(*each) for each in facts["eliminated"]),
            is_over=facts["is_over"],
            estimate_remaining=lambda: None,
            intervals=tuple,
        )


OnProgress = Callable[[Progress], None]

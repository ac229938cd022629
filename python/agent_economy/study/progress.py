"""What watchers of a study are told."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.selection import Elimination


@dataclass(frozen=True)
class Leader:
    """One of the best so far."""

    configuration: int
    runs: int
    merit: float


Ranged = tuple[Leader, Interval]


@dataclass(frozen=True)
class Progress:
    """How far a study is: after a round, or while a long one goes on.

    Attributes:
        round: Rounds over.
        runs: Runs of all configurations, the stored ones included, and of the round that goes on.
        computed: Those of them that this process had to compute.
        seconds: Since it began.
        survivors: Configurations still in.
        leaders: The best of them so far.
        eliminated: Those put out by the round that is over now, and by whom.
        is_over: Whether it was the last round.
        foretell: Returns about how many runs are left; None if nobody can say. It takes a moment.
        ranged: Returns the best of the survivors, each with its mean merit and bounds that hold
            with all of the answer's. It takes a moment.
    """

    round: int
    runs: int
    computed: int
    seconds: float
    survivors: int
    leaders: tuple[Leader, ...]
    eliminated: tuple[Elimination, ...]
    is_over: bool
    foretell: Callable[[], float | None]
    ranged: Callable[[], tuple[Ranged, ...]]

    def facts(self) -> dict[str, Any]:
        """Return what the ledger keeps of the round: what follows from the data alone."""
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
        """Return a round as the ledger keeps it: without ranges, or how many runs are left."""
        return cls(
            round=number + 1,
            runs=facts["runs"],
            computed=computed,
            seconds=seconds,
            survivors=facts["survivors"],
            leaders=tuple(Leader(*each) for each in facts["leaders"]),
            eliminated=tuple(Elimination(*each) for each in facts["eliminated"]),
            is_over=facts["is_over"],
            foretell=lambda: None,
            ranged=tuple,
        )


OnProgress = Callable[[Progress], None]

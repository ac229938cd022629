"""Which configurations are as good as the best, which are worse, and which is not known."""

from dataclasses import dataclass
from typing import Literal

from agent_economy.study.evidence import Evidence, Interval

Verdict = Literal["best", "tied", "worse", "undecided"]


@dataclass(frozen=True)
class Standing:
    """How far a configuration is behind the selected one.

    Attributes:
        behind: The selected one's mean merit less this one's; None for the selected one itself.
        verdict: "tied": the two differ by delta at most, for sure. "worse": for sure, if perhaps by
            little. "undecided": the runs leave it open.
    """

    behind: Interval | None
    verdict: Verdict


def standings(evidence: Evidence, best: int, delta: float) -> tuple[Standing, ...]:
    """Return how each configuration stands to the selected one."""
    return tuple(
        Standing(None, "best") if other == best else standing(evidence, best, other, delta)
        for other in range(len(evidence.samples))
    )


def standing(evidence: Evidence, best: int, other: int, delta: float) -> Standing:
    """Return how one configuration stands to the selected one."""
    behind = evidence.difference(best, other, "merit")
    if -delta <= behind.low and behind.high <= delta:
        return Standing(behind, "tied")
    return Standing(behind, "worse" if behind.low > 0 else "undecided")

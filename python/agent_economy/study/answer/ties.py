"""Which configurations are as good as the best, which are worse, and which is not known."""

from dataclasses import dataclass
from typing import Literal

from agent_economy.study.answer.evidence import Evidence, Interval

Verdict = Literal["best", "tied", "worse", "no better", "undecided"]


@dataclass(frozen=True)
class Standing:
    """How far a configuration is behind the selected one.

    Attributes:
        behind: The selected one's mean merit less this one's; None for the selected one itself.
        verdict: "tied": for sure, the two differ by delta at most. "worse": for sure, if perhaps by
            little. "no better": for sure, it is not better by more than delta; whether it is worse
            is open. "undecided": even that is open.
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
    if behind.low > 0:
        return Standing(behind, "worse")
    return Standing(behind, "no better" if behind.low >= -delta else "undecided")

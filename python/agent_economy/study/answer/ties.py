"""Which configurations are tied with the selected one, which are worse, and which are undecided."""

from dataclasses import dataclass
from typing import Literal

from agent_economy.study.answer.evidence import Evidence, Interval

Verdict = Literal["best", "tied", "worse", "not better", "undecided", "impossible"]

VERDICT_TEXT: dict[Verdict, str] = {
    "best": "selected",
    "tied": "tied within delta",
    "worse": "worse",
    "not better": "not better by delta",
    "undecided": "undecided",
    "impossible": "cannot be run",
}


@dataclass(frozen=True)
class Standing:
    """The comparison of a configuration with the selected one.

    Attributes:
        behind: The selected one's mean merit minus this one's; None for the selected one itself,
            and for one that cannot be run.
        verdict: The proved statement. "tied": the two differ by at most delta. "worse": its mean
            merit is lower. "not better": it is not better by more than delta, but may be worse.
            "undecided": none of these. "impossible": all of its runs are quarantined, so it was not
            compared.
    """

    behind: Interval | None
    verdict: Verdict


def standings(evidence: Evidence, best: int, delta: float) -> tuple[Standing, ...]:
    """Return the comparison of each configuration with the selected one."""
    return tuple(
        Standing(None, "best") if other == best else standing(evidence, best, other, delta)
        for other in range(len(evidence.samples))
    )


def standing(evidence: Evidence, best: int, other: int, delta: float) -> Standing:
    """Return the comparison of one configuration with the selected one."""
    if not evidence.samples[other].is_possible:
        return Standing(None, "impossible")
    behind = evidence.difference(best, other, "merit")
    if -delta <= behind.low and behind.high <= delta:
        return Standing(behind, "tied")
    if behind.low > 0:
        return Standing(behind, "worse")
    return Standing(behind, "not better" if behind.low >= -delta else "undecided")

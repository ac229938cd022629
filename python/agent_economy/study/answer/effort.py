"""What a finer answer would take: the runs that a smaller delta asks for, foretold.

A duel of the selected configuration with another ends when its evidence e reaches the threshold T.
Per run, log e grows by about (d + delta)^2 / (2 v), for a difference of means d with variance v
(the best bet's growth, to second order), and bets cannot exceed their limit, so by no more than
half of (d + delta) / depth. The sum over all configurations, scaled so that it is right for the
delta that was asked, is what another delta takes.
"""

import math
from dataclasses import dataclass

from agent_economy.study.answer.evidence import Evidence

PARTS = (2, 5, 10)
"""Into which the delta asked is divided."""


SMALLEST = 1e-100
"""Lead below which nobody waits for the end."""


@dataclass(frozen=True)
class Asked:
    """What a duel must prove, and against how many rivals in all."""

    delta: float
    rivals: int


@dataclass(frozen=True)
class Effort:
    """About how many runs a study with another delta takes in all."""

    delta: float
    runs: int


def efforts(evidence: Evidence, best: int, delta: float) -> tuple[Effort, ...]:
    """Return about how many runs smaller deltas take; none for one configuration."""
    if len(evidence.samples) == 1:
        return ()
    total = sum(sample.runs for sample in evidence.samples)
    scale = total / foretold(evidence, best, delta)
    return tuple(
        Effort(delta / part, two_figures(scale * foretold(evidence, best, delta / part)))
        for part in PARTS
    )


def remaining(survivors: Evidence, best: int, delta: float, rivals: int) -> float:
    """Return about how many runs a race still takes, from the runs of those still in."""
    left = [
        max(0.0, duel_runs(survivors, best, other, Asked(delta, rivals)) - sample.runs)
        for other, sample in enumerate(survivors.samples)
        if other != best
    ]
    return sum(left) + max(left, default=0.0)


def foretold(evidence: Evidence, best: int, delta: float) -> float:
    """Return the runs that a study takes, up to a factor."""
    others = [
        duel_runs(evidence, best, other, Asked(delta, len(evidence.samples) - 1))
        for other in range(len(evidence.samples))
        if other != best
    ]
    return sum(others) + max(others)


def duel_runs(evidence: Evidence, best: int, other: int, asked: Asked) -> float:
    """Return the runs after which the selected configuration puts another out."""
    champion, challenger = evidence.samples[best], evidence.samples[other]
    runs = min(champion.runs, challenger.runs)
    differences = champion.columns["merit"][:runs] - challenger.columns["merit"][:runs]
    lead = max(max(float(differences.mean()), 0.0) + asked.delta, SMALLEST)
    depth = challenger.limits["merit"][1] - champion.limits["merit"][0]
    goal = math.log(asked.rivals / (1 - evidence.confidence))
    fastest = max(0.0, 2 * depth / lead)
    return goal * max(2 * (float(differences.std()) / lead) ** 2, fastest) + 1


def two_figures(number: float) -> int:
    """Return a number to two figures."""
    return int(float(f"{number:.1e}"))

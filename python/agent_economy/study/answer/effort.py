"""The runs that smaller deltas would take, predicted from the runs of a study.

The test of the selected configuration against another ends when its evidence e reaches the
threshold T. Per run, log e grows by about (d + delta)^2 / (2 v), for a difference of means d with
variance v (the growth of the best bet, to second order), but by no more than half of
(d + delta) / depth, because bets are limited. The sum over all configurations, scaled to the actual
number of runs for the study's delta, predicts the number for another delta.
"""

import math
from dataclasses import dataclass

from agent_economy.study.answer.evidence import Evidence

PARTS = (2, 5, 10)
"""Divisors of the study's delta."""


MIN_ROUNDS = 12
"""Rounds before which the runs of a study are too few to predict the others."""

SPREAD = (1 / 2, 3)
"""Ends of the range of the remaining runs, as parts of their prediction, which is often too low: it
takes the current lead for the true one. Measured: the actual number was within this range in two of
three rounds of 75 studies of `classic`, and in three of four rounds of 12 studies of `search`.
"""

SMALLEST = 1e-100
"""Lower limit of a lead, to avoid a division by zero."""


@dataclass(frozen=True)
class Target:
    """The hypothesis that a test must prove, and the total number of rivals."""

    delta: float
    rivals: int


@dataclass(frozen=True)
class Effort:
    """The predicted number of runs of a study with another delta."""

    delta: float
    runs: int


def efforts(evidence: Evidence, best: int, delta: float) -> tuple[Effort, ...]:
    """Return the predicted runs for smaller deltas; none for one configuration.

    Those that cannot be run have the same few runs for any delta.
    """
    possible = [each for each, sample in enumerate(evidence.samples) if sample.is_possible]
    others = sum(sample.runs for sample in evidence.samples if not sample.is_possible)
    best = possible.index(best)
    evidence = Evidence(tuple(evidence.samples[each] for each in possible), evidence.confidence)
    if len(possible) == 1:
        return ()
    total = sum(sample.runs for sample in evidence.samples)
    scale = total / predicted_runs(evidence, best, delta)
    return tuple(
        Effort(
            delta / part,
            two_figures(others + scale * predicted_runs(evidence, best, delta / part)),
        )
        for part in PARTS
    )


def remaining_runs(survivors: Evidence, best: int, delta: float, rivals: int) -> float:
    """Return the predicted number of runs until a race ends, from the runs of its survivors."""
    missing = [
        max(0.0, test_runs(survivors, best, other, Target(delta, rivals)) - sample.runs)
        for other, sample in enumerate(survivors.samples)
        if other != best
    ]
    return sum(missing) + max(missing, default=0.0)


def remaining_range(expected: float, of_round: int, most: float) -> tuple[float, float]:
    """Return the range of the remaining runs of a race.

    Args:
        expected: Their predicted number.
        of_round: Number of runs of the next round, which are computed in any case.
        most: The run budget that is left.
    """
    low, high = (end * max(expected, of_round) for end in SPREAD)
    return min(max(low, of_round), most), min(high, most)


def predicted_runs(evidence: Evidence, best: int, delta: float) -> float:
    """Return the predicted runs of a study, up to a constant factor."""
    others = [
        test_runs(evidence, best, other, Target(delta, len(evidence.samples) - 1))
        for other in range(len(evidence.samples))
        if other != best
    ]
    return sum(others) + max(others)


def test_runs(evidence: Evidence, best: int, other: int, target: Target) -> float:
    """Return the predicted runs until the selected configuration eliminates another."""
    champion, challenger = evidence.samples[best], evidence.samples[other]
    runs = min(champion.runs, challenger.runs)
    differences = champion.columns["merit"][:runs] - challenger.columns["merit"][:runs]
    lead = max(max(float(differences.mean()), 0.0) + target.delta, SMALLEST)
    depth = challenger.limits["merit"][1] - champion.limits["merit"][0]
    goal = math.log(target.rivals / (1 - evidence.confidence))
    fastest = max(0.0, 2 * depth / lead)
    return goal * max(2 * (float(differences.std()) / lead) ** 2, fastest) + 1


def two_figures(number: float) -> int:
    """Return a number to two figures."""
    return int(float(f"{number:.1e}"))

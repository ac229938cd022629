"""The front of price, time and success: which configurations somebody might want.

A configuration is dominated by one that costs no more, takes no longer and fails no more often, and
is better in one of these. It is *surely dominated* when the runs prove that of some other; all
others are *possibly efficient*.
"""

from dataclasses import dataclass

import numpy as np

from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.arguments import Floats

JUDGED = ("robots", "time_s", "failed")
TIME = JUDGED.index("time_s")

CANDIDATES = 20
"""Rivals that are tried against a configuration, those with the shortest times."""


@dataclass(frozen=True)
class Place:
    """A configuration's place: its price in robots, and who surely dominates it, if anybody."""

    price: float
    dominated_by: int | None


def front(evidence: Evidence) -> tuple[Place, ...]:
    """Return the place of each configuration."""
    means = np.array([[each.mean(name) for name in JUDGED] for each in evidence.samples])
    return tuple(
        Place(sample.mean("robots"), dominator(evidence, means, index))
        for index, sample in enumerate(evidence.samples)
    )


def dominator(evidence: Evidence, means: Floats, index: int) -> int | None:
    """Return the fastest of those that surely dominate a configuration; None if nobody does."""
    # Where the means do not say so, the runs cannot prove it.
    apparent = np.flatnonzero((means <= means[index]).all(axis=1))
    fastest = apparent[np.argsort(means[apparent, TIME], kind="stable")]
    rivals = fastest[fastest != index][:CANDIDATES].tolist()
    return next((rival for rival in rivals if surely_dominates(evidence, rival, index)), None)


def surely_dominates(evidence: Evidence, rival: int, index: int) -> bool:
    """Return whether the runs prove that a rival that costs no more is faster and fails less."""
    slower = evidence.exceeds(index, rival, "time_s")
    return slower and evidence.exceeds(index, rival, "failed")

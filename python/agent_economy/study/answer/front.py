"""The Pareto front of price, time and failures.

A configuration is *dominated* by another if the runs prove that the other is faster and fails less
often, at no higher price. All others are *possibly efficient*.
"""

from dataclasses import dataclass

import numpy as np

from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.arguments import Floats

TIME = 1

CANDIDATES = 20
"""Maximum number of rivals compared with a configuration, those with the shortest times."""


@dataclass(frozen=True)
class Place:
    """A configuration's price, and the index of one that dominates it, if any.

    The price is that of the team; if no robot has a price, it is the number of robots.
    """

    price: float
    dominated_by: int | None


def front(evidence: Evidence) -> tuple[Place, ...]:
    """Return the place of each configuration."""
    means = np.array(
        [
            [evidence.price(index), sample.mean("time_s"), sample.mean("failed")]
            for index, sample in enumerate(evidence.samples)
        ]
    )
    return tuple(
        Place(evidence.price(index), dominator(evidence, means, index))
        for index in range(len(evidence.samples))
    )


def dominator(evidence: Evidence, means: Floats, index: int) -> int | None:
    """Return the fastest of those that dominate a configuration, None if there is none."""
    # Without lower means, the runs cannot prove it.
    apparent = np.flatnonzero((means <= means[index]).all(axis=1))
    fastest = apparent[np.argsort(means[apparent, TIME], kind="stable")]
    rivals = fastest[fastest != index][:CANDIDATES].tolist()
    return next((rival for rival in rivals if dominates(evidence, rival, index)), None)


def dominates(evidence: Evidence, rival: int, index: int) -> bool:
    """Return whether the runs prove that a rival of no higher price is faster and fails less."""
    slower = evidence.exceeds(index, rival, "time_s")
    return slower and evidence.exceeds(index, rival, "failed")

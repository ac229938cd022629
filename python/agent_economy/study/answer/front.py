"""The front of price, time and success: which configurations somebody might want.

A configuration is dominated by one that costs no more, takes no longer and fails no more often, and
is better in one of these. It is *surely dominated* when the runs prove that of some other; all
others are *possibly efficient*.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.study.answer.evidence import Evidence, Sample

CANDIDATES = 20
"""Rivals that are tried against a configuration, those with the shortest times."""


@dataclass(frozen=True)
class Place:
    """A configuration's place: its price in robots, and who surely dominates it, if anybody."""

    price: float
    dominated_by: int | None


def front(evidence: Evidence) -> tuple[Place, ...]:
    """Return the place of each configuration."""
    return tuple(
        Place(sample.mean("robots"), next(dominators(evidence, index), None))
        for index, sample in enumerate(evidence.samples)
    )


def dominators(evidence: Evidence, index: int) -> Iterator[int]:
    """Return those that surely dominate a configuration, the fastest first."""
    samples = evidence.samples
    apparent = [
        rival
        for rival in range(len(samples))
        if rival != index and seems_to_dominate(samples[rival], samples[index])
    ]
    apparent.sort(key=lambda rival: samples[rival].mean("time_s"))
    for rival in apparent[:CANDIDATES]:
        if surely_dominates(evidence, rival, index):
            yield rival


def seems_to_dominate(rival: Sample, sample: Sample) -> bool:
    """Return whether the means say so: without that, the runs cannot prove it."""
    return all(rival.mean(name) <= sample.mean(name) for name in ("robots", "time_s", "failed"))


def surely_dominates(evidence: Evidence, rival: int, index: int) -> bool:
    """Return whether the runs prove that a rival that costs no more is faster and fails less."""
    slower = evidence.exceeds(index, rival, "time_s")
    return slower and evidence.exceeds(index, rival, "failed")

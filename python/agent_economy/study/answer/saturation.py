"""The smallest team such that no larger one gains more than its extra robots cost.

The merit counts what robots cost, so a larger team gains more than it costs if its merit is higher.
All else is as in the selected configuration.
"""

from dataclasses import dataclass

from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.answer.labels import robot_kind


@dataclass(frozen=True)
class Saturation:
    """Where a team stops to be worth enlarging.

    Attributes:
        path: Of the team size.
        proved: The smallest size of which it is proved that no larger one that was compared gains
            delta more than its extra robots cost; None if of none but the largest.
        possible: The smallest size of which the contrary is not proved. Equal to `proved`: decided.
        gains: Of each size above `proved` (or `possible`, if none is), its merit less that one's.
    """

    path: str
    proved: int | None
    possible: int
    gains: dict[int, Interval]


def saturations(evidence: Evidence, best: int, delta: float) -> tuple[Saturation, ...]:
    """Return where each team size saturates, of which there are several to compare."""
    slices = {path: team_slice(evidence, best, path) for path in team_paths(evidence)}
    return tuple(
        saturation(evidence, path, sizes, delta) for path, sizes in slices.items() if len(sizes) > 1
    )


def team_paths(evidence: Evidence) -> list[str]:
    """Return the paths of factors that are team sizes."""
    return [path for path in evidence.samples[0].values if robot_kind(path) is not None]


def team_slice(evidence: Evidence, best: int, path: str) -> dict[int, int]:
    """Return configurations by team size, ascending, that differ from the best in it alone."""
    fixed = {**evidence.samples[best].values, path: None}
    sizes = {
        int(sample.values[path]): index
        for index, sample in enumerate(evidence.samples)
        if {**sample.values, path: None} == fixed
    }
    return dict(sorted(sizes.items()))


def saturation(evidence: Evidence, path: str, sizes: dict[int, int], delta: float) -> Saturation:
    """Return where one team size saturates."""
    smaller = list(sizes)[:-1]
    proved = next((size for size in smaller if is_proved(evidence, sizes, size, delta)), None)
    possible = next(size for size in sizes if not is_refuted(evidence, sizes, size))
    least = possible if proved is None else proved
    gains = {
        larger: evidence.difference(sizes[larger], sizes[least], "merit")
        for larger in above(sizes, least)
    }
    return Saturation(path, proved, possible, gains)


def above(sizes: dict[int, int], size: int) -> list[int]:
    """Return the larger sizes."""
    return [larger for larger in sizes if larger > size]


def is_proved(evidence: Evidence, sizes: dict[int, int], size: int, delta: float) -> bool:
    """Return whether no larger team gains delta more than it costs, for sure."""
    return all(
        evidence.exceeds(sizes[size], sizes[larger], "merit", by=-delta)
        for larger in above(sizes, size)
    )


def is_refuted(evidence: Evidence, sizes: dict[int, int], size: int) -> bool:
    """Return whether some larger team gains more than it costs, for sure."""
    return any(
        evidence.exceeds(sizes[larger], sizes[size], "merit") for larger in above(sizes, size)
    )

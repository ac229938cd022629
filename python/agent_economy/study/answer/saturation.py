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
        sizes: Those compared, ascending.
        proved: The smallest size of which it is proved that no larger one that was compared gains
            delta more than its extra robots cost. If it is the largest, nothing is proved.
        possible: The smallest size of which the contrary is not proved.
        gains: Of each size above the smaller of these two, its merit less that one's.
    """

    path: str
    sizes: tuple[int, ...]
    proved: int
    possible: int
    gains: dict[int, Interval]

    @property
    def base(self) -> int:
        """The size over which the larger ones' gains are told."""
        return min(self.proved, self.possible)


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
    proved = next(size for size in sizes if is_proved(evidence, sizes, size, delta))
    possible = next(size for size in sizes if not is_refuted(evidence, sizes, size))
    base = min(proved, possible)
    gains = {
        larger: evidence.difference(sizes[larger], sizes[base], "merit")
        for larger in above(sizes, base)
    }
    return Saturation(path, tuple(sizes), proved, possible, gains)


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

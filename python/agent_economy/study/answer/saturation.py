"""The smallest number of robots or controllers such that no larger one gains more than it costs.

The merit counts what they cost, so a larger team gains more than it costs if its merit is higher.
All other factors have their values in the selected configuration.
"""

from dataclasses import dataclass

from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.paths import counted_kind


@dataclass(frozen=True)
class Saturation:
    """The size from which a larger team is not worth its price.

    Attributes:
        path: Path of the team size.
        sizes: The compared sizes, ascending.
        proved: The smallest size for which it is proved that no larger compared one gains delta
            more than its extra robots cost. The largest size if nothing is proved.
        possible: The smallest size for which the opposite is not proved.
        gains: For each size above the smaller of these two, the difference of merit from it.
    """

    path: str
    sizes: tuple[int, ...]
    proved: int
    possible: int
    gains: dict[int, Interval]

    @property
    def base(self) -> int:
        """The size with which larger ones are compared in `gains`."""
        return min(self.proved, self.possible)


def saturations(evidence: Evidence, best: int, delta: float) -> tuple[Saturation, ...]:
    """Return the saturation of each team size with several values."""
    slices = {path: team_slice(evidence, best, path) for path in team_paths(evidence)}
    return tuple(
        saturation(evidence, path, sizes, delta) for path, sizes in slices.items() if len(sizes) > 1
    )


def team_paths(evidence: Evidence) -> list[str]:
    """Return the paths of factors that are numbers of robots or controllers."""
    return [path for path in evidence.samples[0].values if counted_kind(path) is not None]


def team_slice(evidence: Evidence, best: int, path: str) -> dict[int, int]:
    """Return configurations by team size, ascending, that differ from the best only in it.

    Those that cannot be run are left out.
    """
    fixed = {**evidence.samples[best].values, path: None}
    sizes = {
        int(sample.values[path]): index
        for index, sample in enumerate(evidence.samples)
        if sample.is_possible and {**sample.values, path: None} == fixed
    }
    return dict(sorted(sizes.items()))


def saturation(evidence: Evidence, path: str, sizes: dict[int, int], delta: float) -> Saturation:
    """Return the saturation of one team size."""
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
    """Return whether it is proved that no larger team gains delta more than it costs."""
    return all(
        evidence.exceeds(sizes[size], sizes[larger], "merit", by=-delta)
        for larger in above(sizes, size)
    )


def is_refuted(evidence: Evidence, sizes: dict[int, int], size: int) -> bool:
    """Return whether it is proved that some larger team gains more than it costs."""
    return any(
        evidence.exceeds(sizes[larger], sizes[size], "merit") for larger in above(sizes, size)
    )

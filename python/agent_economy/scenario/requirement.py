"""What a mission must meet, and in which share of missions."""

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

COMPARISONS: dict[str, Callable[[Floats, float], NDArray[np.bool_]]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
    "==": operator.eq,
    "!=": operator.ne,
}


def of_success(columns: Mapping[str, Floats], column: str) -> Floats:
    """Return the values of a column; `time_s` of a run without success is infinite."""
    values = columns[column]
    return np.where(columns["failed"] > 0, np.inf, values) if column == "time_s" else values


def overlap(one: tuple[float, float], other: tuple[float, float]) -> bool:
    """Return whether two intervals have a value in common, ends included."""
    return max(one[0], other[0]) <= min(one[1], other[1])


@dataclass(frozen=True)
class Condition:
    """A condition on the outcome of a run.

    Attributes:
        text: The condition as it was written, such as "time_s <= 1200".
        column: The outcome column.
        comparison: One of `COMPARISONS`.
        value: What the column is compared with.
    """

    text: str
    column: str
    comparison: str
    value: float

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that `holds` needs."""
        return (self.column, "failed") if self.column == "time_s" else (self.column,)

    def holds(self, columns: Mapping[str, Floats]) -> NDArray[np.bool_]:
        """Return in which runs it holds; NaN meets no condition.

        In a condition, `time_s` is the time of success: of a run without success, it is infinite.
        """
        values = of_success(columns, self.column)
        return COMPARISONS[self.comparison](values, self.value) & ~np.isnan(values)

    def triviality(self, limits: Sequence[tuple[float, float]], kind: str) -> str:
        """Return why it always or never holds; empty if it can hold and can fail.

        Args:
            limits: The range of its column in each configuration; `time_s` can be infinite.
            kind: The kind of its column: "whole", "real" or "flag".
        """
        ends = np.array(limits, dtype=np.float64)
        if self.column == "time_s":
            ends[:, 1] = np.inf
        low, high = float(ends[:, 0].min()), float(ends[:, 1].max())
        # The truth of a comparison changes at its value only.
        values = np.array([low, high, *self._around(low, high, kind)])
        holds = COMPARISONS[self.comparison](values, self.value)
        if holds.any() and not holds.all():
            return ""
        verb = "always" if holds.any() else "never"
        numbers = "" if kind == "real" else "a whole number "
        return f"{verb} holds, because {self.column} is {numbers}from {low:g} to {high:g}"

    def _around(self, low: float, high: float, kind: str) -> list[float]:
        """Return possible values at and next to the value that the column is compared with."""
        if kind != "real":
            near = [np.floor(self.value) + step for step in (-1.0, 0.0, 1.0)]
        else:
            near = [self.value, np.nextafter(self.value, -np.inf), np.nextafter(self.value, np.inf)]
        return [float(value) for value in near if low <= value <= high]

    @property
    def interval(self) -> tuple[float, float]:
        """The smallest and the largest value for which it can hold; `!=` excludes none."""
        below, above = (float(np.nextafter(self.value, end)) for end in (-np.inf, np.inf))
        return {
            "<=": (-np.inf, self.value),
            "<": (-np.inf, below),
            ">=": (self.value, np.inf),
            ">": (above, np.inf),
            "==": (self.value, self.value),
        }.get(self.comparison, (-np.inf, np.inf))


@dataclass(frozen=True)
class Requirement:
    """Conditions that must all hold in a share of the runs.

    Attributes:
        conditions: The conditions; at least one.
        probability: The share of runs in which all must hold; above 0, below 1.
        tolerance: A configuration is refuted when its share is shown to be below probability +
            tolerance; above 0, at most 1 - probability.
    """

    conditions: tuple[Condition, ...]
    probability: float
    tolerance: float

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that `met` needs."""
        names = (name for condition in self.conditions for name in condition.columns)
        return tuple(dict.fromkeys(names))

    @property
    def contradictions(self) -> list[tuple[int, int]]:
        """The pairs of conditions on one column that never hold together, by number."""
        pairs = combinations(enumerate(self.conditions), 2)
        return [
            (first, second)
            for (first, one), (second, other) in pairs
            if one.column == other.column and not overlap(one.interval, other.interval)
        ]

    def met(self, columns: Mapping[str, Floats]) -> Floats:
        """Return 1 for each run that meets all conditions, else 0; NaN for one with a NaN."""
        met = np.logical_and.reduce([each.holds(columns) for each in self.conditions])
        is_unknown = np.logical_or.reduce([np.isnan(columns[name]) for name in self.columns])
        return np.where(is_unknown, np.nan, met.astype(np.float64))

    def __str__(self) -> str:
        """Return the requirement in one line."""
        conditions = " and ".join(condition.text for condition in self.conditions)
        return f"{conditions} in {self.probability:g} of runs, tolerance {self.tolerance:g}"

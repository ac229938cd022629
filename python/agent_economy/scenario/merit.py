"""A figure of merit: how a run is scored; higher is better."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Bounds = tuple[float | None, float | None]
"""Minimum and maximum of a column; None where there is no bound."""


@dataclass(frozen=True)
class Term:
    """One summand of a figure of merit.

    Attributes:
        name: Its name in scenarios, such as "time".
        column: The weighted column, such as "time_s".
        weight: By how much; not 0.
        max: A value above this counts as this; None for as it is.
    """

    name: str
    column: str
    weight: float
    max: float | None = None

    def score(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what each value adds; NaN for NaN."""
        # A negative weight of nothing is nothing, not -0.0.
        return self.weight * (values if self.max is None else np.minimum(values, self.max)) + 0.0

    def bounds(self, least: float | None, greatest: float | None) -> tuple[float, float]:
        """Return the minimum and maximum contribution of values within bounds."""
        ends = np.array(
            [-np.inf if least is None else least, np.inf if greatest is None else greatest]
        )
        low, high = sorted(self.score(ends).tolist())
        return low, high

    def __str__(self) -> str:
        """Return the term as a person writes it."""
        above = "" if self.max is None else f" up to {shortest(self.max)}"
        return f"{self.name}={shortest(self.weight)}{above}"


@dataclass(frozen=True)
class Merit:
    """A weighted sum of columns of a run's outcome.

    Attributes:
        name: How scenarios name it, or its weights.
        terms: The terms in the order of summation, at least one.
    """

    name: str
    terms: tuple[Term, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of its terms."""
        return tuple(term.column for term in self.terms)

    def score(self, columns: Mapping[str, NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the merit of each run.

        Args:
            columns: Outcomes by column, all of one shape, such as (configurations, runs).

        Returns:
            An array of that shape; NaN where a column of a term is NaN.
        """
        first, *others = self.terms
        total = first.score(columns[first.column])
        for term in others:
            total = total + term.score(columns[term.column])
        return total

    def bounds(self, columns: Mapping[str, Bounds]) -> tuple[float, float]:
        """Return between which bounds `score` is, exactly, when the columns are within theirs.

        They are summed as `score` sums. Rounding never turns an order round, so the sum of the
        terms' bounds bounds every sum, in floating point too.
        """
        each = [term.bounds(*columns[term.column]) for term in self.terms]
        low, high = each[0]
        for term_low, term_high in each[1:]:
            low, high = low + term_low, high + term_high
        return low, high


def shortest(number: float) -> str:
    """Return a number as a person writes it, with all its digits."""
    return repr(float(number)).removesuffix(".0")


def display_name(name: str | None, terms: tuple[Term, ...]) -> str:
    """Return a figure of merit's name, or its terms where it has none."""
    return name or ",".join(str(term) for term in terms)

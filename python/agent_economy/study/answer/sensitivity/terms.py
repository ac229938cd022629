"""The terms that a polynomial in the factors may have: products of functions of one factor each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice, product

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.answer.sensitivity.basis import MAX_DEGREE, Basis
from agent_economy.study.answer.sensitivity.factors import Codes
from agent_economy.study.arguments import Floats

MAX_ORDER = 3
"""Maximum number of factors in a term."""

Function = tuple[int, int]
"""A factor, and the index of a function of its basis."""


@dataclass(frozen=True, eq=False)
class Terms:
    """Terms of a polynomial, without the constant.

    Attributes:
        functions: The functions whose product each is.
        degrees: The sum of their degrees.
    """

    functions: tuple[tuple[Function, ...], ...]
    degrees: Codes

    @property
    def orders(self) -> Codes:
        """The number of factors of each."""
        return np.array([len(each) for each in self.functions], dtype=np.int64)

    def of(self, indices: Codes) -> "Terms":
        """Return some of the terms."""
        return Terms(tuple(self.functions[each] for each in indices), self.degrees[indices])

    def contain(self, factor: int) -> NDArray[np.bool_]:
        """Return which contain a factor."""
        found = [any(each == factor for each, _ in functions) for functions in self.functions]
        return np.array(found, dtype=bool)

    def values(self, bases: Sequence[Basis], configurations: Codes) -> Floats:
        """Return the values of 1 and of the terms: (configurations, 1 + terms)."""
        found = np.ones((len(configurations), 1 + len(self.functions)))
        for column, functions in enumerate(self.functions, start=1):
            for factor, function in functions:
                found[:, column] *= bases[factor].values[configurations, function]
        return found

    def polynomials(self) -> Iterator[NDArray[np.bool_]]:
        """Yield the terms of each polynomial: up to a degree for each number of factors.

        The limit of a higher number of factors is not higher. Each polynomial is yielded once.
        """
        known = set()
        for limits in product(range(MAX_DEGREE + 1), repeat=MAX_ORDER):
            if limits[0] and all(np.diff(limits) <= 0):
                chosen = self.degrees <= np.array((0, *limits))[self.orders]
                if chosen.tobytes() not in known:
                    known.add(chosen.tobytes())
                    yield chosen


def terms(bases: Sequence[Basis], most: int) -> Terms:
    """Return the terms of up to three factors and degree 10.

    Of each number of factors, the lower degrees come first, as long as these are `most` terms.
    """
    found: list[tuple[Function, ...]] = []
    degrees: list[int] = []
    for order in range(1, MAX_ORDER + 1):
        left = most
        for degree in range(order, MAX_DEGREE + 1):
            new = list(islice(of_degree(bases, order, degree), left + 1))
            left -= len(new)
            if left < 0:
                break
            found += new
            degrees += [degree] * len(new)
    return Terms(tuple(found), np.array(degrees, dtype=np.int64))


def of_degree(bases: Sequence[Basis], order: int, degree: int) -> Iterator[tuple[Function, ...]]:
    """Yield the terms of a number of factors and a degree."""
    splits = [each for each in product(range(1, degree + 1), repeat=order) if sum(each) == degree]
    for chosen in combinations(range(len(bases)), order):
        for degrees in splits:
            functions = (
                [(factor, each) for each in np.flatnonzero(bases[factor].degrees == own).tolist()]
                for factor, own in zip(chosen, degrees, strict=True)
            )
            yield from product(*functions)

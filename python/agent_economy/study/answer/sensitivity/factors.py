"""The values of varied factors as numbers of levels."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.paths import number_of

Codes = NDArray[np.int64]
"""Level of each factor in each configuration: (configurations, factors)."""


@dataclass(frozen=True, eq=False)
class Factors:
    """Varied factors.

    Attributes:
        paths: Their paths.
        levels: The values of each that occur: numbers in their order, names as they appear.
        codes: The index of each configuration's value in `levels`.
    """

    paths: tuple[str, ...]
    levels: tuple[tuple[float | str, ...], ...]
    codes: Codes

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of levels of each factor."""
        return tuple(map(len, self.levels))

    def absent(self, codes: Codes) -> NDArray[np.bool_]:
        """Return where a factor is about a kind of robots or controllers whose number is 0."""
        found = np.zeros(codes.shape, dtype=bool)
        for index, path in enumerate(self.paths):
            number = number_of(path)
            if number in self.paths and number != path:
                counted = self.paths.index(number)
                found[:, index] = np.array(self.levels[counted])[codes[:, counted]] == 0
        return found


def factors(configurations: Sequence[Mapping[str, float | str]], paths: Sequence[str]) -> Factors:
    """Return the factors of these paths."""
    columns = [[each[path] for each in configurations] for path in paths]
    levels = tuple(map(levels_of, columns))
    places = [{level: code for code, level in enumerate(each)} for each in levels]
    codes = [
        [place[value] for value in column] for place, column in zip(places, columns, strict=True)
    ]
    return Factors(tuple(paths), levels, np.array(codes, dtype=np.int64).T)


def levels_of(values: Sequence[float | str]) -> tuple[float | str, ...]:
    """Return the distinct values: numbers in their order, names as they appear."""
    distinct = tuple(dict.fromkeys(values))
    return distinct if is_named(distinct) else tuple(sorted(distinct, key=float))


def is_named(levels: Sequence[float | str]) -> bool:
    """Return whether levels are categories: a name among them."""
    return any(isinstance(level, str) for level in levels)

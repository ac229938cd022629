"""Blocks of runs: consecutive runs of some configurations."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Columns: TypeAlias = dict[str, NDArray[np.float64]]
"""Outcomes by column name, each of shape (configurations, runs); NaN: quarantined, +inf: never."""


@dataclass(frozen=True)
class RunBlock:
    """Consecutive runs of some configurations.

    Attributes:
        configurations: Their numbers, 0 to 2^31 - 1, each once, in any order.
        first_run: 0 or more.
        runs: Number of runs per configuration, 1 or more.
    """

    configurations: tuple[int, ...]
    first_run: int
    runs: int

    def __post_init__(self) -> None:
        """Check the attributes."""
        if not self.configurations or len(set(self.configurations)) < len(self.configurations):
            message = f"a block has each configuration once, not {self.configurations}"
            raise ValueError(message)
        if min(self.configurations) < 0 or self.first_run < 0 or self.runs < 1:
            message = f"a block has numbers from 0 and at least one run, not {self}"
            raise ValueError(message)

    @property
    def end(self) -> int:
        """The run after the last."""
        return self.first_run + self.runs

    @property
    def shape(self) -> tuple[int, int]:
        """Number of configurations, and of runs per configuration."""
        return len(self.configurations), self.runs

    @property
    def rows(self) -> int:
        """Number of runs of all configurations together."""
        return len(self.configurations) * self.runs

    def __str__(self) -> str:
        """Return it as error messages write it."""
        return f"configurations {spans(self.configurations)}, runs {self.first_run}-{self.end - 1}"


Compute: TypeAlias = Callable[[RunBlock], Columns]
"""Computes the outcomes of a block of runs; always the same for the same block."""


def spans(numbers: Iterable[int]) -> str:
    """Return numbers in ascending order as "0-39,41"."""
    ordered = sorted(numbers)
    gaps = [right for left, right in pairwise(ordered) if right != left + 1]
    starts = [ordered[0], *gaps]
    ends = [left for left, right in pairwise(ordered) if right != left + 1]
    pairs = zip(starts, [*ends, ordered[-1]], strict=True)
    return ",".join(f"{first}-{last}" if last > first else f"{first}" for first, last in pairs)


def numbers(text: str) -> tuple[int, ...]:
    """Return the numbers of a string that `spans` returned."""
    parts = (part.partition("-") for part in text.split(","))
    return tuple(
        number for first, _, last in parts for number in range(int(first), int(last or first) + 1)
    )


def check_shape(block: RunBlock, columns: Columns) -> None:
    """Refuse columns that are not of a block's shape.

    Raises:
        ValueError: If one is not; this is an error of what computed them.
    """
    for name, values in columns.items():
        if values.shape != block.shape:
            message = f"column {name} of {block} has shape {values.shape}"
            raise ValueError(message)

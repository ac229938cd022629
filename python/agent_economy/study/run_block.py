"""Blocks of runs: consecutive runs of some configurations."""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from agent_economy._core import InputError
from agent_economy.plain import described
from agent_economy.scenario.validation import number_array

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

    @property
    def oblong(self) -> tuple["RunBlock", ...]:
        """The block, or two parts of a square one.

        In a square, rows and columns could be exchanged without an error.
        """
        if len(self.configurations) != self.runs or self.runs == 1:
            return (self,)
        most = replace(self, runs=self.runs - 1)
        return most, replace(self, first_run=most.end, runs=1)

    def __str__(self) -> str:
        """Return it as error messages write it."""
        return f"configurations {spans(self.configurations)}, runs {self.first_run}-{self.end - 1}"


Compute: TypeAlias = Callable[[RunBlock], Columns]
"""Computes the outcomes of a block of runs; always the same for the same block."""

Part: TypeAlias = tuple[RunBlock, Columns]
"""A part of a block, and its outcomes."""


@dataclass(frozen=True)
class Partwise:
    """A `Compute` that passes on each part of a block as soon as it is finished.

    Attributes:
        parts: Yields parts of a block, in any order; together they are the block.
    """

    parts: Callable[[RunBlock], Generator[Part]]

    def __call__(self, block: RunBlock) -> Columns:
        """Return the outcomes of a whole block."""
        gathered = Gathered(block)
        for part, columns in self.parts(block):
            gathered.put(part, columns)
        return gathered.columns


def parts_of(compute: Compute, block: RunBlock) -> Generator[Part]:
    """Yield the parts of a block as they are finished; without `Partwise`, the block is one."""
    if isinstance(compute, Partwise):
        yield from compute.parts(block)
    else:
        yield block, outcomes(compute, block)


def outcomes(compute: Compute, block: RunBlock) -> Columns:
    """Return what a user's function computes for a block, checked, in arrays of its own.

    Raises:
        InputError: If it returns anything but a dict of columns, each with a number for each run.
    """
    parts = [checked(part, compute(part)) for part in block.oblong]
    first, *others = parts
    if any(each.keys() != first.keys() for each in others):
        message = f"compute returned other columns for other runs of {block}: must be the same"
        raise InputError(message)
    if not others:
        return first
    return {name: np.hstack([part[name] for part in parts]) for name in first}


def checked(block: RunBlock, columns: object) -> Columns:
    """Return what a function returned for a block as columns of its shape.

    Raises:
        InputError: If it is something else.
    """
    if not isinstance(columns, Mapping) or not columns:
        given = "no columns" if isinstance(columns, Mapping) else described(columns)
        message = f"compute returned {given} for {block}: must be a dict of columns by name"
        raise InputError(message)
    meaning, found = "a row for each configuration, a column for each run", {}
    for name, values in columns.items():
        try:
            subject = f"compute returned for column {name}"
            found[name] = number_array(subject, values, block.shape, meaning)
        except InputError as error:
            message = f"{block}: {error}"
            raise InputError(message) from None
    return found


class Gathered:
    """Outcomes of a block, gathered from parts.

    Attributes:
        block: The block.
        columns: Every column, shape of the block; undefined where runs are missing.
    """

    def __init__(self, block: RunBlock) -> None:
        """Start without outcomes."""
        self.block = block
        self.columns: Columns = {}
        self._rows = {each: row for row, each in enumerate(block.configurations)}
        self._known = np.zeros(block.shape, dtype=np.bool_)

    @property
    def rows(self) -> int:
        """Number of runs that are known."""
        return int(self._known.sum())

    def put(
        self, part: RunBlock, data: Columns, configurations: Sequence[int] | None = None
    ) -> None:
        """Add the outcomes of a part, of all its configurations or of some."""
        if part == self.block and configurations is None:
            self.columns = dict(data)
            self._known[:] = True
            return
        wanted = part.configurations if configurations is None else configurations
        rows = {each: row for row, each in enumerate(part.configurations)}
        source = span([rows[each] for each in wanted])
        first = part.first_run - self.block.first_run
        self._fill(
            (span([self._rows[each] for each in wanted]), slice(first, first + part.runs)),
            {name: values[source] for name, values in data.items()},
        )

    def put_runs(
        self, configurations: NDArray[np.int64], runs: NDArray[np.int64], data: Columns
    ) -> None:
        """Add the outcomes of single runs of the block, each array of shape (runs,)."""
        rows = np.array([self._rows[each] for each in configurations.tolist()], dtype=np.int64)
        self._fill((rows, runs - self.block.first_run), data)

    def _fill(self, places: Any, data: Columns) -> None:
        if not self.columns:
            self.columns = {name: np.empty(self.block.shape) for name in data}
        if data.keys() != self.columns.keys():
            message = f"columns {', '.join(data)} differ from those of other parts"
            raise ValueError(message)
        for name, values in data.items():
            self.columns[name][places] = values
        self._known[places] = True

    def missing(self) -> Iterator[RunBlock]:
        """Yield the missing runs as blocks."""
        differs = (self._known[1:] != self._known[:-1]).any(axis=1)
        starts = [0, *(np.flatnonzero(differs) + 1).tolist(), len(self._known)]
        for first_row, end_row in pairwise(starts):
            configurations = self.block.configurations[first_row:end_row]
            ends = np.flatnonzero(np.diff(self._known[first_row], prepend=True, append=True))
            for first, end in ends.reshape(-1, 2).tolist():
                yield RunBlock(configurations, self.block.first_run + first, end - first)


def span(rows: list[int]) -> slice | list[int]:
    """Return rows as a slice if they are consecutive: numpy copies it several times faster."""
    first, end = rows[0], rows[0] + len(rows)
    return slice(first, end) if rows == list(range(first, end)) else rows


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

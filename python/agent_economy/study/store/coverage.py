"""Which runs are stored, and how requested runs are divided into blocks."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator
from math import ceil
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import RunBlock
from agent_economy.study.store.ledger import BlockFile

MAX_ROWS = 2**18
"""Rows of a block file, unless it is of a single configuration."""


def split(requested: RunBlock) -> Iterator[RunBlock]:
    """Yield the blocks in which runs are stored, configurations ascending.

    The division of the runs depends on the runs only, so that a first run always means the same
    runs, whichever configurations are requested together.
    """
    configurations = sorted(requested.configurations)
    for first_run in range(requested.first_run, requested.end, MAX_ROWS):
        runs = min(MAX_ROWS, requested.end - first_run)
        blocks = ceil(len(configurations) / max(1, MAX_ROWS // runs))
        each = ceil(len(configurations) / blocks)
        for first in range(0, len(configurations), each):
            yield RunBlock(tuple(configurations[first : first + each]), first_run, runs)


class Coverage:
    """Which runs are stored in which file."""

    def __init__(self, folder: Path, files: Iterable[BlockFile] = ()) -> None:
        """Start from the block files of a study's folder."""
        self._folder = folder
        self._files: defaultdict[int, dict[int, BlockFile]] = defaultdict(dict)
        self._firsts: list[int] = []
        self._runs: dict[int, int] = {}
        for file in files:
            self.add(file)

    def add(self, file: BlockFile) -> None:
        """Add a block file."""
        block = file.block
        self.check(block)
        if block.first_run not in self._runs:
            self._firsts.insert(bisect_left(self._firsts, block.first_run), block.first_run)
            self._runs[block.first_run] = block.runs
        self._files[block.first_run].update(dict.fromkeys(block.configurations, file))

    def check(self, block: RunBlock) -> None:
        """Refuse runs that overlap stored ones without being the same.

        Raises:
            StoreError: If they do: another version of this program divided the runs differently.
        """
        index = bisect_left(self._firsts, block.first_run)
        neighbours = self._firsts[max(0, index - 1) : index + 1]
        for first in neighbours:
            end = first + self._runs[first]
            same = (first, end) == (block.first_run, block.end)
            if not same and first < block.end and block.first_run < end:
                message = (
                    f"{self._folder}: stores runs {first}-{end - 1} as one block, which overlaps "
                    f"the requested block {block.first_run}-{block.end - 1}: use another folder"
                )
                raise StoreError(message)

    def missing(self, block: RunBlock) -> RunBlock | None:
        """Return the part of a block that is not stored; None if all of it is."""
        stored = self._files[block.first_run]
        missing = tuple(each for each in block.configurations if each not in stored)
        return RunBlock(missing, block.first_run, block.runs) if missing else None

    def contains(
        self, configurations: NDArray[np.int64], runs: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """Return which of some runs are stored; all arrays have the same shape."""
        found = np.zeros(len(runs), dtype=np.bool_)
        for first in self._firsts:
            are_here = (runs >= first) & (runs < first + self._runs[first])
            if are_here.any():
                found |= are_here & np.isin(configurations, list(self._files[first]))
        return found

    def block_files(self, block: RunBlock) -> list[tuple[BlockFile, list[int]]]:
        """Return the files that contain runs of a block, each with its configurations of it."""
        stored = self._files[block.first_run]
        # By identity: hashing a file's entry takes time in proportion to its configurations.
        found: dict[int, tuple[BlockFile, list[int]]] = {}
        for configuration in block.configurations:
            file = stored.get(configuration)
            if file:
                found.setdefault(id(file), (file, []))[1].append(configuration)
        return list(found.values())

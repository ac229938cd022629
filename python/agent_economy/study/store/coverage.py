"""Which runs are stored, and how what is asked for is cut into blocks."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator
from math import ceil
from pathlib import Path

from agent_economy.study.errors import StoreError
from agent_economy.study.rectangle import Rectangle
from agent_economy.study.store.ledger import Block

MOST_ROWS = 2**18
"""Of a block, unless it is of a single configuration."""


def cut(rectangle: Rectangle) -> Iterator[Rectangle]:
    """Yield a rectangle in blocks, configurations ascending.

    Runs are cut at places that depend on the runs only, so that a first run always means the same
    runs, whichever configurations were asked for together.
    """
    configurations = sorted(rectangle.configurations)
    for first_run in range(rectangle.first_run, rectangle.end, MOST_ROWS):
        runs = min(MOST_ROWS, rectangle.end - first_run)
        blocks = ceil(len(configurations) / max(1, MOST_ROWS // runs))
        each = ceil(len(configurations) / blocks)
        for first in range(0, len(configurations), each):
            yield Rectangle(tuple(configurations[first : first + each]), first_run, runs)


class Coverage:
    """Which runs are stored in which block."""

    def __init__(self, folder: Path, blocks: Iterable[Block] = ()) -> None:
        """Start from blocks, which are of a study's folder."""
        self._folder = folder
        self._blocks: defaultdict[int, dict[int, Block]] = defaultdict(dict)
        self._firsts: list[int] = []
        self._runs: dict[int, int] = {}
        for block in blocks:
            self.add(block)

    def add(self, block: Block) -> None:
        """Add a block."""
        area = block.rectangle
        self.check(area)
        if area.first_run not in self._runs:
            self._firsts.insert(bisect_left(self._firsts, area.first_run), area.first_run)
            self._runs[area.first_run] = area.runs
        self._blocks[area.first_run].update(dict.fromkeys(area.configurations, block))

    def check(self, area: Rectangle) -> None:
        """Refuse runs that overlap stored ones without being the same.

        Raises:
            StoreError: If they do: another version of this program asked for others.
        """
        place = bisect_left(self._firsts, area.first_run)
        near = self._firsts[max(0, place - 1) : place + 1]
        for first in near:
            end = first + self._runs[first]
            same = (first, end) == (area.first_run, area.end)
            if not same and first < area.end and area.first_run < end:
                message = (
                    f"{self._folder}: holds runs {first}-{end - 1} together, but "
                    f"{area.first_run}-{area.end - 1} are asked for: use another folder"
                )
                raise StoreError(message)

    def missing(self, area: Rectangle) -> Rectangle | None:
        """Return what of a block's rectangle is not stored."""
        there = self._blocks[area.first_run]
        left = tuple(each for each in area.configurations if each not in there)
        return Rectangle(left, area.first_run, area.runs) if left else None

    def blocks(self, area: Rectangle) -> list[tuple[Block, list[int]]]:
        """Return the blocks that hold what is stored of a rectangle, and what each holds of it."""
        there = self._blocks[area.first_run]
        # By identity: a block's hash takes as long as it has configurations.
        found: dict[int, tuple[Block, list[int]]] = {}
        for configuration in area.configurations:
            block = there.get(configuration)
            if block:
                found.setdefault(id(block), (block, []))[1].append(configuration)
        return list(found.values())

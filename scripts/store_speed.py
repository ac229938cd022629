"""Measure the speed and the file sizes of the store of studies.

Example: python scripts/store_speed.py
"""

import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median

import numpy as np

from agent_economy import Scenario, _core
from agent_economy.study.store import Column, Columns, RunBlock, Store

COLUMNS = (
    Column("time_s", "real"),
    Column("failed", "flag"),
    Column("robots", "whole"),
    Column("found", "whole"),
    Column("collisions", "whole"),
    Column("paints", "whole"),
)
TEAM_SIZES = tuple(range(1, 41))
RUNS = 6_250
"""Real runs per team; larger blocks repeat teams, under other numbers."""

SIZES = (250_000, 500_000, 1_000_000)
TRIALS = 15
SMALL = (40, 10)
SMALL_BLOCKS = 200


def main() -> None:
    """Print a table of block sizes, and the cost of a small block."""
    data = outcomes()
    print("  rows/block  written rows/s  read rows/s    bytes/row")
    for rows in SIZES:
        print("{:>12,}  {:>14,.0f}  {:>11,.0f}  {:>11.2f}".format(rows, *large(data, rows)))
    writing, reading = small(data)
    configurations, runs = SMALL
    print(f"a block of {configurations} x {runs}: written {writing:.2f} ms, read {reading:.2f} ms")


def outcomes() -> Columns:
    """Return the columns of real runs, each of shape (teams, runs)."""
    scenario = Scenario.load("classic")
    teams = [scenario.configuration({"robots.wanderer.count": robots}) for robots in TEAM_SIZES]
    return _core.run_block(teams, seed=0, first_run=0, runs=RUNS, threads=None)


def large(data: Columns, rows: int) -> tuple[float, float, float]:
    """Return the median rows written and read per second, and the bytes per row, of blocks."""
    copies = rows // (len(TEAM_SIZES) * RUNS)
    block = {name: np.tile(values, (copies, 1)) for name, values in data.items()}
    area = RunBlock(tuple(range(copies * len(TEAM_SIZES))), 0, RUNS)
    writing, reading, size = [], [], 0
    for _ in range(TRIALS):
        with tempfile.TemporaryDirectory(dir=".") as place:
            folder = Path(place)
            with Store.open(folder, "", COLUMNS) as store:
                writing.append(seconds(partial(store.block, area, partial(part, block))))
                reading.append(seconds(partial(store.block, area, refuse)))
            size = sum(path.stat().st_size for path in (folder / "blocks").iterdir())
    return rows / median(writing), rows / median(reading), size / rows


def part(outcomes: Columns, area: RunBlock) -> Columns:
    """Return the outcomes of a block, from those of configurations and runs 0, 1, ..."""
    rows = slice(area.configurations[0], area.configurations[-1] + 1)
    return {name: values[rows, area.first_run : area.end] for name, values in outcomes.items()}


def small(data: Columns) -> tuple[float, float]:
    """Return the median times, in ms, of writing and reading a small block."""
    configurations, runs = SMALL
    block = {name: values[:configurations, :runs] for name, values in data.items()}
    areas = [
        RunBlock(tuple(range(configurations)), number * runs, runs)
        for number in range(SMALL_BLOCKS)
    ]
    with (
        tempfile.TemporaryDirectory(dir=".") as place,
        Store.open(Path(place), "", COLUMNS) as store,
    ):
        writing = [seconds(partial(store.block, area, lambda _: block)) for area in areas]
        reading = [seconds(partial(store.block, area, refuse)) for area in areas]
    return median(writing) * 1000, median(reading) * 1000


def refuse(area: RunBlock) -> Columns:
    """Exit, because a block that should be read was not stored."""
    sys.exit(f"{area} was stored, but is requested again")


def seconds(work: Callable[[], object]) -> float:
    """Return the duration of a call."""
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


if __name__ == "__main__":
    main()

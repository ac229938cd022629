"""The 2003 grid simulator, bit-exact: traces, start positions, and runs in bulk.

Time is counted in paints of the original program's window; 56 paints are one second of the thesis.
A team decides in paints 12, 23, 34, ... The definition of contact, by which an item counts as
found, is one of "neighbour", "diagonal", "within-2", "within-3", "touch" and "ahead" (see
`docs/classic.md`).
"""

from typing import Any

import numpy as np
import pyarrow as pa

from agent_economy import _core, arrow

TIME_LIMIT_PAINTS = 6720
"""Time limit of the 2003 experiment: 120 s."""


def start(robots: int, seed: int = 0, run: int = 0) -> list[dict[str, float]]:
    """Return the start of a team in one run, in the form that `trace` takes.

    The start of a robot depends only on the seed, the run and its index in the team: teams of
    different sizes share the starts of their first robots.

    Args:
        robots: Team size, 1 to 250.
        seed: Seed of the start positions, 0 to 2^64 - 1.
        run: Run number, 0 to 2^64 - 1.

    Returns:
        For each robot `x` and `y` (px), `heading` (degrees: 0 is up, 90 is right) and `speed`.

    Raises:
        InputError: If an argument is out of range.
    """
    return _core.random_start(robots, seed, run)


def trace(start: list[dict[str, float]], decisions: int) -> dict[str, Any]:
    """Run from a start and return the visible state, in the format of the golden trace files.

    Args:
        start: For each robot (1 to 250) `x` and `y` in px, at least -10 and below 490 (a cell has
            20 px), `heading` 0, 45, ..., 360 and `speed` 0, 1 or 2.
        decisions: Number of decisions to return, 0 to 1,000,000 divided by the number of robots.

    Returns:
        `start_grid`: hash of the grid at the start. `paints`: for each of paints 1 to 34, a list
        of `[x, y]` per robot. `decisions`: for each decision `[carry, grid hash, robot, ...]`
        with robot = `[x, y, heading, speed, left turns, right turns, colour]`, where the colour is
        "b"lue, "y"ellow or "r"ed. Pixels are 32-bit floats, widened.

    Raises:
        InputError: If `start` or `decisions` is not allowed; it lists all errors.
    """
    return _core.trace(start, decisions)


def replicate(
    robots: int,
    runs: int,
    *,
    contact: str = "touch",
    seed: int = 0,
    threads: int | None = None,
) -> pa.Table:
    """Run a team from random starts, runs 0 to `runs` - 1.

    Args:
        robots: Team size, 1 to 250.
        runs: Number of runs, 0 to 10,000,000.
        contact: Definition of contact.
        seed: Seed of the start positions, 0 to 2^64 - 1. A run of a seed is the same in every
            call.
        threads: Number of threads, 1 to 1024; None for one per processor. It changes no result.

    Returns:
        One row per run: `run`, `paints` (time of the last find; null if it provably never
        happens), `found` (items found) and `collisions` (decisions of robots on shared cells).
        The last two are counted until completion or paint 6,720 (120 s), whichever is first. All
        are int64.

    Raises:
        InputError: If an argument is out of range; it lists all errors.
    """
    paints, found, collisions = _core.replicate(
        robots,
        runs,
        contact=contact,
        time_limit_paints=TIME_LIMIT_PAINTS,
        seed=seed,
        first_run=0,
        threads=threads,
    )
    columns = {
        "run": np.arange(runs, dtype=np.int64),
        "paints": arrow.column(paints, paints < 0),
        "found": found,
        "collisions": collisions,
    }
    return arrow.table(columns)


def exhaust(robots: int, contact: str, *, threads: int | None = None) -> pa.Table:
    """Run from every possible start: 289 for one robot, 83,521 for two.

    Args:
        robots: Team size, 1 or 2.
        contact: Definition of contact.
        threads: As in `replicate`.

    Returns:
        One row per start: `x0`, `y0` (and `x1`, `y1`), the cells (4 to 20) on which the robots
        start, and `paints` (time of the last find; null if it provably never happens). All are
        int64.

    Raises:
        InputError: If an argument is out of range; it lists all errors.
    """
    cells, paints = _core.exhaust(robots, contact, threads=threads)
    names = [f"{axis}{robot}" for robot in range(robots) for axis in "xy"]
    columns = {name: cells[:, index] for index, name in enumerate(names)}
    return arrow.table({**columns, "paints": arrow.column(paints, paints < 0)})

"""The 2003 grid simulator, bit-exact: traces, single starts, every start, many runs.

Time is in paints of the original's window (56 make one of the thesis's seconds); a team decides
in paints 12, 23, 34, ... Contact, what counts as finding an item, is one of "neighbour",
"diagonal", "within-2", "within-3", "touch" and "ahead" (see `docs/classic.md`).
"""

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core

CAP_PAINTS = 6720
"""The experiment's 120 s."""


def start(robots: int, seed: int = 0, run: int = 0) -> list[dict[str, float]]:
    """Return where a team starts in one run, in the form that `trace` takes.

    A robot's start depends on seed, run and its place in the team only, so teams of different
    size share the starts of their first robots.

    Args:
        robots: Team size, 1 to 250.
        seed: 0 to 2^64 - 1.
        run: 0 to 2^64 - 1.

    Returns:
        For each robot `x` and `y` (px), `heading` (degrees, 0 is up, 90 right) and `speed`.

    Raises:
        InputError: If an argument is out of range.
    """
    return _core.random_start(robots, seed, run)


def trace(start: list[dict[str, float]], decisions: int) -> dict[str, Any]:
    """Run from a start and return all that can be seen, as the golden trace files write it.

    Args:
        start: For each robot (1 to 250) `x` and `y` in px with a cell in the grid (-10 to below
            490; 20 px a cell), `heading` 0, 45, ..., 360 and `speed` 0, 1 or 2.
        decisions: How many decisions to return, 0 to 1,000,000 divided by the robots.

    Returns:
        `start_grid`: hash of the grid at the start. `paints`: after each of paints 1 to 34 a list
        of `[x, y]` per robot. `decisions`: after each decision `[carry, grid hash, robot, ...]`
        with robot = `[x, y, heading, speed, left turns, right turns, colour]`, colour "b"lue,
        "y"ellow or "r"ed. Pixels are 32-bit floats, widened.

    Raises:
        InputError: If anything in `start` or `decisions` is not allowed; all faults at once.
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
        runs: How many, 0 to 10,000,000.
        contact: What counts as finding an item.
        seed: 0 to 2^64 - 1. Run r of a seed is the same in every call.
        threads: 1 to 1024; None for as many as there are processors. It changes no result.

    Returns:
        A row a run: `run`, `paints` (of the last find; null = proven never), `found` (items
        contacted) and `collisions` (robot-decisions spent red); the last two are counted to
        completion or to paint 6,720 (120 s), whichever is first. All int64.

    Raises:
        InputError: If an argument is out of range; all faults at once.
    """
    paints, found, collisions = _core.replicate(
        robots,
        runs,
        contact=contact,
        time_limit_paints=CAP_PAINTS,
        seed=seed,
        first_run=0,
        threads=threads,
    )
    columns = {
        "run": np.arange(runs, dtype=np.int64),
        "paints": or_null(paints),
        "found": found,
        "collisions": collisions,
    }
    return pa.table(columns)


def exhaust(robots: int, contact: str, *, threads: int | None = None) -> pa.Table:
    """Run every start there is: 289 for one robot, 83,521 for two.

    Args:
        robots: 1 or 2.
        contact: What counts as finding an item.
        threads: As in `replicate`.

    Returns:
        A row a start: `x0`, `y0` (and `x1`, `y1`), the cells (4 to 20) on which the robots start,
        and `paints` (of the last find; null = proven never). All int64.

    Raises:
        InputError: If an argument is out of range; all faults at once.
    """
    cells, paints = _core.exhaust(robots, contact, threads=threads)
    names = [f"{axis}{robot}" for robot in range(robots) for axis in "xy"]
    columns = {name: cells[:, index] for index, name in enumerate(names)}
    return pa.table({**columns, "paints": or_null(paints)})


def or_null(paints: NDArray[np.int64]) -> pa.Array:
    """Return paints as Arrow has them: null where the compiled part says -1, proven never."""
    return pa.array(paints, mask=paints < 0)

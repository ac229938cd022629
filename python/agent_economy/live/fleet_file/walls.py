"""The obstacles of a scenario, as plain polygons and circles."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import compress, count
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy._core import NoRoomError
from agent_economy.live.plan import Point, Wall
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Scenario

OCCUPIED = 100

MAX_CORNERS = 4000
"""Corners of all walls of a plan: what the warden compares an order with takes it some ms."""

Cells = NDArray[np.bool_]


def walls_of(scenario: Scenario, obstacles: Sequence[Mapping[str, Any]]) -> tuple[Wall, ...]:
    """Return the obstacles of a scenario of the metric engine; none if its team has no room.

    Args:
        scenario: The scenario.
        obstacles: Its table `world.obstacles`.
    """
    if not obstacles:
        return ()
    try:
        run = Simulation(scenario)._run  # noqa: SLF001  (ours)
    except NoRoomError:
        return ()
    setting = _core.recorded_setting(run)
    entries = compress(count(), ("map" in each for each in obstacles))
    maps = zip(entries, setting["maps"], strict=True)
    return (
        *(_shape(each) for each in setting["shapes"]),
        *(wall for entry, each in maps for wall in _of_map(entry, each, obstacles[entry])),
    )


def for_plan(walls: tuple[Wall, ...]) -> tuple[Wall, ...] | None:
    """Return walls if they are few enough for a plan, otherwise None."""
    return walls if sum(len(wall.corners_m) for wall in walls) <= MAX_CORNERS else None


def _name(entry: int) -> str:
    return f"world.obstacles[{entry}]"


def _shape(shape: Mapping[str, Any]) -> Wall:
    name = _name(shape["entry"])
    if "radius_m" in shape:
        return Wall(name, (tuple(shape["at_m"]),), shape["radius_m"])
    return Wall(name, tuple(tuple(corner) for corner in shape["polygon_m"]))


def _of_map(entry: int, given: Mapping[str, Any], table: Mapping[str, Any]) -> Iterator[Wall]:
    """Yield the occupied cells of a map: one wall for each rectangle of equal runs in its rows."""
    occupancy = given["occupancy"]
    is_solid = occupancy != 0 if table.get("unknown_is_occupied") else occupancy == OCCUPIED
    origin, right, _, up = (np.array(corner) for corner in given["corners_m"])
    rows, columns = is_solid.shape
    along, across = (right - origin) / columns, (up - origin) / rows
    for (left, end), (low, high) in _rectangles(is_solid):
        cells = ((left, low), (end, low), (end, high), (left, high))
        yield Wall(_name(entry), tuple(_point(origin + x * along + y * across) for x, y in cells))


def _point(place: NDArray[np.float64]) -> Point:
    return float(place[0]), float(place[1])


def _rectangles(is_solid: Cells) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield rectangles of solid cells: their columns and rows, each from the first to the end."""
    open_runs: dict[tuple[int, int], int] = {}
    for row, cells in enumerate((*is_solid, np.zeros_like(is_solid[0]))):
        runs = dict.fromkeys(_runs(cells))
        for run in [run for run in open_runs if run not in runs]:
            yield run, (open_runs.pop(run), row)
        for run in runs:
            open_runs.setdefault(run, row)


def _runs(cells: Cells) -> Iterator[tuple[int, int]]:
    changes = np.flatnonzero(np.diff(cells.astype(np.int8), prepend=0, append=0)).tolist()
    return zip(changes[::2], changes[1::2], strict=True)

"""The world of 2003 as it is drawn: in cells, x to the right, y upwards."""

from typing import Any

from agent_economy import _core

WORLD: dict[str, Any] = _core.classic_world()
"""Cells a side, pixels a cell, and the cells of walls and items: columns, and rows downwards."""

CELLS, CELL_PX = int(WORLD["size"]), float(WORLD["cell_px"])

RADIUS = 0.5
"""Of a robot, in cells. The chevron of 2003 is 24 px long: 8 before its place, and 16 behind."""

Cell = tuple[int, int]
Place = tuple[float, float]


def outline(cell: Place) -> list[Place]:
    """Return the corners of a cell, given as column and row."""
    left, top = cell[0], CELLS - cell[1]
    right, bottom = left + 1, top - 1
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def middle(cell: Place) -> Place:
    """Return the middle of a cell."""
    return cell[0] + 0.5, CELLS - cell[1] - 0.5

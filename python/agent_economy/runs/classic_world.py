"""The world of the classic engine for display: in cells, x to the right, y upwards."""

from typing import Any

from agent_economy import _core

WORLD: dict[str, Any] = _core.classic_world()
"""Cells per side, pixels per cell, and the cells of walls and items (column, row downwards)."""

CELLS, CELL_PX = int(WORLD["size"]), float(WORLD["cell_px"])

RADIUS = 0.5
"""Radius of a robot in cells. The original chevron extends 8 px to the front and 16 to the rear."""

Cell = tuple[int, int]
Place = tuple[float, float]


def outline(cell: Place) -> list[Place]:
    """Return the corners of a cell, which is given as column and row."""
    left, top = cell[0], CELLS - cell[1]
    right, bottom = left + 1, top - 1
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def centre(cell: Place) -> Place:
    """Return the centre of a cell."""
    return cell[0] + 0.5, CELLS - cell[1] - 0.5

"""What a page draws of a run of the classic engine: the window of 2003 in pixels, y upwards.

As in the original program, the position of a robot on its cell is the upper left corner of the
square that is drawn for the cell; the robot has left the cell when it is closer to another one.
"""

import base64
from typing import Any

from agent_economy.runs import classic_world
from agent_economy.runs.classic_simulation import KIND, ClassicSimulation
from agent_economy.runs.classic_world import CELL_PX, CELLS, RADIUS, WORLD, Cell, Place
from agent_economy.types.page import ItemView, MapView, RobotView

SIDE_PX = CELLS * CELL_PX
RADIUS_PX = RADIUS * CELL_PX

FREE, OCCUPIED = 0, 2
"""States of cells, as in `MapView`."""

BODY: dict[str, Any] = {
    "radius": RADIUS_PX,
    "is_flying": False,
    "radio_range_m": None,
    "rings": [],
    "sensors": [],
}


def drawn(simulation: ClassicSimulation) -> bytes:
    """Return the current moment."""
    return simulation._run.frame()  # noqa: SLF001  (ours)


def still(simulation: ClassicSimulation) -> dict[str, Any]:
    """Return the world, its items, and the robot kinds."""
    side = {"size": [SIDE_PX, SIDE_PX], "periodic": False, "unit": "px", "cell": CELL_PX}
    robots = {"name": KIND, "count": simulation.scenario.robots[KIND]}
    return {
        "world": side,
        "kinds": [{**robots, **BODY}],
        "items": [
            item(cell, contacts)
            for cell, contacts in zip(WORLD["items"], simulation.contacts, strict=True)
        ],
        "item_kinds": ["item"],
        "obstacles": [],
        "maps": [obstacle_map()],
    }


class Selected:
    """The selected robot; it has no beliefs and draws no map."""

    def __init__(self) -> None:
        """Begin with no robot selected."""
        self._robot: str | None = None

    def choose(self, robot: str | None) -> None:
        """Select a robot, or none; of a robot that does not exist nothing is sent."""
        self._robot = robot

    def inspection(self, simulation: ClassicSimulation) -> None:
        """Return None."""

    def map(self, simulation: ClassicSimulation) -> None:
        """Return None."""

    def details(self, simulation: ClassicSimulation) -> RobotView | None:
        """Return the state of the robot; None if it does not exist now."""
        robot = self._robot
        return None if robot not in simulation.robots else details(simulation, str(robot))


def details(simulation: ClassicSimulation, robot: str) -> RobotView:
    """Return the state of a robot in words, and the cells that it would examine."""
    state = simulation.team.to_pylist()[simulation.robots.index(robot)]
    return {
        "name": robot,
        "facts": [
            ["Cell", f"column {state['column']}, row {state['row']} from the top"],
            ["Heading", f"{state['heading_deg']}° from up, clockwise"],
            ["Speed", counted(state["speed"], "cell") + " per decision"],
            ["Next decision", "in " + counted(simulation.decides_in, "paint")],
            ["Counted turns", f"{state['left_turns']} left, {state['right_turns']} right"],
            ["Carry (all robots)", str(simulation.carry)],
        ],
        "examined_cells": [outline(cell) for cell in simulation.examined_cells(robot)],
    }


def item(cell: Cell, contacts: list[Cell]) -> ItemView:
    """Return an item, and outlines of the places from which a robot finds it."""
    contact = [outline((column - 0.5, row - 0.5)) for column, row in contacts]
    return {"kind": "item", "at": middle(cell), "target": True, "contact": contact}


def obstacle_map() -> MapView:
    """Return a map of the cells that robots cannot enter: walls and items."""
    cells = {*WORLD["walls"], *WORLD["items"]}
    states = [
        OCCUPIED if (column, row) in cells else FREE
        for row in reversed(range(CELLS))
        for column in range(CELLS)
    ]
    side = SIDE_PX
    return {
        "corners": [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]],
        "columns": CELLS,
        "rows": CELLS,
        "cells": base64.b64encode(bytes(states)).decode(),
    }


def outline(cell: Place) -> list[list[float]]:
    """Return the corners of a cell as drawn."""
    return [in_px(corner) for corner in classic_world.outline(cell)]


def middle(cell: Cell) -> list[float]:
    """Return the middle of a cell as drawn."""
    return in_px(classic_world.centre(cell))


def in_px(place: Place) -> list[float]:
    """Convert a position from cells to pixels."""
    return [each * CELL_PX for each in place]


def counted(number: int, word: str) -> str:
    """Return a number with its noun, in the plural unless it is 1."""
    return f"{number} {word}{'' if number == 1 else 's'}"

"""What a page draws of a run of the classic engine: the window of 2003 in its pixels, y upwards.

As in the original a robot's place on the cell that it stands on is the upper left corner of the
square that is drawn of that cell; it has left the cell when it is nearer to another's.
"""

import base64
from typing import Any

from agent_economy.runs import classic_world
from agent_economy.runs.classic_simulation import KIND, ClassicSimulation
from agent_economy.runs.classic_world import CELL_PX, CELLS, RADIUS, WORLD, Cell, Place

SIDE_PX = CELLS * CELL_PX
RADIUS_PX = RADIUS * CELL_PX

FREE, FILLED = 0, 2
"""As maps say it."""

BODY: dict[str, Any] = {
    "radius": RADIUS_PX,
    "flies": False,
    "radio_range_m": None,
    "rings": [],
    "sensors": [],
}


def drawn(simulation: ClassicSimulation) -> bytes:
    """Return one moment."""
    return simulation._run.frame()  # noqa: SLF001  (ours)


def still(simulation: ClassicSimulation) -> dict[str, Any]:
    """Return the world, what is in it, and robots as they are made."""
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
        "maps": [filled()],
    }


class Selected:
    """The robot that a page looks at; it has no mind, and draws no map."""

    def __init__(self) -> None:
        """Begin with none."""
        self._robot: str | None = None

    def choose(self, robot: str | None) -> None:
        """Look at a robot, or at none; nothing is told of one that is not there."""
        self._robot = robot

    def mind(self, simulation: ClassicSimulation) -> None:
        """Return None."""

    def map(self, simulation: ClassicSimulation) -> None:
        """Return None."""

    def told(self, simulation: ClassicSimulation) -> dict[str, Any] | None:
        """Return what the robot has; None if there is no robot of that name now."""
        robot = self._robot
        return told(simulation, robot) if robot in simulation.robots else None


def told(simulation: ClassicSimulation, robot: str) -> dict[str, Any]:
    """Return what a robot has, in words, and the cells that it would look at."""
    state = simulation.team.to_pylist()[simulation.robots.index(robot)]
    return {
        "name": robot,
        "facts": [
            ["Cell", f"column {state['column']}, row {state['row']} from the top"],
            ["Heading", f"{state['heading_deg']}° from up, clockwise"],
            ["Speed", counted(state["speed"], "cell") + " a decision"],
            ["Decides", "in " + counted(simulation.decides_in, "paint")],
            ["Turns that count", f"{state['left_turns']} left, {state['right_turns']} right"],
            ["Carry, of all robots", str(simulation.carry)],
        ],
        "looks": [outline(cell) for cell in simulation.looks(robot)],
    }


def item(cell: Cell, contacts: list[Cell]) -> dict[str, Any]:
    """Return an item, and outlines of where robots must be to find it."""
    contact = [outline((column - 0.5, row - 0.5)) for column, row in contacts]
    return {"kind": "item", "at": middle(cell), "target": True, "contact": contact}


def filled() -> dict[str, Any]:
    """Return a map of what robots cannot enter: walls, and items, which to robots are walls."""
    cells = {*WORLD["walls"], *WORLD["items"]}
    states = [
        FILLED if (column, row) in cells else FREE
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
    return in_px(classic_world.middle(cell))


def in_px(place: Place) -> list[float]:
    """Return a place that is given in cells."""
    return [each * CELL_PX for each in place]


def counted(number: int, word: str) -> str:
    """Return a number of things."""
    return f"{number} {word}{'' if number == 1 else 's'}"

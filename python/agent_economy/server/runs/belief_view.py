"""The robot that a page has selected in a run of the metric engine, and what it believes."""

import base64
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from agent_economy._core import InputError
from agent_economy.runs import brain
from agent_economy.runs.brain import BelievedMap
from agent_economy.runs.simulation import Simulation
from agent_economy.types.page import Inspection, MapPart


class Selected:
    """The selected robot, and what the page has been sent of its belief map.

    A map has up to 65,000 cells, and a step changes few of them: the page is sent the smallest
    rectangle that contains all changes.
    """

    def __init__(self) -> None:
        """Begin with no robot selected."""
        self._robot: str | None = None
        self._map: BelievedMap | None = None

    def choose(self, robot: str | None) -> None:
        """Select a robot, or none; of a robot that does not exist nothing is sent."""
        self._robot, self._map = robot, None

    def inspection(self, simulation: Simulation) -> Inspection | None:
        """Return what the robot perceives, decides and believes."""
        robot = self._select(simulation)
        if robot is None:
            return None
        inspection: Any = simulation.inspection()
        if inspection is None:
            inspection = dict.fromkeys(brain.Inspection.__annotations__)
            inspection["belief_state"] = simulation.belief_state(robot)
        return cast("Inspection", {**inspection, "robot": robot})

    def map(self, simulation: Simulation) -> MapPart | None:
        """Return the changes of the robot's map since the last call; None if there are none."""
        robot = self._select(simulation)
        if robot is None:
            return None
        before, now = self._map, simulation.believed_map(robot)
        self._map = now
        if now is None:
            return None
        (left, right), (low, high) = changed(before, now)
        if left == right:
            return None
        rows, columns = now["occupancy"].shape
        return {
            "type": "map",
            "robot": robot,
            "corner": now["corner"],
            "cell_m": now["cell_m"],
            "columns": columns,
            "rows": rows,
            "from": [left, low],
            "size": [right - left, high - low],
            "occupancy": packed(now["occupancy"][low:high, left:right]),
            "unseen": packed(now["unseen"][low:high, left:right]),
        }

    def details(self, simulation: Simulation) -> None:
        """Return None: the inspection contains everything."""

    def _select(self, simulation: Simulation) -> str | None:
        """Select the robot for inspection, and return its name; None if it does not exist now."""
        try:
            simulation.inspect(self._robot)
        except InputError:
            return None
        return self._robot


Span = tuple[int, int]
"""A half-open range of indices; both ends are the same if it is empty."""


def changed(before: BelievedMap | None, now: BelievedMap) -> tuple[Span, Span]:
    """Return the columns and rows in which a map has changed: all if it is another map."""
    rows, columns = now["occupancy"].shape
    if before is None or any(before[key] != now[key] for key in ("corner", "cell_m")):
        return (0, columns), (0, rows)
    if before["occupancy"].shape != now["occupancy"].shape:
        return (0, columns), (0, rows)
    is_changed = (before["occupancy"] != now["occupancy"]) | (before["unseen"] != now["unseen"])
    return span(is_changed.any(axis=0)), span(is_changed.any(axis=1))


def span(marked: NDArray[np.bool_]) -> Span:
    """Return the range from the first to the last marked index."""
    places = np.flatnonzero(marked)
    return (int(places[0]), int(places[-1]) + 1) if len(places) else (0, 0)


def packed(cells: NDArray[Any]) -> str:
    """Return a byte a cell, row by row, in base64."""
    return base64.b64encode(cells.tobytes()).decode()

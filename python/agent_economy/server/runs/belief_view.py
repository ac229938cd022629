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
    """The selected robot, its last decision, and what the page has been sent of its belief map.

    A run inspects one robot at a time. While other pages have selected other robots, the decision
    is the last one that was found. A map has up to 65,000 cells, and a step changes few of them:
    the page is sent the smallest rectangle that contains all changes.
    """

    def __init__(self) -> None:
        """Begin with no robot selected."""
        self._robot: str | None = None
        self._map: BelievedMap | None = None
        self._decision: dict[str, Any] | None = None
        # Whether another page has ended the inspection, and the brain has not stepped since.
        self._is_reset = False

    def choose(self, robot: str | None) -> None:
        """Select a robot, or none; of a robot that does not exist nothing is sent."""
        self._robot, self._map = robot, None
        self._decision, self._is_reset = None, False

    def inspection(self, simulation: Simulation) -> Inspection | None:
        """Return what the robot perceives, decides and believes; None if it does not exist now."""
        robot, is_other = self._robot, simulation._inspected != self._robot  # noqa: SLF001  (ours)
        try:
            simulation.inspect(robot)
        except InputError:
            return None
        if robot is None:
            return None
        found: Any = simulation.inspection()
        self._is_reset = found is None and (self._is_reset or is_other)
        if not (self._is_reset and is_active(simulation, robot)):
            self._decision = found
        if found is None:
            found = self._decision or dict.fromkeys(brain.Inspection.__annotations__)
            found = {**found, "belief_state": simulation.belief_state(robot)}
        return cast("Inspection", {**found, "robot": robot})

    def map(self, simulation: Simulation) -> MapPart | None:
        """Return the changes of the robot's map since the last call; None if there are none."""
        robot = self._robot
        if robot is None:
            return None
        try:
            before, now = self._map, simulation.believed_map(robot)
        except InputError:
            return None
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


def is_active(simulation: Simulation, robot: str) -> bool:
    """Return whether a robot can decide anything."""
    return bool(simulation.status[simulation.robots.index(robot)] == "active")


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

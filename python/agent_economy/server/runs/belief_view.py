"""What a page is told of the robot that it looks at: what it perceives, decides and believes."""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_economy._core import InputError
from agent_economy.runs.belief_state import BelievedMap
from agent_economy.runs.brain import Watched
from agent_economy.runs.simulation import Simulation


class Selected:
    """The robot that a page looks at, and what the page knows of its map.

    A map has up to 65,000 cells, and a look changes few of them: so what is told is the smallest
    rectangle with all that has changed.
    """

    def __init__(self) -> None:
        """Begin with none."""
        self._robot: str | None = None
        self._map: BelievedMap | None = None

    def choose(self, robot: str | None) -> None:
        """Look at a robot, or at none; nothing is told of one that is not there."""
        self._robot, self._map = robot, None

    def mind(self, simulation: Simulation) -> dict[str, Any] | None:
        """Return what the robot perceived, decided and believes, as `messages` says."""
        robot = self._watch(simulation)
        if robot is None:
            return None
        told = simulation.watched()
        if told is None:
            nothing = dict.fromkeys(Watched.__annotations__)
            return {**nothing, "robot": robot, "thoughts": simulation.thoughts(robot)}
        return {**told, "robot": robot}

    def map(self, simulation: Simulation) -> dict[str, Any] | None:
        """Return what of the robot's map the page does not know; None if it knows all."""
        robot = self._watch(simulation)
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

    def told(self, simulation: Simulation) -> None:
        """Return None: its mind says all."""

    def _watch(self, simulation: Simulation) -> str | None:
        """Return the robot, watched from now on; None if there is none of that name now."""
        try:
            simulation.watch(self._robot)
        except InputError:
            return None
        return self._robot


Span = tuple[int, int]
"""From one number to before another; the same if there is nothing."""


def changed(before: BelievedMap | None, now: BelievedMap) -> tuple[Span, Span]:
    """Return the columns and the rows in which a map has changed; all, if it is another."""
    rows, columns = now["occupancy"].shape
    if before is None or any(before[key] != now[key] for key in ("corner", "cell_m")):
        return (0, columns), (0, rows)
    if before["occupancy"].shape != now["occupancy"].shape:
        return (0, columns), (0, rows)
    is_changed = (before["occupancy"] != now["occupancy"]) | (before["unseen"] != now["unseen"])
    return span(is_changed.any(axis=0)), span(is_changed.any(axis=1))


def span(marked: NDArray[np.bool_]) -> Span:
    """Return from the first that is marked to behind the last."""
    places = np.flatnonzero(marked)
    return (int(places[0]), int(places[-1]) + 1) if len(places) else (0, 0)


def packed(cells: NDArray[Any]) -> str:
    """Return a byte a cell, row by row, in base64."""
    return base64.b64encode(cells.tobytes()).decode()

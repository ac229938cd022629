"""Where robots are, how fast they drive, and how much energy they have left."""

from collections.abc import Sequence
from typing import Any

from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.signals.source import Stateless, Values, number, offered, owner_of

METRIC = (
    offered("body/{robot}/x_m", "x", "m"),
    offered("body/{robot}/y_m", "y", "m"),
    offered("body/{robot}/heading_rad", "heading", "rad"),
    offered("body/{robot}/speed_m_s", "speed", "m/s"),
    offered("body/{robot}/charge", "state of charge"),
    offered("body/{robot}/is_active", "active (1) or not (0)"),
)

CLASSIC = (
    offered("body/{robot}/column", "column"),
    offered("body/{robot}/row", "row"),
    offered("body/{robot}/heading_deg", "heading", "°"),
    offered("body/{robot}/speed", "speed", "cells/decision"),
    offered("body/{robot}/left_turns", "left turns"),
    offered("body/{robot}/right_turns", "right turns"),
)


class MetricBodies(Stateless):
    """The bodies of a run of the metric engine."""

    def values(self, simulation: Simulation, paths: Sequence[str]) -> Values:
        """Return the numbers at some paths, ROBOT/NAME."""
        names, poses = simulation.robots, simulation.poses
        columns = {
            "x_m": poses[:, 0],
            "y_m": poses[:, 1],
            "heading_rad": poses[:, 2],
            "speed_m_s": simulation.speeds,
            "charge": simulation.battery,
            "is_active": simulation.status == "active",
        }
        return [of_robot(columns, names, path) for path in paths]


class ClassicBodies(Stateless):
    """The robots of a run of the classic engine."""

    def values(self, simulation: ClassicSimulation, paths: Sequence[str]) -> Values:
        """Return the numbers at some paths, ROBOT/NAME."""
        columns = simulation.team.to_pydict()
        return [of_robot(columns, simulation.robots, path) for path in paths]


def of_robot(columns: Any, names: Sequence[str], path: str) -> float | None:
    """Return the number of a robot at a path."""
    found = owner_of(path, names)
    column = None if found is None else columns.get(found[1])
    if found is None or column is None:
        return None
    value = column[names.index(found[0])]
    return number(value if isinstance(value, str | int | float) else value.item())

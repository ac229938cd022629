"""The goals and controllers of a run of the metric engine, and the goals of the selected robot."""

from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy.runs.simulation import Simulation
from agent_economy.types.page import (
    ControllerView,
    Economy,
    GoalStatus,
    GoalView,
    ServedGoalView,
    ServiceView,
)

Row = Mapping[str, Any]


def economy(simulation: Simulation, selected: str | None) -> Economy | None:
    """Return the goals and controllers; None if the scenario has neither."""
    document = simulation.scenario.to_dict()
    if "goals" not in document and "controllers" not in document:
        return None
    controllers = simulation.controllers
    owned = dict(owned_goals(controllers))
    goals = simulation.goals.to_pylist()
    return {
        "type": "economy",
        "tick": simulation.tick,
        "goals": [goal_view(goal, owned.get(goal["name"], {})) for goal in goals],
        "controllers": [controller_view(each) for each in controllers],
        "service": service_view(simulation, selected),
    }


def owned_goals(controllers: list[dict[str, Any]]) -> Iterator[tuple[str | None, Row]]:
    """Yield the goals that controllers own, by name, each with its `owner`."""
    for controller in controllers:
        for goal in controller["goals"]:
            yield goal["goal"], {**goal, "owner": controller["name"]}


def goal_view(goal: Row, owned: Row) -> GoalView:
    """Return a goal, and what its owner knows of it."""
    assignee = owned.get("assignee")
    status = status_of(goal, assignee)
    return {
        "name": goal["name"],
        "at": [goal["x_m"], goal["y_m"]],
        "status": status,
        "owner": owned.get("owner"),
        "heir": owned.get("heir"),
        "robot": (goal["served_by"] or None) if status == "served" else assignee,
        "lease_s": owned.get("lease_s"),
        "unserved": owned.get("unserved") if owned else goal["unserved"],
    }


def status_of(goal: Row, assignee: str | None) -> GoalStatus:
    """Return the status of a goal."""
    if goal["served_s"] is not None:
        return "served"
    if goal["expired"]:
        return "expired"
    if assignee is not None:
        return "awarded"
    return "pending" if goal["issued_s"] is None else "open"


def controller_view(controller: Row) -> ControllerView:
    """Return a controller without its goals, which have its name."""
    return {
        "name": controller["name"],
        "at": [controller["x_m"], controller["y_m"]],
        "aboard": controller["aboard"],
        "range_m": controller["range_m"],
        "is_working": controller["working"],
        "refused": controller["refused"],
        "orphans": [name for name in controller["orphans"] if name is not None],
    }


def service_view(simulation: Simulation, robot: str | None) -> ServiceView | None:
    """Return the goals that a robot serves; None if it does not exist now."""
    if robot is None or robot not in simulation.robots:
        return None
    goals = [served_goal_view(each) for each in simulation.served_goals(robot)]
    return {"robot": robot, "goals": goals}


def served_goal_view(goal: Row) -> ServedGoalView:
    """Return a goal that a robot serves."""
    return {
        "goal": goal["goal"],
        "at": [goal["x_m"], goal["y_m"]],
        "owner": goal["owner"],
        "lease_s": goal["lease_s"],
        "verdict": goal["verdict"],
    }

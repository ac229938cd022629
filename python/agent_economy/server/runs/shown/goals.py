"""The goals and controllers of a run, as it and the owners of goals know them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from agent_economy.runs.simulation import Simulation
from agent_economy.types.brain import Point
from agent_economy.types.page import Colour

Row = Mapping[str, Any]

COLOURS: tuple[Colour, ...] = ("owner-1", "owner-2", "owner-3", "owner-4", "owner-5", "owner-6")
"""Controllers beyond these share them in turn."""

NO_OWNER: Colour = "border"

FAINT = 0.25
"""Opacity of what belongs to other controllers than the chosen one."""

STATUSES = {
    "pending": "not yet issued",
    "open": "open",
    "awarded": "awarded",
    "in_service": "in service",
    "served": "served",
    "expired": "expired",
    "reported": "reported",
    "unknown": "unknown to all working agents",
}
"""The status of a goal in words."""

OPEN = ("waiting", "owned")
"""States of goals that are open: the operator is to issue them, or a controller owns them."""


class Goal(NamedTuple):
    """A goal.

    Attributes:
        name: Its name, KIND/INDEX.
        at: Its position.
        status: One of `STATUSES`.
        owner: The controller that owns it; None if none does.
        votes: The controllers that vote for its owner.
        robot: The robot that it is awarded to, or that served it.
        lease_s: Remaining time of that robot's lease, on the owner's clock; None if it has none.
        unserved: Why no robot can serve it at present; None if one can.
    """

    name: str
    at: Point
    status: str
    owner: str | None
    votes: Sequence[str]
    robot: str | None
    lease_s: float | None
    unserved: str | None


class Picture(NamedTuple):
    """Goals and controllers, and the chosen controller."""

    goals: list[Goal]
    controllers: Sequence[Row]
    chosen: str | None

    def colour(self, owner: str | None) -> Colour:
        """Return the colour of what belongs to a controller."""
        names = [each["name"] for each in self.controllers]
        return COLOURS[names.index(owner) % len(COLOURS)] if owner in names else NO_OWNER

    def opacity(self, owner: str | None) -> float:
        """Return the opacity of what belongs to a controller."""
        return 1.0 if self.chosen in (None, owner) else FAINT


def goals_of(simulation: Simulation, controllers: list[dict[str, Any]]) -> list[Goal]:
    """Return the goals of a run, in the order of their kinds and indices."""
    owned = dict(owned_goals(controllers))
    goals = simulation.goals.to_pylist()
    return [goal(each, owned.get(each["name"], {})) for each in goals]


def owned_goals(controllers: list[dict[str, Any]]) -> Iterator[tuple[str | None, Row]]:
    """Yield the goals that controllers own, by name, each with its `owner`."""
    for controller in controllers:
        for each in controller["goals"]:
            yield each["goal"], {**each, "owner": controller["name"]}


def goal(of: Row, owned: Row) -> Goal:
    """Return a goal, with what its owner knows of it."""
    assignee = owned.get("assignee")
    status = "open" if of["status"] in OPEN else of["status"]
    reported = of["unserved"] if status == "reported" else None
    return Goal(
        name=of["name"],
        at=(of["x_m"], of["y_m"]),
        status=status,
        owner=owned.get("owner"),
        votes=owned.get("votes", ()),
        robot=(of["served_by"] or None) if status == "served" else assignee,
        lease_s=owned.get("lease_s"),
        unserved=owned.get("unserved") if owned else reported,
    )

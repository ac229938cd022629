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
    "served": "served",
    "expired": "expired",
}
"""The status of a goal in words."""

REASONS = {
    "unreachable": "no path leads there",
    "capability": "no robot has the capability",
    "deadline": "every robot would be too late",
    "battery": "no battery lasts",
    "full": "every robot serves its maximum number of goals",
    "lease": "the service takes longer than a lease",
    "out_of_service": "the robots are out of service",
    "no_robot": "no robot is in range",
    "orphaned": "its owner has lost it: the heir did not renew the lease",
    "no_controller": "no controller works",
    "position": "no robot knows its position well enough",
}
"""Why no robot can serve a goal."""


class Goal(NamedTuple):
    """A goal.

    Attributes:
        name: Its name, KIND/INDEX.
        at: Its position.
        status: One of `STATUSES`.
        owner: The controller that owns it; None if none does.
        heir: The controller that inherits it; None if none does.
        robot: The robot that it is awarded to, or that served it.
        lease_s: Remaining time of that robot's lease, on the owner's clock; None if it has none.
        unserved: Why no robot can serve it at present; None if one can.
    """

    name: str
    at: Point
    status: str
    owner: str | None
    heir: str | None
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
    status = status_of(of, assignee)
    return Goal(
        name=of["name"],
        at=(of["x_m"], of["y_m"]),
        status=status,
        owner=owned.get("owner"),
        heir=owned.get("heir"),
        robot=(of["served_by"] or None) if status == "served" else assignee,
        lease_s=owned.get("lease_s"),
        unserved=owned.get("unserved") if owned else of["unserved"],
    )


def status_of(of: Row, assignee: str | None) -> str:
    """Return the status of a goal."""
    if of["served_s"] is not None:
        return "served"
    if of["expired"]:
        return "expired"
    if assignee is not None:
        return "awarded"
    return "pending" if of["issued_s"] is None else "open"


def reason_label(unserved: str) -> str:
    """Return why no robot can serve a goal, in words."""
    return REASONS.get(unserved, unserved)

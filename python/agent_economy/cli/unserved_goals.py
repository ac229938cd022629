"""Goals that no robot can serve, as controllers report them."""

from typing import NamedTuple

from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped

REASONS = {
    "unreachable": "no robot can reach it",
    "capability": "no robot has the capability",
    "deadline": "every robot would be too late",
    "battery": "no battery lasts",
    "full": "every robot serves its maximum number of goals",
    "lease": "the service takes longer than a lease",
    "out_of_service": "the robots are out of service",
    "no_robot": "no robot is in range",
    "orphaned": "its owner has lost it, because the heir did not renew the lease",
    "no_controller": "no controller works that could own it",
    "position": "no robot knows its position well enough",
}
"""Reasons of controllers, in words."""


class Unserved(NamedTuple):
    """A goal that no robot can serve.

    Attributes:
        goal: Name of the goal, KIND/INDEX.
        reason: Why, as a controller last reported.
    """

    goal: str
    reason: str

    def __str__(self) -> str:
        """Return it as a sentence."""
        return f"Goal {self.goal}: {REASONS.get(self.reason, self.reason)}."


def unserved_goals(simulation: Stepped) -> list[Unserved]:
    """Return the goals of a run that controllers reported and no robot has served since."""
    if not isinstance(simulation, Simulation):
        return []
    goals = simulation.goals.select(["name", "unserved"]).to_pylist()
    return [Unserved(each["name"], each["unserved"]) for each in goals if each["unserved"]]

"""What is left of the goals of a run, and why."""

from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

from agent_economy.runs.reasons import reason_label
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped


class Unserved(NamedTuple):
    """A goal that no robot can serve.

    Attributes:
        goal: Name of the goal, KIND/INDEX.
        reason: Why, as a controller or robot last reported.
    """

    goal: str
    reason: str


@dataclass(frozen=True)
class GoalsLeft:
    """The goals that were not served, as far as it is known why.

    Attributes:
        unserved_goals: Goals that a controller or robot reported and no robot has served since.
        failed_controllers: Names of the controllers that do not work.
        unknown_goals: Names of the goals that no working agent knows: all that had them do not
            work.
    """

    unserved_goals: list[Unserved] = field(default_factory=list)
    failed_controllers: list[str] = field(default_factory=list)
    unknown_goals: list[str] = field(default_factory=list)

    def document(self) -> dict[str, Any]:
        """Return it for JSON."""
        return asdict(self) | {"unserved_goals": [each._asdict() for each in self.unserved_goals]}

    def lines(self) -> list[str]:
        """Return it as sentences."""
        reported = [
            f"Goal {each.goal}: {reason_label(each.reason)}." for each in self.unserved_goals
        ]
        failed = [f"Controller {name} does not work." for name in self.failed_controllers]
        unknown = [f"Goal {name}: no working agent knows it." for name in self.unknown_goals]
        return [*reported, *failed, *unknown]


def goals_left(simulation: Stepped) -> GoalsLeft:
    """Return what is left of the goals of a run."""
    if not isinstance(simulation, Simulation):
        return GoalsLeft()
    goals = simulation.goals.select(["name", "status", "unserved"]).to_pylist()
    return GoalsLeft(
        [Unserved(each["name"], each["unserved"]) for each in goals if each["unserved"]],
        [each["name"] for each in simulation.controllers if not each["working"]],
        [each["name"] for each in goals if each["status"] == "unknown"],
    )

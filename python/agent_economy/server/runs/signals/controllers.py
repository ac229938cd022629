"""What controllers own, and what they believe of a mined lane."""

from collections.abc import Mapping, Sequence
from typing import Any

from agent_economy.runs.lane import BelievedLane
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.signals.source import Stateless, Values, number, offered, owner_of
from agent_economy.types.page import SignalOffer

OWNED = {
    "goals": "goals owned",
    "awarded": "goals awarded",
    "lost": "lost goals",
    "refused": "goals refused",
}
BELIEVED = {
    "risk": "remaining risk",
    "unmarked": "expected mines without a mark",
    "marked": "expected mines at marks",
    "marks": "marks",
}


def offer(simulation: Simulation) -> list[SignalOffer]:
    """Return the signals of the controllers of a run, and the mines that are left in its lane."""
    lanes = [lane.controller for lane in simulation.lanes]
    own = [
        offered(f"controller/{each['name']}/{key}", label, of=each["name"])
        for each in simulation.controllers
        for key, label in OWNED.items()
    ]
    believed = [
        offered(f"controller/{name}/{key}", label, of=name)
        for name in lanes
        for key, label in BELIEVED.items()
    ]
    return [*own, *believed]


class Controllers(Stateless):
    """The controllers of a run of the metric engine."""

    def values(self, simulation: Simulation, paths: Sequence[str]) -> Values:
        """Return the numbers at some paths, CONTROLLER/NAME."""
        controllers = {each["name"]: each for each in simulation.controllers}
        is_believed = any(path.rpartition("/")[2] in BELIEVED for path in paths)
        lanes = {lane.controller: lane for lane in simulation.lanes} if is_believed else {}
        found = (owner_of(path, list(controllers)) for path in paths)
        return [
            None if each is None else value(each[1], controllers[each[0]], lanes.get(each[0]))
            for each in found
        ]


def value(key: str, controller: Mapping[str, Any], lane: BelievedLane | None) -> float | None:
    """Return a number of a controller; None if there is none of this name."""
    if key == "awarded":
        return float(sum(goal["assignee"] is not None for goal in controller["goals"]))
    if key in OWNED:
        owned = controller[key]
        return number(owned if isinstance(owned, int) else len(owned))
    if lane is None or key not in BELIEVED:
        return None
    risk = lane.risk
    believed = {"risk": risk.probability, "unmarked": risk.unmarked, "marked": risk.marked}
    return number(believed.get(key, float(len(lane.marks))))

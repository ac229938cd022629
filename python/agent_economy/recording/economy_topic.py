"""The topic of goals and controllers, and their events in the log."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log

from agent_economy import _core
from agent_economy.recording import schemas
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import log
from agent_economy.runs.events import OWNERSHIP_LOST
from agent_economy.runs.simulation import Simulation

TOPIC = "/economy"

Content = Mapping[str, Mapping[str, Any]]

OF_OWNERS = ("assignee", "lease_s", "owner_lease_s", "unserved")
OF_CONTROLLERS = ("name", "x_m", "y_m", "range_m", "working", "refused")


class EconomyTopic:
    """Writes the goals and controllers of a run, if its scenario has any."""

    def __init__(self, file: File, simulation: Simulation, logged: set[str]) -> None:
        """Declare the topic; `logged` are the warnings in the log."""
        document = simulation.scenario.to_dict()
        self._is_on = any(document.get(key) for key in ("goals", "controllers"))
        self._file, self._simulation = file, simulation
        self._logged = logged
        if self._is_on:
            file.declare(TOPIC, schemas.ECONOMY)

    def write(self, time_ns: int) -> None:
        """Write the current step, and log what has happened since the previous one."""
        if not self._is_on:
            return
        content = economy_of(self._simulation)
        self._file.write_json(TOPIC, content, time_ns)
        goals = content["goals"]
        # An owned goal can be lost again; that a goal cannot be served is reported once.
        names = zip(goals["name"], goals["owner"], strict=True)
        self._logged.difference_update(
            f"{name}: {OWNERSHIP_LOST}" for name, owner in names if owner
        )
        for name, words in warnings(content).items():
            if (event := f"{name}: {words}") not in self._logged:
                self._logged.add(event)
                self._file.write("/log", log(time_ns, Log.WARNING, name, words), time_ns)


def economy_of(simulation: Simulation) -> Content:
    """Return the goals and controllers of a run, as lists."""
    controllers = simulation.controllers
    goals: dict[str, Any] = _core.goals(simulation._run)  # noqa: SLF001  (ours)
    working = [each for each in controllers if each["working"]]
    owned = {
        goal["goal"]: {"owner": each["name"], **goal}
        for each in reversed(working)
        for goal in each["goals"]
    }
    lost = {name for each in working for name in each["lost"]}
    owners = [owned.get(name, {}) for name in goals["name"]]
    states = [
        state(goals, place, owner, is_lost=name in lost)
        for place, (name, owner) in enumerate(zip(goals["name"], owners, strict=True))
    ]
    return {
        "goals": {
            "name": goals["name"],
            "x_m": goals["x_m"].tolist(),
            "y_m": goals["y_m"].tolist(),
            "state": states,
            "votes": [owner.get("votes", []) for owner in owners],
            **{key: [owner.get(key) for owner in owners] for key in ("owner", *OF_OWNERS)},
        },
        "controllers": {key: [each[key] for each in controllers] for key in OF_CONTROLLERS},
    }


def state(goals: Mapping[str, Any], place: int, owner: Mapping[str, Any], *, is_lost: bool) -> str:
    """Return the state of a goal, in one word."""
    if np.isfinite(goals["served_s"][place]):
        return "served"
    if goals["expired"][place]:
        return "expired"
    if not np.isfinite(goals["issued_s"][place]):
        return "later"
    if not owner:
        return "lost" if is_lost else "unowned"
    return "open" if owner["assignee"] is None else "awarded"


def warnings(content: Content) -> dict[str, str]:
    """Return what an operator must know, by the name of a goal or controller.

    They are the goals that controllers report because no robot can serve them, goals that no
    controller owns because no majority votes for one, and controllers that have failed.
    """
    goals, controllers = content["goals"], content["controllers"]
    rows = zip(goals["name"], goals["state"], goals["unserved"], strict=True)
    found = {}
    for name, is_state, reason in rows:
        if is_state == "lost":
            found[name] = OWNERSHIP_LOST
        elif is_state == "open" and reason is not None:
            found[name] = f"no robot can serve it: {reason}"
    names = zip(controllers["name"], controllers["working"], strict=True)
    return found | {name: "has failed" for name, is_working in names if not is_working}

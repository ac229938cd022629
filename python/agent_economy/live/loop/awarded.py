"""Goals that controllers award to the robots of a drive, and how each of them ends.

That a real robot serves a goal is known from its messages: the judge of the run knows only the
position that the robot measures, later than the robot does.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.runs.simulation import Simulation

QUIET_S = 30.0
"""A goal is given up if none is awarded for this time, and that of auctions, while a robot drives.

It exceeds the pause after which a controller offers a goal for the second time, 20 s.
"""

MOVING = ("approaching", "receding")

FAILOVER_S, TURN_S = 22.0, 3.0
"""Two candidacies and a repeated request, and the turn of each controller, in seconds."""

DEFAULTS_S = {"auction_s": 1.0, "owner_lease_s": 30.0, "service_lease_s": 20.0}
"""Defaults of keys of controllers."""


@dataclass
class AwardedGoals:
    """The goals of a scenario whose controllers award them.

    Attributes:
        robots: The real robots that serve awarded goals.
        quiet_s: Time without an awarded goal after which a goal is given up; it begins when the
            goal is issued.
    """

    robots: frozenset[str]
    quiet_s: float
    _simulation: Simulation
    _done: dict[tuple[int, int], str] = field(default_factory=dict)
    _given_up: set[str] = field(default_factory=set)
    _awarded: dict[str, str] = field(default_factory=dict)
    _goals: Mapping[str, Any] = field(default_factory=dict)
    _busy_s: float | None = None
    _issued_s: dict[str, float] = field(default_factory=dict)

    def add(self, robot: str, outbox: Iterable[Mapping[str, Any]]) -> None:
        """Take the messages that a real robot sends."""
        for message in outbox:
            about = message["about"].get("goal")
            if about is None or about["status"] != "done":
                continue
            goal = about["id"]
            goals = goal["issuer"].get("list")
            if goals is not None:
                self._done.setdefault((goals, goal["number"]), robot)

    def update(self, now_s: float, *, is_driving: bool) -> None:
        """Take the state of the run; `is_driving` is whether the brain of a real robot steps."""
        if not self.robots:
            return
        self._goals = _core.goals(self._simulation._run)  # noqa: SLF001  (ours)
        owned = [each["goals"] for each in self._simulation.controllers if each["working"]]
        self._awarded = {
            goal["goal"]: goal["assignee"]
            for goals in owned
            for goal in goals
            if goal["assignee"] is not None
        }
        if self._awarded or not is_driving or self._busy_s is None:
            self._busy_s = now_s
        issued = np.isfinite(self._goals["issued_s"])
        for name, was, late in zip(
            self._goals["name"], issued, self._goals["expired"], strict=True
        ):
            if was:
                self._issued_s.setdefault(name, now_s)
            if late or self._is_quiet(name, now_s):
                self._given_up.add(name)

    def _is_quiet(self, name: str, now_s: float) -> bool:
        """Return whether no goal was awarded for the quiet time, in which this one was issued."""
        issued_s, busy_s = self._issued_s.get(name), self._busy_s
        if issued_s is None or busy_s is None:
            return False
        return now_s - max(issued_s, busy_s) > self.quiet_s

    def verdicts(self) -> Iterator[dict[str, Any]]:
        """Yield the name, the place, the verdict and the robot of each goal, in order.

        One that has been given up is impossible, also while a robot tries it again.
        """
        for place, name in enumerate(self._goals.get("name", ())):
            goal = {key: values[place] for key, values in self._goals.items()}
            verdict, robot = self._verdict(name, goal)
            reason = goal["unserved"] if verdict != "complete" else ""
            at_m = [float(goal["x_m"]), float(goal["y_m"])]
            yield {
                "goal": name,
                "at_m": at_m,
                "verdict": verdict,
                "served_by": robot,
                "unserved": reason or None,
            }

    def _verdict(self, name: str, goal: Mapping[str, Any]) -> tuple[str, str | None]:
        done_by = self._done.get((int(goal["issuer"]), int(goal["number"]))) or goal["served_by"]
        if done_by:
            return "complete", done_by
        if name in self._given_up:
            return "impossible", None
        robot = self._awarded.get(name)
        if robot is None:
            return "pending", None
        served = self._simulation.served_goals(robot)
        known = next((each["verdict"] for each in served if each["goal"] == name), "pending")
        return known if known in MOVING else "pending", robot


def awarded_to(simulation: Simulation, robots: Iterable[str]) -> AwardedGoals:
    """Return the goals of a run that controllers award to some real robots; none without them."""
    scenario = simulation.scenario.to_dict()
    controllers = [each for each in scenario.get("controllers", {}).values() if each["count"]]
    serving = {name for name in robots if serves(scenario, name)} if controllers else set()
    return AwardedGoals(frozenset(serving), quiet_time_s(controllers), simulation)


def quiet_time_s(controllers: Sequence[Mapping[str, Any]]) -> float:
    """Return how long no goal may be awarded although one will be.

    That is a pause, two auctions, and, if controllers take the goals of a lost one over, the leases
    of an owner and of a robot that are lost, and the turns of those that take them over.
    """
    auction_s, owner_s, service_s = (
        max((float(each.get(key, default)) for each in controllers), default=0.0)
        for key, default in DEFAULTS_S.items()
    )
    voters = [each["count"] for each in controllers if each.get("backup") != "none"]
    most = max(voters, default=0)
    failover_s = owner_s + service_s + FAILOVER_S + TURN_S * most if most > 1 else 0.0
    return QUIET_S + 2 * auction_s + failover_s


def serves(scenario: Mapping[str, Any], robot: str) -> bool:
    """Return whether the brain of a robot has the behaviour `serve`."""
    brain = scenario["robots"][robot.rpartition("/")[0]].get("brain", {})
    return any(behaviour["kind"] == "serve" for behaviour in brain.get("behaviours", []))

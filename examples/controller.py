"""Write a controller in Python: it awards the goals of a run by a rule of its own.

The controller replaces that of the scenario. It receives the percepts of that controller and
answers with messages, so that its awards take effect by radio only. Its rule: of the robots that
bid, the one with the fewest awards so far gets a goal; of several, the one that is there soonest.
"""

from collections import Counter
from typing import Any

import agent_economy as ae
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.controller import ControllerSettings

LEASE_S = 20.0
"""A robot may serve a goal for this time without renewal."""

WAIT_S = LEASE_S * 1.001
"""Another robot is awarded the goal after this time without renewal: clocks may drift."""

ROUND_S = 1.0
STILL: Any = {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}


class Goal:
    """A goal that the controller owns, and the robot that serves it until its lease ends."""

    def __init__(self, task: Any) -> None:
        """Own a goal."""
        self.task, self.robot, self.until_s = task, None, 0.0
        self.bids: list[Any] = []


class Fair:
    """A controller that awards each goal to the robot with the fewest awards."""

    def __init__(self, settings: ControllerSettings) -> None:
        """Own no goal yet; the rule needs no settings."""
        del settings
        self.goals: dict[int, Goal] = {}
        self.awards: Counter[str] = Counter()
        self.next_round_s = 0.0
        self.outbox: list[Any] = []

    def step(self, percept: Percept) -> Command:
        """Return the messages to send."""
        self.outbox = []
        time_s = percept["time_s"] or 0.0
        for received in percept["inbox"]:
            about: Any = received["message"]["about"]
            for subject in ("contract", "lease"):
                for kind, content in about.get(subject, {}).items():
                    self.receive(received["from"], kind, content, time_s)
        if time_s >= self.next_round_s:
            self.next_round_s = time_s + ROUND_S
            self.award(time_s)
            self.call(time_s)
        return {"motion": STILL, "heading_rad": None, "requests": [], "outbox": self.outbox}

    def receive(self, sender: Any, kind: str, content: Any, time_s: float) -> None:
        """Take a message."""
        if kind == "issue":
            self.goals[content["id"]["number"]] = Goal(content)
        elif kind == "renew":  # of all leases at once: let the robot renew each by itself
            self.send(sender, "differs", content["number"], "lease")
        elif kind in ("bid", "renew_one", "done", "refuse", "stuck", "release"):
            self.answer(sender, kind, content, time_s)

    def answer(self, sender: Any, kind: str, content: Any, time_s: float) -> None:
        """Take a message about one goal."""
        claim = {"goal": content["goal"], "number": content["number"]}
        goal = self.goals.get(content["goal"]["number"])
        if kind == "done":
            self.goals.pop(content["goal"]["number"], None)
            self.send(sender, "withdraw", claim)  # the robot need not report it again
        elif goal is None:
            return
        elif kind == "bid":
            goal.bids.append((sender, content))
        elif sender == goal.robot and kind == "renew_one":
            goal.until_s = time_s + WAIT_S
            self.send(sender, "renewed_one", claim, "lease")
        elif sender == goal.robot:  # it gives the goal back
            self.take_back(goal)

    def award(self, time_s: float) -> None:
        """Award one goal: then the bids for the others are out of date."""
        bids = [(goal, *bid) for goal in self.goals.values() for bid in goal.bids]
        free = [bid for bid in bids if bid[0].robot is None and bid[0].until_s <= time_s]
        if free:
            goal, robot, bid = min(
                free, key=lambda each: (self.awards[str(each[1])], each[2]["time_s"])
            )
            goal.robot, goal.until_s = robot, time_s + WAIT_S
            self.awards[str(robot)] += 1
            award = {"goal": bid["goal"], "number": bid["number"], "lease_s": LEASE_S}
            self.send(robot, "award", award)

    def call(self, time_s: float) -> None:
        """Call for bids for all goals that no robot serves."""
        for number, goal in self.goals.items():
            goal.bids = []
            if goal.robot is not None and goal.until_s <= time_s:
                self.take_back(goal)
            if goal.robot is None:
                self.send(None, "call", {"number": number, "task": goal.task})

    def take_back(self, goal: Goal) -> None:
        """Own a goal that no robot serves any more."""
        self.awards[str(goal.robot)] -= 1
        goal.robot, goal.until_s = None, 0.0

    def send(self, to: Any, kind: str, content: Any, subject: str = "contract") -> None:
        """Send a message to an agent, or to all with None."""
        message = {"about": {subject: {kind: content}}, "confidence": 1.0}
        self.outbox.append(message if to is None else message | {"to": to})


def main() -> None:
    """Compare it with the controller of the scenario."""
    serve = [{"kind": "serve"}, {"kind": "avoid"}]  # nothing without an award
    scenario = ae.Scenario.load("waypoints").replace("robots.rover.count", 4)
    scenario = scenario.replace("robots.rover.brain.behaviours", serve)
    for name, controllers in {"auction": None, "fair": {"base": Fair}}.items():
        simulation = ae.Simulation(scenario, seed=1, controllers=controllers)
        simulation.finish()
        served = Counter(simulation.goals["served_by"].to_pylist())
        shares = ", ".join(f"{robot} {served[robot]}" for robot in simulation.robots)
        print(f"{name}: {simulation.outcome().time_s} s; goals served: {shares}")


if __name__ == "__main__":
    main()

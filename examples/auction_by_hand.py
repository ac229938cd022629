"""Carry the messages between two robots and a controller by hand, over a radio that loses some.

Brains and controllers know only their percepts, and act only by their commands. What is between
them is up to you: here, a loop that moves the robots and loses a quarter of all messages.
"""

import math
from typing import Any

import numpy as np

import agent_economy as ae
from agent_economy.runs.brain import Body, Command, Percept

STEP_S = 0.2
LOSS_PROBABILITY = 0.25
GOALS_M = [(2, 8), (18, 3), (9, 17), (4, 4), (16, 14)]

OPERATOR = {"role": "person", "kind": 0, "index": 0}
ROVERS = [{"kind": 0, "index": index} for index in range(2)]
BASE = {
    "role": "controller",
    "kind": 1,
    "index": 0,
}  # kinds of controllers are numbered after all kinds of robots

ROVER: Body = {
    "radius_m": 0.3,
    "max_speed_m_s": 1.0,
    "max_acceleration_m_s2": 1.0,
    "max_turn_rate_rad_s": 2.0,
    "period_s": STEP_S,
    "others": [{"radius_m": 0.3, "is_in_the_way": False}],
    "field": [[0, 0], [20, 20]],
}


def issued(number: int) -> dict[str, Any]:
    """Return the message by which a person issues a goal to the controller."""
    task = {
        "id": {"issuer": OPERATOR, "number": number},
        "at_m": GOALS_M[number],
        "radius_m": 0.5,
        "value": 1,
        "service_s": 2,
        "due_s": 3600,
        "work": "visit",
        "capability": 0,
    }
    message = {"to": BASE, "about": {"contract": {"issue": task}}, "confidence": 1}
    return {"from": OPERATOR, "age_s": 0, "message": message}


class Rover:
    """A robot: a brain in a body that does what it commands."""

    def __init__(self, x_m: float, y_m: float) -> None:
        """Place the robot."""
        brain = {"behaviours": [{"kind": "serve"}], "beliefs": {}}
        self.brain = ae.Brain(brain, ROVER)
        self.x_m, self.y_m, self.heading_rad = x_m, y_m, 0.0

    def sensed(self) -> Percept:
        """Return the readings of its sensors."""
        position: Any = {"value": [self.x_m, self.y_m], "age_s": 0}
        return {"position": position, "heading_rad": {"value": self.heading_rad, "age_s": 0}}

    def move(self, command: Command) -> None:
        """Execute a motion command for one step."""
        motion = command["motion"]
        turned_rad = self.heading_rad + motion["turn_rate_rad_s"] * STEP_S
        self.heading_rad = math.remainder(turned_rad, math.tau)
        self.x_m += motion["speed_m_s"] * STEP_S * math.cos(self.heading_rad)
        self.y_m += motion["speed_m_s"] * STEP_S * math.sin(self.heading_rad)


class Radio:
    """Carries messages from step to step, and loses some of them."""

    def __init__(self, ids: list[Any]) -> None:
        """Take the ids of all that send and receive."""
        self.ids, self.random = ids, np.random.default_rng(1)
        self.sent = self.lost = 0

    def carry(self, commands: list[Command]) -> list[list[Any]]:
        """Return the messages that each agent receives, of the commands of all agents."""
        inboxes: list[list[Any]] = [[] for _ in self.ids]
        for sender, command in zip(self.ids, commands, strict=True):
            for message in command["outbox"]:
                for receiver, inbox in zip(self.ids, inboxes, strict=True):
                    is_addressed = message.get("to", receiver) == receiver  # without it: to all
                    if receiver != sender and is_addressed and self.arrives():
                        inbox.append({"from": sender, "age_s": STEP_S, "message": message})
        return inboxes

    def arrives(self) -> bool:
        """Draw whether a message arrives."""
        is_lost = bool(self.random.random() < LOSS_PROBABILITY)
        self.sent, self.lost = self.sent + 1, self.lost + is_lost
        return not is_lost


def main() -> None:
    """Run the auction until all goals are served."""
    base = ae.Controller({"allocation": "auction"})
    rovers = [Rover(9, 10), Rover(11, 10)]
    radio = Radio([*ROVERS, BASE])
    inboxes = [[], [], [issued(number) for number in range(len(GOALS_M))]]
    served_by: dict[int, int] = {}
    for step in range(2000):
        time_s = step * STEP_S
        commands = []
        for own, rover, inbox in zip(ROVERS, rovers, inboxes, strict=False):
            percept: Any = {"time_s": time_s, "id": own, "inbox": inbox, **rover.sensed()}
            commands.append(rover.brain.step(percept))
            rover.move(commands[-1])
        received: Any = {"time_s": time_s, "id": BASE, "inbox": inboxes[-1]}
        commands.append(base.step(received))
        inboxes = radio.carry(commands)
        report(time_s, base, served_by)
        if not base.goals:
            break
    print(f"{radio.lost} of {radio.sent} messages were lost")


def report(time_s: float, base: ae.Controller, served_by: dict[int, int]) -> None:
    """Print the awards and the served goals since the last step."""
    owned = {goal["task"]["id"]["number"]: goal["assignee"] for goal in base.goals}
    for number, robot in owned.items():
        if robot is not None and robot["index"] != served_by.get(number):
            print(f"{time_s:5.1f} s: goal {number} is awarded to rover {robot['index']}")
            served_by[number] = robot["index"]
    for number in served_by.keys() - owned.keys():
        print(f"{time_s:5.1f} s: goal {number} has been served by rover {served_by.pop(number)}")


if __name__ == "__main__":
    main()

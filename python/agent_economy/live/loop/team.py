"""The real robots of a drive: their percepts, motions and goals. It reads no clock."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from agent_economy import _core
from agent_economy.live.loop.awarded import awarded_to
from agent_economy.live.loop.percepts import Percepts
from agent_economy.live.loop.shared import shared_by
from agent_economy.live.plan import FleetPlan
from agent_economy.live.readings import reading_of
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.simulation import Simulation

Setpoint = tuple[float, float, float | None]
"""Speed in m/s, turn rate in rad/s, and the heading to turn to in radians, if any."""

STOP: Setpoint = (0.0, 0.0, None)

OPERATOR = {"role": "person", "kind": 0, "index": 0}
"""The id of the operator, which no robot has."""


class Team:
    """The robots of a fleet in a run. A replay uses it as the loop does."""

    def __init__(
        self,
        plan: FleetPlan,
        simulation: Simulation,
        waypoints_m: Mapping[str, Any],
        *,
        seed: int,
        start_s: float,
    ) -> None:
        """Create it without readings.

        Args:
            plan: The fleet.
            simulation: The run, in which the robots have external bodies.
            waypoints_m: The waypoints that the operator orders at the start, by robot.
            seed: Seed of the random bits of percepts.
            start_s: The time at which the drive started, by the clock of the time stamps.
        """
        self._simulation = simulation
        bodies = _core.recorded_setting(simulation._run)["bodies"]  # noqa: SLF001  (ours)
        kinds = list(bodies)
        self._robots: dict[str, Percepts] = {}
        self._periods: dict[str, int] = {}
        self._sonars: dict[str, Sequence[int | None]] = {}
        for robot in plan.robots:
            kind, _, index = robot.name.rpartition("/")
            count = sum(name.startswith(f"{kind}/") for name in simulation.robots)
            base = {"id": {"kind": kinds.index(kind), "index": int(index)}, "team_size": count}
            self._robots[robot.name] = Percepts(robot.name, base, seed, start_s)
            self._periods[robot.name] = max(1, round(bodies[kind]["period_s"] / simulation.step_s))
            rings = len(bodies[kind]["rings"])
            self._sonars[robot.name] = range(rings) if robot.scans is None else robot.scans
        self._orders = {name: orders(waypoints_m.get(name, ())) for name in self._robots}
        self._ordered = {name: len(waypoints_m.get(name, ())) for name in self._robots}
        self._motions = dict.fromkeys(self._robots, STOP)
        scenario = simulation.scenario.to_dict()
        self._waypoints = {name: waypoints_of(scenario, name) for name in self._robots}
        self._shared = tuple(shared_by(scenario, self._robots))
        self._awarded = awarded_to(simulation, self._robots)
        self._now_s = start_s
        self._verdicts: dict[tuple[str, str], tuple[str | None, ...]] = {}
        self._silent: set[str] = set()
        self._reasons: dict[tuple[float, ...], str] = {}

    def add(self, message: Mapping[str, Any]) -> None:
        """Take a reading, an event or an order of the warden."""
        name = message["robot"]
        robot = self._robots[name]
        if message["type"] == "reading":
            robot.add_reading(reading_of(message), message["t"])
        elif message["type"] == "event":
            robot.add_event(message)
        elif message["type"] == "order":
            self._orders[name].append(order(self._ordered[name], message["at_m"], "assign"))
            self._ordered[name] += 1

    def percepts(self, tick: int, now_s: float) -> dict[str, Percept]:
        """Return the percepts of the robots whose brains step in a tick.

        The brain of a robot that may not move, or that an operator drives, does not step: it would
        find that it gets nowhere.
        """
        self._now_s = now_s
        percepts = {}
        for name, robot in self._robots.items():
            if robot.is_driving and tick % self._periods[name] == 0:
                percepts[name] = robot.percept(tick, now_s, self._sonars[name])
                percepts[name]["inbox"] = self._orders[name]
                self._orders[name] = []
        return percepts

    def observed(self, tick: int, now_s: float) -> dict[str, Percept]:
        """Return the percepts of the other robots, whose brains do not step: where these are."""
        return {
            name: robot.percept(tick, now_s, self._sonars[name])
            for name, robot in self._robots.items()
            if not robot.is_driving and tick % self._periods[name] == 0
        }

    def motions(self, commands: Mapping[str, Command]) -> dict[str, Setpoint]:
        """Return the setpoint of each robot: its last command, or stop while it steps no brain."""
        for name, command in commands.items():
            motion, heading_rad = command["motion"], command["heading_rad"]
            speed, rate = motion["speed_m_s"], motion["turn_rate_rad_s"]
            self._motions[name] = (speed, rate, heading_rad)
            self._awarded.add(name, command["outbox"])
            for waypoints in self._shared:
                if name in waypoints.robots:
                    waypoints.add(name, command["outbox"], self._now_s)
                    self._note_reasons(name)
        for name, robot in self._robots.items():
            if not robot.is_driving:
                self._motions[name] = STOP
        return dict(self._motions)

    def new_verdicts(self) -> Iterator[dict[str, Any]]:
        """Yield the goals whose verdicts have changed.

        Waypoints are numbered from 1 for each robot; goals of controllers have their names. A
        verdict counts as reported when the next one is taken, so that one that could not be sent
        is yielded again the next time. A waypoint that a team shares, and a goal that a controller
        awards, is a goal of each of its robots, with the name of the one that goes or went there.
        """
        is_driving = any(robot.is_driving for robot in self._robots.values())
        self._awarded.update(self._now_s, is_driving=is_driving)
        awarded = list(self._awarded.verdicts())
        for name in self._robots:
            waypoints = [*self._own_goals(name), *self._shared_goals(name)]
            goals = [{"goal": str(number), **each} for number, each in enumerate(waypoints, 1)]
            goals += awarded if name in self._awarded.robots else []
            for goal in goals:
                key = (name, goal["goal"])
                state = (goal["verdict"], goal["served_by"], goal.get("unserved"))
                if self._verdicts.get(key) != state:
                    yield {"robot": name, **goal}
                    self._verdicts[key] = state

    def new_silence(self) -> Iterator[dict[str, Any]]:
        """Yield the robots of teams that have become silent on the radio, or are so no more."""
        silent = set().union(*(each.silent(self._now_s) for each in self._shared))
        for name in sorted(silent ^ self._silent):
            yield {"robot": name, "is_silent": name in silent}
            self._silent ^= {name}

    def _own_goals(self, name: str) -> Iterator[dict[str, Any]]:
        """Yield the goals that the brain knows, and those that it will know when it steps."""
        for goal in self._simulation.assigned_goals(name) or self._waypoints[name]:
            yield {
                "at_m": goal["at"],
                "verdict": goal["verdict"],
                "served_by": name if goal["verdict"] == "complete" else None,
                "unserved": goal.get("reason"),
            }
        for sent in self._orders[name]:
            about = sent["message"]["about"]["order"]
            if about["action"] == "assign":
                yield {"at_m": about["at"], "verdict": "pending", "served_by": None}

    def _shared_goals(self, name: str) -> Iterator[dict[str, Any]]:
        for waypoints in self._shared:
            if name not in waypoints.robots:
                continue
            for goal in waypoints.verdicts(self._now_s):
                is_impossible = goal["verdict"] == "impossible"
                reason = self._reasons.get(tuple(goal["at_m"])) if is_impossible else None
                yield {**goal, "unserved": reason}

    def _note_reasons(self, name: str) -> None:
        """Note why a robot cannot reach a place: it proposes another one in its next step."""
        beliefs = self._simulation.belief_state(name)
        for goal in beliefs["goals"] if beliefs else ():
            if goal["reason"] is not None:
                self._reasons[tuple(goal["to"])] = goal["reason"]


def waypoints_of(scenario: Mapping[str, Any], robot: str) -> list[dict[str, Any]]:
    """Return the goals that the scenario gives to the brain of a robot, before it steps."""
    brain = scenario["robots"][robot.rpartition("/")[0]].get("brain", {})
    return [
        {"at": [float(x), float(y)], "verdict": "pending"}
        for behaviour in brain.get("behaviours", [])
        if behaviour["kind"] == "correct"
        for x, y in behaviour.get("waypoints_m", [])
    ]


def orders(waypoints_m: Any) -> list[Any]:
    """Return the messages with which an operator orders waypoints, in order.

    From its first order on, a brain has verdicts of its own waypoints too. Without waypoints to
    assign, the order withdraws a goal that does not exist.
    """
    assigned = [order(number, at, "assign") for number, at in enumerate(waypoints_m)]
    return assigned or [order(0, (0.0, 0.0), "withdraw")]


def order(number: int, at: Sequence[float], action: str) -> dict[str, Any]:
    """Return an order of the operator."""
    goal = {"issuer": OPERATOR, "number": number}
    about = {"order": {"goal": goal, "at": list(at), "action": action}}
    return {"from": OPERATOR, "age_s": 0.0, "message": {"about": about, "confidence": 1.0}}

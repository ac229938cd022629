"""What the endpoint does for each path: see docs/live.md, "Another program"."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from agent_economy.live.clock import now_s
from agent_economy.live.plan import FleetPlan, Point, RobotPlan
from agent_economy.live.rules import Mode, Setpoint
from agent_economy.live.rules.faults import EMERGENCY_STOP, MANUAL_LIFETIME_S
from agent_economy.live.rules.geometry import is_inside
from agent_economy.live.warden.authority import Authority
from agent_economy.live.warden.endpoint import Action, Answer
from agent_economy.live.warden.event_log import EventLog
from agent_economy.live.warden.geometry import world_of
from agent_economy.live.warden.state import robot_state
from agent_economy.live.warden.warden import Warden

Body = Mapping[str, Any]

MINUTES_PER_DEG = 60.0
MAX_WAYPOINTS = 1000
"""Waypoints of one robot, complete ones included."""


@dataclass(frozen=True)
class Drive:
    """What does not change in a drive.

    Attributes:
        plan: The fleet.
        fleet: The fleet file.
        recording: The recording.
    """

    plan: FleetPlan
    fleet: str
    recording: str


class Control:
    """Takes the requests of pages and other programs, and answers them at once."""

    def __init__(self, warden: Warden, drive: Drive, events: EventLog) -> None:
        """Create it for a drive."""
        self._warden, self._drive, self._events = warden, drive, events
        self._plans = {robot.name: robot for robot in drive.plan.robots}
        self._authority = Authority()
        self._numbers: dict[str, int] = {}

    def actions(self) -> dict[str, Action]:
        """Return what is done for each path."""
        free = {"/stop": self._stop, "/hold": self._hold, "/state": self._state}
        own = {"/operator": self._operator, "/manual": self._manual}
        guarded = {
            "/release": self._release,
            "/arm": self._arm,
            "/resume": self._resume,
            "/mode": self._mode,
            "/waypoint": self._waypoint,
            "/navigate": self._navigate,
            "/confirm": self._confirm,
        }
        others = {path: self._guarded(action) for path, action in guarded.items()}
        return {path: self._seen(action) for path, action in (free | own | others).items()}

    def _seen(self, action: Callable[[Body], Answer]) -> Action:
        def act(body: Body) -> Answer:
            self._authority.see(body.get("client"), now_s())
            return action(body)

        return act

    def _guarded(self, action: Callable[[Body], Answer]) -> Callable[[Body], Answer]:
        """Refuse a request while another client is the operator."""

        def act(body: Body) -> Answer:
            self._authority.check(body.get("client"), now_s())
            return action(body)

        return act

    def _note(self, text: str, level: str = "info", robot: str | None = None) -> Answer:
        self._events.add(level, robot, text)
        return {"message": text}

    # Requests that are never refused.

    def _stop(self, _: Body) -> Answer:
        self._warden.stop()
        return self._note("emergency stop of all robots", "error")

    def _hold(self, _: Body) -> Answer:
        self._warden.operator.hold = True
        return self._note("hold of all robots")

    def _state(self, body: Body) -> Answer:
        since = body.get("since", 0)
        if not isinstance(since, int):
            message = "since must be the number of an event"
            raise ValueError(message)  # noqa: TRY004  (of the request)
        now, warden = now_s(), self._warden
        decisions = warden.outputs.robots
        # What has been requested since the last turn is certain to be the case in the next one.
        is_stopped = any(EMERGENCY_STOP in each.latched for each in decisions.values())
        return {
            "time_s": self._events.time_s,
            "fleet": self._drive.fleet,
            "recording": self._drive.recording,
            "is_ending": warden.is_ending,
            "is_held": warden.operator.hold or warden.outputs.is_held,
            "is_stopped": warden.operator.stop or is_stopped,
            "operator": self._authority.role(body.get("client"), now),
            "robots": [
                robot_state(
                    warden.robots[name],
                    decision,
                    warden.goals.get(name, {}).values(),
                    self._drive.plan.origin,
                    now,
                )
                for name, decision in decisions.items()
            ],
            "events": list(self._events.since(since)),
        }

    # Requests of the operator.

    def _operator(self, body: Body) -> Answer:
        client, now = body.get("client"), now_s()
        if _flag(body, "take"):
            role = self._authority.role(client, now)
            self._authority.take(client, now, take_over=body.get("take_over") is True)
            if role == "you":
                return {"message": "this client is the operator"}
            self._forget_manual()
            return self._note("another client took over" if role else "a client is the operator")
        if self._authority.give_up(client, now):
            self._forget_manual()
            return self._note("the operator has given up control")
        return {"message": "this client is not the operator"}

    def _forget_manual(self) -> None:
        """Stop the robots in manual mode: what was requested by hand is no longer valid."""
        self._numbers = {}
        for robot in self._warden.robots.values():
            robot.manual = None

    def _manual(self, body: Body) -> Answer:
        name, now = self._robot(body).name, now_s()
        if self._authority.role(body.get("client"), now) != "you":
            message = "this client is not the operator"
            raise ValueError(message)
        decision = self._warden.outputs.robots.get(name)
        if decision is None or decision.mode is not Mode.MANUAL:
            message = f"{name} is not in manual mode"
            raise ValueError(message)
        number, robot = body.get("number"), self._warden.robots[name]
        if type(number) is not int:
            message = "number must be a whole number that increases with each request"
            raise ValueError(message)
        left, right = body.get("left"), body.get("right")
        if type(left) is not int or type(right) is not int:
            message = "left and right must be whole numbers"
            raise ValueError(message)
        motion = robot.driver.tracks(left, right, robot.plan.settings)
        # A request that was overtaken by a newer one must not undo it.
        if number > self._numbers.get(name, -1):
            self._numbers[name] = number
            robot.manual = Setpoint(motion, 0, now, MANUAL_LIFETIME_S)
        return self._state(body)

    def _release(self, _: Body) -> Answer:
        self._warden.operator.release = True
        return self._note("released: the robots stand until they are armed")

    def _arm(self, body: Body) -> Answer:
        names = list(self._plans)
        robots = body.get("robots", names)
        if not isinstance(robots, list) or not robots or not all(each in names for each in robots):
            message = f"robots must be a list of one or more of {', '.join(names)}"
            raise ValueError(message)
        return self._note(self._warden.arm(robots))

    def _resume(self, _: Body) -> Answer:
        self._warden.operator.resume = True
        return self._note("resumed: armed robots move again after one second")

    def _mode(self, body: Body) -> Answer:
        robot, mode = self._robot(body).name, body.get("mode")
        if mode not in list(Mode):
            message = f"mode must be one of {', '.join(Mode)}"
            raise ValueError(message)
        self._warden.operator.mode[robot] = Mode(mode)
        return self._note(f"{robot}: {mode} mode requested", robot=robot)

    def _navigate(self, body: Body) -> Answer:
        robot, is_on = self._robot(body).name, _flag(body, "is_on")
        self._warden.operator.navigate[robot] = is_on
        state = "on" if is_on else "off: it stands, and keeps its waypoints"
        return self._note(f"{robot}: navigation is {state}", robot=robot)

    def _confirm(self, body: Body) -> Answer:
        """Take the word of the operator that the value of a doubted input is right."""
        robot, port = self._robot(body), body.get("port")
        ports = [each.port for each in robot.inputs]
        if port not in ports:
            message = f"port must be one of {', '.join(ports)}"
            raise ValueError(message)
        decision = self._warden.outputs.robots.get(robot.name)
        doubted = [] if decision is None else decision.doubted
        if port not in doubted:
            message = f"{port} of {robot.name} is not doubted: there is nothing to confirm"
            raise ValueError(message)
        self._warden.operator.confirm.setdefault(robot.name, set()).add(port)
        text = f"{robot.name}: an operator confirms the value of {port}"
        return self._note(text, "warning", robot.name)

    def _waypoint(self, body: Body) -> Answer:
        robot = self._robot(body)
        if not robot.takes_orders:
            message = f"the brain of {robot.name} takes no orders: it has no behaviour correct"
            raise ValueError(message)
        point = _point(body, self._drive.plan)
        self._check_place(robot, point)
        if len(self._warden.goals.get(robot.name, {})) >= MAX_WAYPOINTS:
            message = f"{robot.name} has {MAX_WAYPOINTS} waypoints already"
            raise ValueError(message)
        self._warden.order(robot.name, point)
        place = f"[{point[0]:.2f}, {point[1]:.2f}]"
        return self._note(f"{robot.name}: waypoint {place} ordered", robot=robot.name)

    def _check_place(self, robot: RobotPlan, point: Point) -> None:
        size_m = self._drive.plan.size_m
        if size_m and not (0 <= point[0] <= size_m[0] and 0 <= point[1] <= size_m[1]):
            message = f"the waypoint is outside the world, [0, 0] to [{size_m[0]:g}, {size_m[1]:g}]"
            raise ValueError(message)
        if robot.fence_m is not None and not is_inside(point, robot.fence_m):
            message = f"the waypoint is outside the fence of {robot.name}"
            raise ValueError(message)

    def _robot(self, body: Body) -> RobotPlan:
        name = body.get("robot")
        robot = self._plans.get(name) if isinstance(name, str) else None
        if robot is None:
            message = f"robot must be one of {', '.join(self._plans)}"
            raise ValueError(message)
        return robot


def _flag(body: Body, key: str) -> bool:
    value = body.get(key)
    if not isinstance(value, bool):
        message = f"{key} must be true or false"
        raise ValueError(message)  # noqa: TRY004  (of the request)
    return value


def _point(body: Body, plan: FleetPlan) -> Point:
    """Return the place of a waypoint in the world."""
    if "point_m" in body:
        given = body["point_m"]
        if not isinstance(given, list) or len(given) != 2:  # noqa: PLR2004
            message = "point_m must be two numbers"
            raise ValueError(message)
        return _pair(*(partial(_number, each, f"point_m[{i}]") for i, each in enumerate(given)))
    latitude, longitude = (
        partial(_degrees, body, key, letters)
        for key, letters in (("latitude", "NS"), ("longitude", "EW"))
    )
    return world_of(plan.origin, *_pair(latitude, longitude))


def _pair(*reads: Callable[[], float]) -> Point:
    """Return two values, or the errors of both."""
    values, errors = [], []
    for read in reads:
        try:
            values.append(read())
        except ValueError as error:
            errors.append(str(error))
    if errors:
        raise ValueError("; ".join(errors))
    return values[0], values[1]


def _degrees(body: Body, key: str, letters: str) -> float:
    angle = body.get(key)
    if not isinstance(angle, dict) or angle.get("hemisphere") not in tuple(letters):
        message = f"{key} must have degrees, minutes, and the hemisphere {' or '.join(letters)}"
        raise ValueError(message)
    degrees, minutes = (
        _number(angle.get(part), f"{key}.{part}") for part in ("degrees", "minutes")
    )
    limit_deg = 90.0 if key == "latitude" else 180.0
    value = degrees + minutes / MINUTES_PER_DEG
    if degrees < 0 or not 0 <= minutes < MINUTES_PER_DEG or value > limit_deg:
        message = f"{key} must be 0 to {limit_deg:g} degrees, and 0 to 59.99 minutes"
        raise ValueError(message)
    return value if angle["hemisphere"] == letters[0] else -value


def _number(value: object, name: str) -> float:
    match value:
        case bool():
            pass
        # A whole number may be larger than any float; NaN compares as false.
        case int() | float() if abs(value) <= sys.float_info.max:
            return float(value)
    message = f"{name} must be a number"
    raise ValueError(message)

"""What the endpoint does for each path: see docs/live.md, "Another program"."""

from collections.abc import Callable
from dataclasses import dataclass

from agent_economy.live.clock import now_s
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import FleetPlan, RobotPlan
from agent_economy.live.rules import Mode, Setpoint
from agent_economy.live.rules.faults import MANUAL_LIFETIME_S
from agent_economy.live.warden import effects, waypoint_request
from agent_economy.live.warden.authority import Authority
from agent_economy.live.warden.endpoint import Action, Answer
from agent_economy.live.warden.event_log import EventLog
from agent_economy.live.warden.request_body import Body, check_body, flag
from agent_economy.live.warden.state import robot_state
from agent_economy.live.warden.warden import Warden
from agent_economy.live.warden.waypoint_request import WaypointOrders
from agent_economy.types.warden import Level, WardenState

KEYS = {
    "/state": ("since",),
    "/operator": ("take", "take_over"),
    "/manual": ("robot", "left", "right", "number", "since"),
    "/release": (),
    "/arm": ("robots",),
    "/resume": (),
    "/mode": ("robot", "mode"),
    "/waypoint": waypoint_request.KEYS,
    "/navigate": ("robot", "is_on"),
    "/confirm": ("robot", "port"),
}
"""The keys of each path, besides those of all. Those of stop and hold do not matter."""


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
        self._frame = frame_of(drive.plan.origin)
        self._plans = {robot.name: robot for robot in drive.plan.robots}
        self._waypoints = WaypointOrders(warden, drive.plan)
        self._authority = Authority()
        self._numbers: dict[str, int] = {}
        self._operators = 0

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
        return {path: self._seen(path, action) for path, action in (free | own | others).items()}

    def _seen(self, path: str, action: Callable[[Body], Answer]) -> Action:
        def act(body: Body) -> Answer:
            if path in KEYS:
                check_body(body, KEYS[path])
            self._authority.see(body.get("client"), now_s())
            return action(body)

        return act

    def _guarded(self, action: Callable[[Body], Answer]) -> Callable[[Body], Answer]:
        """Refuse a request while another client is the operator, or while the drive ends."""

        def act(body: Body) -> Answer:
            self._authority.check(body.get("client"), now_s())
            effects.check_drive(self._warden)
            return action(body)

        return act

    def _note(self, text: str, level: Level = "info", robot: str | None = None) -> Answer:
        self._events.add(level, robot, text)
        return {"message": text}

    # Requests that are never refused.

    def _stop(self, _: Body) -> Answer:
        text = effects.of_stop(self._warden)
        self._warden.stop()
        return self._note(text, "error")

    def _hold(self, _: Body) -> Answer:
        text = effects.of_hold(self._warden)
        self._warden.operator.hold = True
        self._warden.operator.arm.clear()
        return self._note(text)

    def _state(self, body: Body) -> WardenState:
        since = body.get("since", 0)
        if type(since) is not int:
            message = "since must be the number of an event"
            raise ValueError(message)
        now, warden = now_s(), self._warden
        decisions = warden.outputs.robots
        return {
            "time_s": self._events.time_s,
            "fleet": self._drive.fleet,
            "recording": self._drive.recording,
            "is_ending": warden.is_ending,
            # What has been requested since the last turn is certain to be the case in the next one.
            "is_held": effects.is_held(warden),
            "is_stopped": warden.operator.stop or effects.is_latched(warden),
            "operator": self._authority.role(body.get("client"), now),
            "robots": [
                robot_state(
                    warden.robots[name],
                    decision,
                    warden.goals.get(name, {}).values(),
                    self._frame,
                    now,
                )
                for name, decision in decisions.items()
            ],
            "events": list(self._events.since(since)),
        }

    # Requests of the operator.

    def _operator(self, body: Body) -> Answer:
        client, now = body.get("client"), now_s()
        take, take_over = flag(body, "take"), flag(body, "take_over", default=False)
        role = self._authority.role(client, now)
        if take == (role == "you"):
            message = f"this client is {'the operator already' if take else 'not the operator'}"
            raise ValueError(message)
        if take:
            self._authority.take(client, now, take_over=take_over)
        else:
            self._authority.give_up()
        self._forget_manual()
        if not take:
            return self._note("the operator has given up control")
        return self._note("another client took over" if role else "a client is the operator")

    def _forget_manual(self) -> None:
        """Stop the robots in manual mode: what was requested by hand is no longer valid."""
        self._numbers = {}
        self._operators += 1
        for robot in self._warden.robots.values():
            robot.manual = None

    def _manual(self, body: Body) -> WardenState:
        name, now = self._robot(body).name, now_s()
        if self._authority.role(body.get("client"), now) != "you":
            message = "this client is not the operator"
            raise ValueError(message)
        effects.check_drive(self._warden)
        decision = self._warden.outputs.robots.get(name)
        is_manual = decision is not None and decision.mode is Mode.MANUAL
        if not is_manual or effects.mode_of(self._warden, name) is not Mode.MANUAL:
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
        newest = self._numbers.get(name)
        if newest is not None and number <= newest:  # it must not undo the newer one
            message = f"number {number} is overtaken: a request with number {newest} came before"
            raise ValueError(message)
        self._numbers[name] = number
        robot.manual = Setpoint(motion, 0, now, MANUAL_LIFETIME_S, self._operators)
        return self._state(body)

    def _release(self, _: Body) -> Answer:
        effects.check_release(self._warden)
        self._warden.operator.release = True
        return self._note("released: the robots stand until they are armed")

    def _arm(self, body: Body) -> Answer:
        names = list(self._plans)
        robots = body.get("robots", names)
        if not isinstance(robots, list) or not robots or not all(each in names for each in robots):
            message = f"robots must be a list of one or more of {', '.join(names)}"
            raise ValueError(message)
        unarmed = effects.robots_to_arm(self._warden, robots)
        armed = ", ".join(name for name in robots if name not in unarmed)
        text = self._warden.arm(unarmed)
        return self._note(f"{text}; armed already: {armed}" if armed else text)

    def _resume(self, _: Body) -> Answer:
        effects.check_resume(self._warden)
        self._warden.operator.resume = True
        return self._note("resumed: armed robots move again after one second")

    def _mode(self, body: Body) -> Answer:
        robot, mode = self._robot(body).name, body.get("mode")
        if mode not in list(Mode):
            message = f"mode must be one of {', '.join(Mode)}"
            raise ValueError(message)
        effects.check_mode(self._warden, robot, Mode(mode))
        self._warden.operator.mode[robot] = Mode(mode)
        return self._note(f"{robot}: {mode} mode requested", robot=robot)

    def _navigate(self, body: Body) -> Answer:
        robot, is_on = self._robot(body).name, flag(body, "is_on")
        effects.check_navigate(self._warden, robot, is_on=is_on)
        self._warden.operator.navigate[robot] = is_on
        state = "on" if is_on else "off: it stands, and keeps its waypoints"
        is_manual = effects.mode_of(self._warden, robot) is Mode.MANUAL
        later = "; it takes effect in automatic mode" if is_manual else ""
        return self._note(f"{robot}: navigation is {state}{later}", robot=robot)

    def _confirm(self, body: Body) -> Answer:
        """Take the word of the operator that the value of a doubted input is right."""
        robot, port = self._robot(body), body.get("port")
        ports = [each.port for each in robot.inputs]
        if port not in ports:
            message = f"port must be one of {', '.join(ports)}"
            raise ValueError(message)
        effects.check_confirm(self._warden, robot.name, port)
        self._warden.operator.confirm.setdefault(robot.name, set()).add(port)
        text = f"{robot.name}: an operator confirms the value of {port}"
        return self._note(text, "warning", robot.name)

    def _waypoint(self, body: Body) -> Answer:
        robot = self._robot(body)
        return self._note(self._waypoints.take(robot, body), robot=robot.name)

    def _robot(self, body: Body) -> RobotPlan:
        name = body.get("robot")
        robot = self._plans.get(name) if isinstance(name, str) else None
        if robot is None:
            message = f"robot must be one of {', '.join(self._plans)}"
            raise ValueError(message)
        return robot

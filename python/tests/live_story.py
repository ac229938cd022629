"""A healthy robot in fake time, whose inputs a test breaks one at a time: see `Story`."""

import copy
import math
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from agent_economy.live.plan import FleetPlan, InputPlan, Origin, RobotPlan
from agent_economy.live.readings import STOP, Motion, Quantity
from agent_economy.live.rules import (
    Action,
    Decision,
    Fault,
    Inputs,
    Link,
    LoopInputs,
    Mode,
    Requests,
    RobotInputs,
    Sample,
    Setpoint,
    initial,
    update,
)

ROBOT = "rover/0"
DRIVE = Motion(0.5, 0.3)
STEP_S = 0.02
LEAP_S = 0.25
NOISE = {"compass": math.radians(0.5), "gps": 0.1, "sonar": 0.02, "battery": 0.0}
PERIODS_S = {"compass": 0.1, "gps": 1.0, "sonar": 0.2, "battery": 1.0}
SIZE_M = (400.0, 400.0)
START_M = (200.0, 200.0)
FENCE_M = ((100.0, 100.0), (300.0, 100.0), (300.0, 300.0), (100.0, 300.0))

PLAN = FleetPlan(
    Origin(0.0, 0.0),
    (
        RobotPlan(
            name=ROBOT,
            driver="bender",
            host="localhost",
            ports={"motors": 1, "compass": 2, "gps": 3, "sonar": 4, "battery": 5},
            settings={},
            inputs=(
                InputPlan("compass", Quantity.HEADING, 1.0, NOISE["compass"]),
                InputPlan("gps", Quantity.POSITION, 3.0, NOISE["gps"]),
                InputPlan("sonar", Quantity.RANGES, 0.5, NOISE["sonar"], (0.0, 10.0)),
                InputPlan("battery", Quantity.BATTERY, 5.0, NOISE["battery"], (0.0, 1.0)),
            ),
            max_speed_m_s=1.0,
            max_turn_rate_rad_s=1.0,
            manual_speed_m_s=0.2,
            fence_m=FENCE_M,
        ),
    ),
    period_s=0.1,
    size_m=SIZE_M,
)

Values = tuple[float | None, ...]


@dataclass
class Story:
    """A robot that obeys, on a plane with a wall around it, and the rules that watch it.

    Attributes:
        setpoint: The motion that loop and operator request; None once they send nothing.
        silent: Ports without lines.
        altered: What the lines of a port contain instead of the truth.
        links: Links that are not up.
        loop: What differs from a healthy loop.
        pushed: The motion of the robot, whatever is commanded; None while it obeys.
        operator: Counts the operators that hold the controls.
    """

    seed: int
    mode: Mode = Mode.AUTO
    plan: FleetPlan = PLAN
    time_s: float = 100.0
    setpoint: Motion | None = DRIVE
    silent: set[str] = field(default_factory=set)
    altered: dict[str, Callable[[Values], Values]] = field(default_factory=dict)
    links: dict[str, Callable[["Story"], Link]] = field(default_factory=dict)
    loop: dict[str, Any] = field(default_factory=dict)
    is_loop_silent: bool = False
    pushed: Motion | None = None
    gap_s: float = STEP_S
    operator: int = 0

    def __post_init__(self) -> None:
        self.random = random.Random(self.seed)  # noqa: S311  (no secret)
        self.memory = initial(self.plan)
        self.pose = (*START_M, 0.0)
        self.samples: dict[str, Sample] = {}
        self.due_s = {
            port: self.time_s + self.random.uniform(0.0, period)
            for port, period in PERIODS_S.items()
        }
        self.given: Setpoint | None = None
        self.received_s = self.time_s
        self.decision: Decision | None = None

    def fork(self, seed: int) -> "Story":
        """Return a copy that continues by itself."""
        other = copy.copy(self)
        other.silent, other.altered = set(self.silent), dict(self.altered)
        other.links, other.loop = dict(self.links), dict(self.loop)
        other.samples, other.due_s = dict(self.samples), dict(self.due_s)
        other.random = random.Random(seed)  # noqa: S311  (no secret)
        return other

    @property
    def now(self) -> Decision:
        """The newest decision."""
        assert self.decision is not None
        return self.decision

    def step(self, requests: Requests | None = None, elapsed_s: float = STEP_S) -> Decision:
        """Let time pass, then update once."""
        self.time_s += elapsed_s
        self._move(max(elapsed_s, 0.0))
        self._sense()
        self._command()
        robot = RobotInputs(
            {port: self._link(port) for port in self.plan.robots[0].ports},
            dict(self.samples),
            self.given if self.mode is Mode.AUTO else None,
            self.given if self.mode is Mode.MANUAL else None,
        )
        loop = replace(LoopInputs(is_alive=True, last_message_s=self.received_s), **self.loop)
        self.known, inputs = robot, Inputs({ROBOT: robot}, loop, self.gap_s)
        self.inputs = inputs
        self.memory, outputs = update(
            self.memory, self.plan, self.time_s, inputs, requests or Requests()
        )
        self.decision = outputs.robots[ROBOT]
        assert self.decision.action is Action.MOVE or self.decision.motion == STOP
        assert self.decision.is_armed == (not self.decision.latched)
        return self.decision

    def run(self, time_s: float, elapsed_s: float = STEP_S) -> "Story":
        """Let time pass without requests."""
        for _ in range(round(time_s / elapsed_s)):
            self.step(elapsed_s=elapsed_s)
        return self

    def started(self) -> "Story":
        """Let the robot become healthy, arm it with neutral controls, and let it drive."""
        self.step(Requests(mode={ROBOT: self.mode}))
        self.controls_neutral().run(3.0)
        self.arm()
        assert self.now.action is Action.MOVE, self.now
        self.setpoint = DRIVE
        return self.run(1.0)

    def controls_neutral(self) -> "Story":
        """Let an operator release the controls; the loop has none."""
        if self.mode is Mode.MANUAL:
            self.setpoint = STOP
        return self

    def leaps(self, until_s: float, requests: Requests | None = None) -> Iterator[Decision]:
        """Yield the decisions of large steps; the last one is at a time, or a small step before."""
        while self.time_s < until_s - STEP_S:
            yield self.step(requests, min(LEAP_S, until_s - self.time_s))

    def arm(self) -> Decision:
        """Request arming in one step."""
        return self.step(Requests(arm=frozenset({ROBOT})))

    def active(self) -> tuple[Fault, ...]:
        """Return all faults that are active."""
        return (*self.now.faults, *self.now.warnings)

    def time_of(self, fault: Fault, earliest_s: float, latest_s: float) -> float:
        """Return when a fault appears, in small steps around the time at which it has to.

        Before them come large steps, in which it must not appear.
        """
        for decision in self.leaps(earliest_s - STEP_S):
            assert not self.has(fault), (self.time_s, earliest_s, decision)
        while not self.has(fault):
            self.step()
            assert self.time_s <= latest_s + STEP_S, (fault.name, self.time_s, latest_s, self.now)
        return self.time_s

    def has(self, fault: Fault) -> bool:
        """Return whether a fault is active or latched."""
        return fault in self.active() or fault in self.now.latched

    def heal(self) -> None:
        """Let everything be healthy from now on; the controls of a stopped robot are released."""
        self.silent, self.altered, self.links, self.loop = set(), {}, {}, {}
        self.plan, self.setpoint, self.gap_s = PLAN, DRIVE, STEP_S
        self.is_loop_silent, self.pushed = False, None
        if self.now.action is not Action.MOVE:
            self.controls_neutral()

    def _link(self, port: str) -> Link:
        return self.links[port](self) if port in self.links else Link(is_up=True)

    def _move(self, elapsed_s: float) -> None:
        motion = self.decision.motion if self.decision else STOP
        motion = self.pushed or motion
        x, y, heading = self.pose
        rate = 0.0 if motion.heading_rad is not None else motion.turn_rate_rad_s
        heading += rate * elapsed_s
        x += motion.speed_m_s * math.cos(heading) * elapsed_s
        y += motion.speed_m_s * math.sin(heading) * elapsed_s
        self.pose = (x, y, heading)

    def _sense(self) -> None:
        for port, period_s in PERIODS_S.items():
            due_s = self.due_s[port]
            if due_s > self.time_s:
                continue
            self.due_s[port] += period_s * math.floor((self.time_s - due_s) / period_s + 1)
            if port not in self.silent:
                values = self._values(port)
                if port in self.altered:
                    values = self.altered[port](values)
                self.samples[port] = Sample(self.time_s, values)

    def _values(self, port: str) -> Values:
        x, y, heading = self.pose
        noise = self.random.gauss
        match port:
            case "compass":
                return (math.remainder(heading + noise(0.0, NOISE[port]), math.tau),)
            case "gps":
                return (x + noise(0.0, NOISE[port]), y + noise(0.0, NOISE[port]))
            case "sonar":
                # As if between walls: ranges change with every motion, each in its direction.
                ways = [x * math.cos(each) + y * math.sin(each) for each in range(5)]
                far = [4.0 + math.sin(0.9 * way + heading) for way in ways]
                return (*(each + noise(0.0, NOISE[port]) for each in far), math.inf)
        return (0.8,)

    def _command(self) -> None:
        if self.setpoint is not None:
            self.given = Setpoint(self.setpoint, 0, self.time_s, 0.3, self.operator)
        if not self.is_loop_silent:
            self.received_s = self.time_s

"""Every way in which the safety rules stop a robot, each as a case in fake time."""

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import pytest
from live_story import FENCE_M, LEAP_S, PLAN, STEP_S, Story

from agent_economy.live.plan import FleetPlan
from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules import (
    Action,
    Fault,
    InManual,
    Link,
    Mode,
    Requests,
    faults,
)

PHASES = 100
BOTH = pytest.mark.parametrize("mode", list(Mode))


@cache
def healthy(mode: Mode) -> tuple[Story, ...]:
    """Return a robot that drives, at random phases of its sensors and of the warden."""
    story, chance, phases = Story(1, mode).started(), random.Random(2), []  # noqa: S311  (no secret)
    for seed in range(PHASES):
        story.run(chance.randint(1, 6) * STEP_S)
        phases.append(story.fork(seed))
        phases[-1].step(elapsed_s=chance.uniform(0.001, STEP_S))
        assert phases[-1].now.action is Action.MOVE
    return tuple(phases)


def forks(mode: Mode, number: int = PHASES) -> list[Story]:
    return [story.fork(seed) for seed, story in enumerate(healthy(mode)[:number])]


@dataclass(frozen=True)
class Case:
    """A way to break a healthy robot, and when the rules have to react."""

    fault: Fault
    name: str
    breaks: Callable[[Story], None]
    earliest_s: Callable[[Story], float]
    latest_s: Callable[[Story], float]
    requests: Requests | None = None

    def react(self, story: Story) -> float:
        """Break a robot, wait for the reaction and return its time."""
        self.breaks(story)
        earliest_s, latest_s = self.earliest_s(story), self.latest_s(story)
        if self.requests is not None:
            story.step(self.requests)
        time_s = story.time_of(self.fault, earliest_s, latest_s)
        story.gap_s = STEP_S
        return time_s


def at(
    fault: Fault,
    name: str,
    breaks: Callable[[Story], None],
    expected_s: Callable[[Story], float] = lambda story: story.time_s,
    tolerance_s: float = 0.0,
) -> Case:
    return Case(fault, name, breaks, expected_s, lambda story: expected_s(story) + tolerance_s)


def line_of(port: str) -> Callable[[Story], float]:
    return lambda story: story.due_s[port]


def age_of(port: str, age_s: float) -> Callable[[Story], float]:
    return lambda story: story.samples[port].time_s + age_s


def silences(port: str) -> Callable[[Story], None]:
    return lambda story: story.silent.add(port)


def alters(port: str, alter: Callable[[Any], Any]) -> Callable[[Story], None]:
    return lambda story: story.altered.update({port: alter})


def freezes(port: str) -> Callable[[Story], None]:
    def freeze(story: Story) -> None:
        values = story.samples[port].values
        story.altered[port] = lambda _: values

    return freeze


def sets(**values: Any) -> Callable[[Story], None]:
    def change(story: Story) -> None:
        for name, value in values.items():
            setattr(story, name, value)

    return change


def breaks_loop(**values: Any) -> Callable[[Story], None]:
    return lambda story: story.loop.update(values)


def half_opens(story: Story) -> None:
    since_s = story.time_s
    story.links["gps"] = lambda later: Link(is_up=True, unacknowledged_s=later.time_s - since_s)


def with_fence(fence_m: tuple[tuple[float, float], ...]) -> FleetPlan:
    return replace(PLAN, robots=(replace(PLAN.robots[0], fence_m=fence_m),))


def nothing(_: Story) -> None:
    pass


FAR_FENCE = tuple((x + 1000.0, y) for x, y in FENCE_M)
SWITCHED = {Mode.AUTO: Mode.MANUAL, Mode.MANUAL: Mode.AUTO}
TURN_LIMIT_S = 2 * math.pi + 5.0

CASES = (
    Case(
        faults.EMERGENCY_STOP,
        "press",
        nothing,
        lambda story: story.time_s,
        lambda story: story.time_s,
        Requests(stop=True),
    ),
    at(
        faults.MOVES_WHILE_STOPPED,
        "turns on",
        sets(setpoint=STOP, pushed=Motion(0.0, 0.5)),
        lambda story: story.time_s + 1.0,
        0.7,
    ),
    at(
        faults.MOVES_WHILE_STOPPED,
        "drives on",
        sets(setpoint=STOP, pushed=Motion(0.5, 0.0)),
        lambda story: story.time_s + 1.0,
        3.0,
    ),
    at(
        faults.LOST_LINK,
        "down",
        lambda story: story.links.update(sonar=lambda _: Link(is_up=False, reason="reset")),
    ),
    at(faults.LOST_LINK, "half open", half_opens, lambda story: story.time_s + 0.3),
    at(faults.EVENT_LOOP_GAP, "reported", sets(gap_s=1.001)),
    at(faults.OUTSIDE_FENCE, "moved fence", sets(plan=with_fence(FAR_FENCE))),
    at(
        faults.OUTSIDE_WORLD,
        "another world",
        lambda story: setattr(story, "plan", replace(story.plan, size_m=(100.0, 100.0))),
    ),
    at(
        faults.IMPOSSIBLE_VALUE,
        "not a number",
        alters("compass", lambda _: (math.nan,)),
        line_of("compass"),
    ),
    at(
        faults.IMPOSSIBLE_VALUE,
        "infinite position",
        alters("gps", lambda true: (true[0], math.inf)),
        line_of("gps"),
    ),
    at(
        faults.IMPOSSIBLE_VALUE,
        "range out of bounds",
        alters("sonar", lambda true: (*true[:5], 10.5)),
        line_of("sonar"),
    ),
    at(
        faults.JUMP,
        "compass",
        alters("compass", lambda true: (math.remainder(true[0] + math.radians(120.0), math.tau),)),
        line_of("compass"),
    ),
    at(faults.JUMP, "gps", alters("gps", lambda true: (true[0] + 9.0, true[1])), line_of("gps")),
    at(faults.FROZEN, "compass", freezes("compass"), age_of("compass", 3.0), 0.1 + STEP_S),
    at(faults.FROZEN, "gps", freezes("gps"), age_of("gps", 3.0), 1.0 + STEP_S),
    at(faults.FROZEN, "sonar", freezes("sonar"), age_of("sonar", 3.0), 0.2 + STEP_S),
    at(
        faults.TURN_DOES_NOT_END,
        "robot stands",
        sets(setpoint=Motion(heading_rad=1.0)),
        lambda story: story.time_s + TURN_LIMIT_S,
        2 * LEAP_S,
    ),
    at(faults.LOOP_DEAD, "exit", breaks_loop(is_alive=False)),
    at(
        faults.LOOP_SILENT,
        "hangs",
        sets(is_loop_silent=True),
        lambda story: story.received_s + 0.3,
    ),
    at(faults.LOOP_LATE, "late", breaks_loop(lateness_s=0.501)),
    at(faults.RECORDING_ERROR, "full disk", breaks_loop(recording_error="disk full")),
    at(faults.LOW_BATTERY, "empty", alters("battery", lambda _: (0.05,)), line_of("battery")),
    at(faults.STALE_INPUT, "sonar", silences("sonar"), age_of("sonar", 0.5)),
    at(faults.STALE_INPUT, "compass", silences("compass"), age_of("compass", 1.0)),
    at(faults.STALE_INPUT, "gps", silences("gps"), age_of("gps", 3.0)),
    at(
        faults.STALE_INPUT,
        "one sonar of six",
        alters("sonar", lambda true: (*true[:5], None)),
        age_of("sonar", 0.5),
    ),
    at(
        faults.NO_SETPOINT,
        "expires",
        sets(setpoint=None),
        lambda story: story.given.received_s + 0.3 if story.given else math.nan,
    ),
    at(
        faults.LONG_STOP,
        "no setpoint",
        sets(setpoint=None),
        lambda story: story.given.received_s + 5.3 if story.given else math.nan,
        LEAP_S,
    ),
)
ALL_CASES = pytest.mark.parametrize(
    "case", CASES, ids=lambda each: f"{each.fault.name}: {each.name}"
)
STOPPED_ELSEWHERE = {
    faults.MISSING_INPUT,
    faults.MODE_CHANGED,
    faults.NOT_ARMED,
    faults.HELD,
    faults.CONTROLS_DEFLECTED,
}


def stops(fault: Fault, mode: Mode) -> bool:
    return mode is Mode.AUTO or fault.in_manual is InManual.STOP

"""The safety rules under any inputs and requests, in any order."""

import math
from dataclasses import replace
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from live_story import PLAN, ROBOT, START_M

from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules import (
    Action,
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

TIMES = st.floats(-0.05, 1.2) | st.sampled_from([0.0, 0.02, 0.1, -5.0, math.nan, math.inf])
NUMBERS = st.floats(-400.0, 400.0) | st.sampled_from(
    [0.0, 1.0, math.nan, math.inf, -math.inf, 1e308]
)
AGES = st.floats(-0.05, 1.5) | st.sampled_from([0.0, math.nan, math.inf, -math.inf, -1e9])
MOSTLY = st.sampled_from([True] * 9 + [False])


@st.composite
def moments(draw: st.DrawFn) -> dict[str, Any]:
    """Draw what breaks in one update: mostly nothing."""
    breaks: dict[str, Any] = {"elapsed_s": 0.1 if draw(MOSTLY) else draw(TIMES)}
    for name, values in {
        "age_s": AGES,
        "value": NUMBERS,
        "motion": NUMBERS,
        "lateness_s": NUMBERS,
        "gap_s": NUMBERS,
        "unacknowledged_s": NUMBERS,
    }.items():
        if not draw(MOSTLY):
            breaks[name] = draw(values)
    for name in ("down", "dead", "no_setpoint", "no_sample", "stop", "release", "full", "unknown"):
        breaks[name] = not draw(MOSTLY)
    breaks["arm"] = draw(st.booleans())
    breaks["neutral"] = draw(st.booleans())
    breaks["mode"] = None if draw(MOSTLY) else draw(st.sampled_from(Mode))
    breaks["port"] = draw(st.sampled_from(["compass", "gps", "sonar"]))
    return breaks


def inputs_of(moment: dict[str, Any], time_s: float) -> Inputs:
    motion = Motion(moment.get("motion", 0.5), 0.0)
    setpoint = None if moment["no_setpoint"] else Setpoint(motion, 0, time_s, 0.3)
    values = {"compass": (1.5,), "gps": START_M, "sonar": (4.0,) * 6, "battery": (0.9,)}
    samples = {port: Sample(time_s, each) for port, each in values.items()}
    port = moment["port"]
    age_s, value = moment.get("age_s", 0.0), moment.get("value")
    broken = samples[port].values if value is None else (value, *samples[port].values[1:])
    samples[port] = Sample(time_s - age_s, broken)
    if moment["no_sample"]:
        del samples[port]
    links = {each: Link(is_up=True) for each in PLAN.robots[0].ports}
    links[port] = Link(
        is_up=not moment["down"], unacknowledged_s=moment.get("unacknowledged_s", 0.0)
    )
    neutral = setpoint and replace(setpoint, motion=STOP)
    known = RobotInputs(links, samples, setpoint, neutral if moment["neutral"] else setpoint)
    loop = LoopInputs(
        is_alive=not moment["dead"],
        last_message_s=time_s,
        lateness_s=moment.get("lateness_s", 0.0),
        recording_error="full" if moment["full"] else "",
    )
    robots = {} if moment["unknown"] else {ROBOT: known, "unknown": known}
    return Inputs(robots, loop, moment.get("gap_s", 0.02))


def must_stand(moment: dict[str, Any], mode: Mode) -> bool:
    """Return whether a stop condition holds, as this test understands the rules."""
    always = (
        moment["unknown"]
        or moment["down"]
        or not moment.get("unacknowledged_s", 0.0) < 0.3
        or moment["no_setpoint"]
        or not math.isfinite(moment.get("motion", 0.0))
        or not moment.get("gap_s", 0.0) <= 1.0
        or not -1e-9 <= moment["elapsed_s"] <= 1.0
        or moment["stop"]
    )
    if mode is Mode.MANUAL:
        return bool(always)
    limit_s = {"compass": 1.0, "gps": 3.0, "sonar": 0.5}[moment["port"]]
    value = moment.get("value", 200.0 if moment["port"] == "gps" else 1.0)
    possible = {"compass": math.isfinite(value), "gps": 100.0 < value < 300.0}
    possible["sonar"] = 0.0 <= value <= 10.0 or value == math.inf
    return bool(
        always
        or moment["dead"]
        or moment["full"]
        or not moment.get("lateness_s", 0.0) <= 0.5
        or (not moment["no_sample"] and not possible[moment["port"]] and "age_s" not in moment)
        or (moment["no_sample"] and moment["elapsed_s"] > limit_s)
    )


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.lists(moments(), min_size=10, max_size=60))
def test_no_robot_moves_while_a_stop_condition_holds_whatever_comes(
    story: list[dict[str, Any]],
) -> None:
    memory, time_s, mode = initial(PLAN), 0.0, Mode.AUTO
    has_armed, is_released = False, True
    for moment in story:
        time_s += moment["elapsed_s"]
        requests = Requests(
            stop=moment["stop"],
            release=moment["release"],
            arm=frozenset({ROBOT, "unknown"} if moment["arm"] else ()),
            mode={ROBOT: moment["mode"]} if moment["mode"] else {"unknown": Mode.MANUAL},
        )
        has_switched = moment["mode"] not in (None, mode)
        mode = moment["mode"] or mode
        memory, outputs = update(memory, PLAN, time_s, inputs_of(moment, time_s), requests)
        decision = outputs.robots[ROBOT]
        if moment["stop"]:
            is_released = has_armed = False
        elif moment["release"]:
            is_released = True
        has_armed = (has_armed or moment["arm"]) and is_released and not has_switched
        if decision.action is Action.MOVE:
            assert has_armed
            assert not must_stand(moment, mode), (moment, decision)
            assert not decision.faults
            assert not decision.latched
        else:
            assert decision.motion == STOP
            assert decision.faults or decision.latched
        assert math.isfinite(decision.motion.speed_m_s)
        time_s = memory.time_s if memory.time_s is not None else 0.0

"""The loop's parts: percepts of lines, the pace of steps, and the pipe to the warden."""

import json
import math
import subprocess
import sys
import time
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy.live import fleet
from agent_economy.live.loop.pacer import Pacer
from agent_economy.live.loop.percepts import Percepts, frame_of
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import FleetPlan
from agent_economy.runs.simulation import Simulation

START_S = 1000.0
SONARS = 6


@pytest.fixture(scope="module")
def plan() -> FleetPlan:
    return fleet.load("bender").plan


def percepts(plan: FleetPlan) -> Percepts:
    base = {"id": {"kind": 0, "index": 0}, "team_size": 1}
    return Percepts(plan.robots[0], frame_of(plan.origin), base, seed=3, start_s=START_S)


def test_the_time_of_a_percept_is_that_since_the_start_and_ages_agree_with_it(
    plan: FleetPlan,
) -> None:
    robot = percepts(plan)
    robot.add_line("compass", b"100.0", START_S + 1.0)
    robot.add_line("gps", b"36,35.71602,N,121,52.50018,W", START_S + 1.5)
    robot.add_line("sonar", b"3.0,99.0,3.0,3.0,3.0,3.0", START_S + 1.75)
    percept: Any = robot.percept(20, START_S + 2.0, SONARS)
    assert percept["time_s"] == 2.0
    ages = {key: percept[key]["age_s"] for key in ("heading_rad", "position")}
    assert ages == {"heading_rad": 1.0, "position": 0.5}
    assert [scan["age_s"] for scan in percept["scans"]] == [0.25] * SONARS
    assert percept["scans"][0]["ranges_m"] == [pytest.approx(0.9144)]
    assert percept["scans"][1]["ranges_m"] == [None]  # nothing seen
    assert percept["position"]["value"] == pytest.approx([0.0, 0.0], abs=0.1)


def test_a_compass_bearing_becomes_a_heading_of_the_world(plan: FleetPlan) -> None:
    robot = percepts(plan)
    # 14.5 degrees of declination and 10 of mounting error: east is a line of 85.5 degrees.
    for line, heading_deg in ((b"85.5", 0.0), (b"355.5", 90.0), (b"265.5", 180.0)):
        robot.add_line("compass", line, START_S)
        percept: Any = robot.percept(0, START_S, SONARS)
        off_rad = percept["heading_rad"]["value"] - math.radians(heading_deg)
        assert math.cos(off_rad) == pytest.approx(1.0)


def test_what_has_never_been_measured_is_missing(plan: FleetPlan) -> None:
    percept: Any = percepts(plan).percept(0, START_S, SONARS)
    assert not {"position", "heading_rad", "battery"} & percept.keys()
    assert [scan["age_s"] for scan in percept["scans"]] == [None] * SONARS


def test_the_newest_line_of_a_port_counts(plan: FleetPlan) -> None:
    robot = percepts(plan)
    for turn in range(5):
        robot.add_line("sonar", f"{turn + 1},1,1,1,1,1".encode(), START_S + turn)
    percept: Any = robot.percept(0, START_S + 4.0, SONARS)
    assert percept["scans"][0] == {"age_s": 0.0, "ranges_m": [pytest.approx(5 * 0.3048)]}


def test_random_words_differ_by_robot_and_step_and_repeat(plan: FleetPlan) -> None:
    words = [tuple(percepts(plan).percept(n, START_S, SONARS)["random_words"]) for n in (1, 2, 1)]
    assert words[0] == words[2] != words[1]
    assert all(0 <= word < 2**32 for word in words[0])


@given(st.lists(st.tuples(st.sampled_from(["compass", "gps", "sonar", "motors"]), st.binary())))
def test_no_line_breaks_a_percept(lines: list[tuple[str, bytes]]) -> None:
    robot = percepts(PLAN)
    for port, line in lines:
        robot.add_line(port, line, START_S)
    percept: Any = robot.percept(0, START_S, SONARS)
    values = [percept[key]["value"] for key in ("heading_rad", "battery") if key in percept]
    values += percept.get("position", {"value": []})["value"]
    assert all(math.isfinite(value) for value in values)


PLAN = fleet.load("bender").plan


def test_a_verdict_that_could_not_be_sent_is_reported_again(plan: FleetPlan) -> None:
    simulation = Simulation("bender", external=["bender/0"])
    ordered = {"bender/0": [[30.0, 10.0]]}
    team = Team(plan, simulation, ordered, seed=0, start_s=START_S)
    event = {"type": "event", "robot": "bender/0", "is_armed": True, "action": "stop"}
    team.add(event)
    team.add({"type": "line", "robot": "bender/0", "port": "compass", "line": "95.5", "t": START_S})
    simulation.step(percepts=team.percepts(0, START_S))
    sent = []
    for goal in team.new_verdicts():
        if goal["goal"] == "2":
            break  # the pipe is full
        sent.append(goal["goal"])
    assert sent == ["1"]
    assert [goal["goal"] for goal in team.new_verdicts()] == ["2", "3"]
    assert not list(team.new_verdicts())


def test_a_waypoint_is_pending_from_the_order_on_also_before_the_brain_steps(
    plan: FleetPlan,
) -> None:
    simulation = Simulation("bender", external=["bender/0"])
    team = Team(plan, simulation, {"bender/0": [[30.0, 10.0]]}, seed=0, start_s=START_S)
    team.add({"type": "order", "robot": "bender/0", "at_m": [20.0, 5.0]})
    before = list(team.new_verdicts())
    assert [each["at_m"] for each in before] == [[25, 15], [34, 20], [30, 10], [20, 5]]
    assert {each["verdict"] for each in before} == {"pending"}
    team.add({"type": "event", "robot": "bender/0", "is_armed": True, "action": "stop"})
    team.add({"type": "line", "robot": "bender/0", "port": "compass", "line": "95.5", "t": START_S})
    simulation.step(percepts=team.percepts(0, START_S))
    known = [[*goal["at"]] for goal in simulation.assigned_goals("bender/0")]
    assert known == [each["at_m"] for each in before]
    assert not list(team.new_verdicts())


def test_late_steps_are_counted_and_never_made_up_for() -> None:
    pacer = Pacer(0.1, due_s=10.0)
    assert pacer.tick(10.0) == 0.0
    assert pacer.tick(10.12) == pytest.approx(0.02)  # late by less than a step: the pace holds
    assert pacer.due_s == pytest.approx(10.2)
    assert pacer.tick(10.75) == pytest.approx(0.55)
    assert pacer.due_s == pytest.approx(10.85)  # no burst: the next step is a whole step away
    assert pacer.late_ticks == 1
    assert pacer.behind_s == pytest.approx(0.55)


def pipe_program(body: str) -> subprocess.Popen[bytes]:
    """Run a program with a pipe that watches the warden."""
    head = "from agent_economy.live.loop.pipe import *\nimport time\npipe = Pipe()\npipe.watch()\n"
    return subprocess.Popen(
        [sys.executable, "-c", head + body], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )


FLOOD = """
sent = 0
while pipe.send({"type": "goal"}):
    sent += 1
sys.exit(0 if sent > 100 else 1)
"""


def test_a_message_that_does_not_fit_into_the_pipe_is_reported_as_not_sent() -> None:
    process = pipe_program(FLOOD)
    assert process.wait(20) == 0  # without a reader


LISTEN = """
pipe.send({"type": "ready"})
began = now_s()
try:
    for message in pipe.receive_until(now_s() + 5):
        last = now_s()
        if message.get("pause"):
            time.sleep(message["pause"])
except WardenLostError:
    pipe.send({"silent_s": now_s() - last})
else:
    pipe.send({"silent_s": None})
"""


def test_a_silent_warden_is_lost_after_its_time_and_a_late_reader_reads_first() -> None:
    process = pipe_program(LISTEN)
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdout.readline()
    # The reader is busy for longer than the warden may be silent, but the warden is not.
    process.stdin.write(b'{"pause": 0.6}\n')
    process.stdin.flush()
    for _ in range(12):
        time.sleep(0.1)
        process.stdin.write(b'{"type": "beat"}\n')
        process.stdin.flush()
    silent = process.stdout.readline()
    assert process.wait(10) == 0
    value = float(silent.split(b":")[1].strip(b" }\n"))
    assert 0.3 <= value < 2.0


def test_a_warden_may_take_its_time_until_its_first_message() -> None:
    process = pipe_program(LISTEN)
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdout.readline()
    time.sleep(1.0)  # it looks up names
    process.stdin.write(b'{"type": "beat"}\n')
    process.stdin.flush()
    silent_s = json.loads(process.stdout.readline())["silent_s"]
    assert 0.3 <= silent_s < 2.0
    assert process.wait(10) == 0


def test_a_warden_that_ends_is_lost_at_once() -> None:
    process = pipe_program(LISTEN.replace("began = now_s()", "last = now_s()"))
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdout.readline()
    began_s = time.monotonic()
    process.stdin.close()
    assert b"silent_s" in process.stdout.readline()
    assert time.monotonic() - began_s < 2.0
    assert process.wait(10) == 0

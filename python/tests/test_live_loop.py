"""The loop's parts: percepts of lines, the pace of steps, and the pipe to the warden."""

import contextlib
import json
import math
import random
import subprocess
import sys
import time
from dataclasses import dataclass, field
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_economy.live import fleet
from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.loop import Loop, explanation
from agent_economy.live.loop.pacer import Pacer
from agent_economy.live.loop.percepts import Percepts
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import FleetPlan
from agent_economy.live.readings import reading_of
from agent_economy.live.warden.sentences import sentence
from agent_economy.runs.simulation import Simulation

START_S = 1000.0
SONARS = range(6)


@pytest.fixture(scope="module")
def plan() -> FleetPlan:
    return fleet.load("bender").plan


def percepts(plan: FleetPlan) -> Percepts:
    base = {"id": {"kind": 0, "index": 0}, "team_size": 1}
    return Percepts(plan.robots[0].name, base, seed=3, start_s=START_S)


def reading(port: str, line: bytes, at_s: float = START_S) -> dict[str, Any] | None:
    """Return the message of the reading of a line; None if the line is malformed."""
    message = {"robot": "bender/0", "port": port, "t": at_s, "line": line.decode("latin-1")}
    return LineReadings(PLAN).of(message)


def add_line(robot: Percepts, port: str, line: bytes, at_s: float) -> None:
    """Let a robot send a line."""
    message = reading(port, line, at_s)
    if message is not None:
        robot.add_reading(reading_of(json.loads(json.dumps(message, allow_nan=False))), at_s)


def test_the_time_of_a_percept_is_that_since_the_start_and_ages_agree_with_it(
    plan: FleetPlan,
) -> None:
    robot = percepts(plan)
    add_line(robot, "compass", b"100.0", START_S + 1.0)
    add_line(robot, "gps", b"36,35.71602,N,121,52.50018,W", START_S + 1.5)
    add_line(robot, "sonar", b"3.0,99.0,3.0,3.0,3.0,3.0", START_S + 1.75)
    percept: Any = robot.percept(20, START_S + 2.0, SONARS)
    assert percept["time_s"] == 2.0
    ages = {key: percept[key]["age_s"] for key in ("heading_rad", "position")}
    assert ages == {"heading_rad": 1.0, "position": 0.5}
    assert [scan["age_s"] for scan in percept["scans"]] == [0.25] * len(SONARS)
    assert percept["scans"][0]["ranges_m"] == [pytest.approx(0.9144)]
    assert percept["scans"][1]["ranges_m"] == [None]  # nothing seen
    assert percept["position"]["value"] == pytest.approx([0.0, 0.0], abs=0.1)


def test_a_compass_bearing_becomes_a_heading_of_the_world(plan: FleetPlan) -> None:
    robot = percepts(plan)
    # 14.5 degrees of declination and 10 of mounting error: east is a line of 85.5 degrees.
    for line, heading_deg in ((b"85.5", 0.0), (b"355.5", 90.0), (b"265.5", 180.0)):
        add_line(robot, "compass", line, START_S)
        percept: Any = robot.percept(0, START_S, SONARS)
        off_rad = percept["heading_rad"]["value"] - math.radians(heading_deg)
        assert math.cos(off_rad) == pytest.approx(1.0)


def test_what_has_never_been_measured_is_missing(plan: FleetPlan) -> None:
    percept: Any = percepts(plan).percept(0, START_S, SONARS)
    assert not {"position", "heading_rad", "battery"} & percept.keys()
    assert [scan["age_s"] for scan in percept["scans"]] == [None] * len(SONARS)


def test_the_newest_line_of_a_port_counts(plan: FleetPlan) -> None:
    robot = percepts(plan)
    for turn in range(5):
        add_line(robot, "sonar", f"{turn + 1},1,1,1,1,1".encode(), START_S + turn)
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
        add_line(robot, port, line, START_S)
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
    team.add(reading("compass", b"95.5") or {})
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
    team.add(reading("compass", b"95.5") or {})
    simulation.step(percepts=team.percepts(0, START_S))
    known = [[*goal["at"]] for goal in simulation.assigned_goals("bender/0")]
    assert known == [each["at_m"] for each in before]
    assert not list(team.new_verdicts())


@dataclass
class Paced:
    """A loop with a clock of its own.

    Attributes:
        pacer: Its pacer.
        now_s: The time.
        times_s: When it took its ticks.
    """

    pacer: Pacer
    now_s: float
    times_s: list[float] = field(default_factory=list)

    def tick(self, late_s: float = 0.0) -> float:
        """Take the next tick, late by some time; return by how much it was late."""
        self.now_s = max(self.now_s, self.pacer.due_s) + late_s
        self.times_s.append(self.now_s)
        return self.pacer.tick(self.now_s)


def paced(period_s: float = 0.1, start_s: float = 10.0, *, first_s: float | None = None) -> Paced:
    first_s = start_s if first_s is None else first_s
    return Paced(Pacer(period_s, start_s, first_s), first_s)


def test_late_steps_are_counted_with_the_time_that_the_run_is_behind_the_clock() -> None:
    loop = paced()
    assert loop.tick() == 0.0
    assert loop.tick(0.02) == pytest.approx(0.02)  # late by less than a step: the pace holds
    assert loop.pacer.due_s == pytest.approx(10.21)  # and the next one comes 0.09 s later
    assert loop.tick() == pytest.approx(0)
    assert loop.tick(0.55) == pytest.approx(0.55)
    numbers = {"was_late": True, "late_steps": 1, "behind_s": 0.55, "max_behind_s": 0.55}
    assert loop.pacer.counts() == pytest.approx(numbers)
    assert loop.pacer.slew_s == pytest.approx(9 * 0.55)


LATENESS_S = st.one_of(st.just(0.0), st.floats(0, 0.05), st.floats(0, 5), st.floats(0, 4000))


@given(
    st.sampled_from([0.02, 0.1, 0.25, 1.0]), st.floats(0, 1e6), st.lists(LATENESS_S, max_size=60)
)
def test_two_steps_are_never_nearer_than_09_periods_and_none_is_early(
    period_s: float, start_s: float, lateness_s: list[float]
) -> None:
    loop = paced(period_s, start_s)
    for late_s in lateness_s:
        loop.tick(late_s)
    for number, (one, other) in enumerate(pairwise(loop.times_s), 1):
        assert other - one >= 0.9 * period_s - 1e-6
        assert other >= start_s + number * period_s - 1e-6
    assert loop.pacer.behind_s <= sum(lateness_s) + 1e-6


@settings(deadline=None)  # 50,000 ticks
@given(st.sampled_from([0.02, 0.1, 1.0]), st.floats(0.0, 100))
def test_after_a_lateness_the_run_agrees_with_the_clock_within_ten_times_that(
    period_s: float, late_s: float
) -> None:
    loop = paced(period_s)
    loop.tick()
    loop.tick(late_s)
    until_s = loop.now_s + 10 * late_s + 2 * period_s
    while loop.now_s < until_s:
        loop.tick()
    assert loop.pacer.behind_s == pytest.approx(0, abs=1e-6)
    if abs(late_s - period_s) > 1e-6:  # within rounding errors, it may be either
        assert loop.pacer.late_ticks == (late_s > period_s)


def test_a_run_does_not_drift_from_the_clock_in_100000_late_steps() -> None:
    source, loop = random.Random(1), paced()  # noqa: S311
    for _ in range(100_000):
        is_late = source.random() < 0.01
        loop.tick(source.uniform(0, 0.5) if is_late else source.uniform(0, 0.005))
    for _ in range(1000):
        loop.tick()
    ticks = len(loop.times_s) - 1
    assert loop.now_s == pytest.approx(10.0 + ticks * 0.1, abs=1e-6)
    assert loop.pacer.behind_s == pytest.approx(0, abs=1e-6)
    assert 500 < loop.pacer.late_ticks < 1200
    assert 0.3 < loop.pacer.max_behind_s < 10


def test_the_time_until_the_first_step_is_made_up_for_too_and_is_not_late() -> None:
    loop = paced(first_s=10.4)
    loop.tick()
    numbers = {"was_late": False, "late_steps": 0, "behind_s": 0.4, "max_behind_s": 0.4}
    assert loop.pacer.counts() == pytest.approx(numbers)
    for _ in range(50):
        loop.tick()
    assert loop.pacer.behind_s == pytest.approx(0)
    assert not loop.pacer.was_late


@given(
    st.sampled_from([0.02, 0.1, 1.0]), st.floats(0.5, 2.0), st.floats(0, 2.0), st.integers(1, 500)
)
def test_a_run_whose_steps_all_take_too_long_falls_behind_and_states_it(
    period_s: float, share: float, first_s: float, steps: int
) -> None:
    loop = paced(period_s, first_s=10.0 + first_s)
    loop.tick()
    for _ in range(steps):
        loop.now_s += share * period_s  # the step takes it
        loop.tick()
        assert loop.pacer.max_behind_s >= loop.pacer.behind_s
    lost_s = steps * (share - 1) * period_s
    assert loop.pacer.behind_s >= first_s + lost_s - 1e-6
    if lost_s > period_s + 1e-6:
        assert loop.pacer.was_late
    if share <= 1:
        assert not loop.pacer.was_late
        assert loop.pacer.max_behind_s == pytest.approx(first_s, abs=1e-6)


def test_a_run_that_falls_behind_is_reported_at_5_s_and_whenever_that_has_doubled() -> None:
    loop, reported_s = paced(), []
    loop.tick()
    for _ in range(2000):
        loop.now_s += 0.15
        loop.tick()
        reported_s += [loop.pacer.behind_s] if loop.pacer.must_report() else []
    assert loop.pacer.late_ticks == 0
    assert loop.pacer.max_behind_s == pytest.approx(100.0, abs=0.2)
    assert reported_s == pytest.approx([5, 10, 20, 40, 80], rel=0.02)
    while loop.pacer.behind_s > 1:
        loop.tick()
        assert not loop.pacer.must_report()
    loop.tick(30.0)  # a suspension, also of a run that has not caught up
    assert loop.pacer.must_report()
    assert not loop.pacer.must_report()
    assert explanation(loop.pacer).startswith("The run is 31.0 s behind the clock, because steps")
    assert "for about 279 s, if each step takes less than 0.09 s" in explanation(loop.pacer)


def test_the_loop_reports_a_run_that_falls_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    sent: list[dict[str, Any]] = []
    loop: Any = Loop.__new__(Loop)
    loop._log, loop._pacer = None, Pacer(0.1, 10.0, 10.0)
    loop._pipe = SimpleNamespace(send=sent.append)
    for number in range(200):
        monkeypatch.setattr("agent_economy.live.loop.loop.now_s", lambda: 10 + number * 0.18)  # noqa: B023
        loop._tick()
    messages = [each["message"] for each in sent if each["type"] == "message"]
    assert [each[:14] for each in messages] == ["The run is 5.0", "The run is 10."]
    assert (sent[-1]["late_steps"], sent[-1]["was_late"]) == (0, True)
    assert sent[-1]["max_behind_s"] == sent[-1]["behind_s"] == pytest.approx(199 * 0.08)


def test_the_end_of_a_drive_states_that_the_run_has_fallen_behind() -> None:
    event: dict[str, Any] = {
        "type": "end",
        "reason": "ended by Ctrl-C",
        "unconfirmed": ["bender/0"],
    }
    event |= {"late_steps": 0, "behind_s": 14.2, "max_behind_s": 15.9}
    assert "Late" not in sentence(event | {"was_late": False})
    assert sentence(event | {"was_late": True}).endswith(
        "Late steps of the brains: 0; the run was behind the clock by 15.90 s at most, and by "
        "14.20 s at the end."
    )


EARLY = """
from agent_economy.live.clock import now_s
received = pipe.receive_until(now_s() + 1.0)
started_s = now_s()
count = sum(1 for _ in received)
sys.exit(0 if now_s() - started_s >= 0.99 and count > 2000 else 1)
"""


def test_a_flood_of_messages_does_not_have_a_step_taken_early() -> None:
    process = pipe_program(EARLY)
    assert process.stdin is not None
    deadline_s = time.monotonic() + 5
    with contextlib.suppress(BrokenPipeError):
        while process.poll() is None and time.monotonic() < deadline_s:
            process.stdin.write(b"{}\n")
            process.stdin.flush()
    assert process.wait(10) == 0


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

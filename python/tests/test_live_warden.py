"""The warden's parts: motor lines, the mission, the endpoint, locks and pipes."""

import asyncio
import itertools
import json
import math
import subprocess
import sys
from http.client import HTTPConnection
from typing import Any

import pytest

from agent_economy.live import fleet
from agent_economy.live.channel import Decoder, encode
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin
from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules import Action, Decision
from agent_economy.live.rules.faults import EMERGENCY_STOP, NOT_ARMED, STALE_INPUT
from agent_economy.live.warden.control import Control, Drive
from agent_economy.live.warden.endings import End
from agent_economy.live.warden.endpoint import Endpoint
from agent_economy.live.warden.event_log import EventLog
from agent_economy.live.warden.mission import READY_S, Mission
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.live.warden.warden import Warden

BENDER = DRIVERS["bender"]
SETTINGS = {key: setting.default for key, setting in BENDER.settings.items()}
AHEAD = Motion(0.5, 0.0)


def motors(**changes: object) -> MotorLines:
    return MotorLines(BENDER, SETTINGS | changes, frame_of(Origin(36.6, -121.9)), repeat_s=0.2)


def data(lines: Any) -> bytes:
    return b"".join(line.data for line in lines)


def test_a_motion_is_written_when_it_changes_and_repeated_at_5_hz() -> None:
    lines = motors()
    written = []
    for turn in range(50):
        now_s = 0.02 * turn
        due = lines.due(AHEAD, now_s, is_empty=True)
        written += [now_s] if due else []
    pauses = [after - before for before, after in itertools.pairwise(written)]
    assert len(written) == 5
    assert all(0.2 <= pause <= 0.22 + 1e-9 for pause in pauses)
    assert data(lines.due(STOP, 0.99, is_empty=True)) == b"x,3,\n"


def test_behind_unacknowledged_lines_only_a_stop_is_written_and_once() -> None:
    lines = motors()
    assert lines.due(AHEAD, 0.0, is_empty=True)
    assert not lines.due(AHEAD, 0.3, is_empty=False)
    assert not lines.due(Motion(0.1, 0.0), 0.4, is_empty=False)
    assert data(lines.due(STOP, 0.5, is_empty=False)) == b"x,3,\n"
    assert not any(lines.due(STOP, 0.5 + 0.1 * turn, is_empty=False) for turn in range(30))
    assert not lines.due(AHEAD, 4.0, is_empty=False)


def test_a_turn_of_the_coprocessor_is_requested_once_and_cancelled_by_a_stop() -> None:
    lines = motors(turn="coprocessor")
    turn = Motion(0.0, 0.5, heading_rad=0.0)
    first = lines.due(turn, 0.0, is_empty=True)
    assert [line.port for line in first] == ["motors", "compass"]
    assert data(first) == b"x,3,\n90.00\n"
    later = [lines.due(turn, 0.1 * n, is_empty=True) for n in range(30)]
    assert not any(later)
    assert data(lines.due(STOP, 3.1, is_empty=True)) == b"x,3,\n"
    assert data(lines.due(turn, 3.2, is_empty=True)) == b"x,3,\n90.00\n"


def test_a_turn_of_the_coprocessor_that_follows_another_one_at_once_is_requested_too() -> None:
    lines = motors(turn="coprocessor")
    assert lines.due(Motion(0.0, 0.5, heading_rad=0.0), 0.0, is_empty=True)
    back = Motion(0.0, -0.5, heading_rad=math.pi)
    assert data(lines.due(back, 0.1, is_empty=True)) == b"x,3,\n270.00\n"
    assert not lines.due(back, 0.4, is_empty=True)


def test_a_robot_without_the_coprocessor_turns_by_its_tracks() -> None:
    due = motors().due(Motion(0.0, 0.5, heading_rad=0.0), 0.0, is_empty=True)
    assert [line.port for line in due] == ["motors", "motors"]


def test_after_a_new_connection_the_motion_is_written_again() -> None:
    lines = motors()
    assert lines.due(STOP, 0.0, is_empty=True)
    assert not lines.due(STOP, 0.1, is_empty=True)
    lines.forget()
    assert lines.due(STOP, 0.1, is_empty=True)


def decision(*latched: Any, faults: tuple[Any, ...] = ()) -> Decision:
    action = Action.LATCHED_STOP if latched else Action.MOVE
    return Decision(action, STOP, faults, latched, not latched, faults, ())


def test_a_mission_arms_each_robot_once_as_soon_as_it_can_be_armed() -> None:
    mission = Mission(("a", "b"), began_s=0.0)
    blocked = decision(NOT_ARMED, faults=(STALE_INPUT,))
    assert mission.to_arm({"a": decision(NOT_ARMED), "b": blocked}) == {"a"}
    assert mission.to_arm({"a": decision(), "b": decision(NOT_ARMED)}) == {"b"}
    assert mission.to_arm({"a": decision(NOT_ARMED), "b": decision()}) == set()


@pytest.mark.parametrize(
    ("goals", "end"),
    [
        ({}, None),
        ({"0": "approaching"}, None),
        ({"0": "complete", "1": "receding"}, None),
        ({"0": "complete", "1": "complete"}, End.DONE),
        ({"0": "complete", "1": "impossible"}, End.UNFINISHED),
    ],
)
def test_a_mission_is_over_when_every_goal_has_a_final_verdict(
    goals: dict[str, str], end: End | None
) -> None:
    mission = Mission(("a",), began_s=0.0)
    decisions = {"a": decision()}
    mission.to_arm(decisions)
    assert mission.end(decisions, {"a": goals}, 1.0) is end


def test_a_latched_stop_ends_the_mission_of_its_robot_and_the_others_drive_on() -> None:
    mission = Mission(("a", "b"), began_s=0.0)
    mission.to_arm({"a": decision(), "b": decision()})
    decisions = {"a": decision(NOT_ARMED), "b": decision()}
    assert mission.end(decisions, {"b": {"0": "approaching"}}, 1.0) is None
    assert mission.end(decisions, {"b": {"0": "complete"}}, 1.0) is End.STOPPED


def test_a_robot_that_cannot_be_armed_is_left_out_after_a_while() -> None:
    mission = Mission(("a",), began_s=5.0)
    decisions = {"a": decision(NOT_ARMED, faults=(STALE_INPUT,))}
    mission.to_arm(decisions)
    assert mission.end(decisions, {}, 5.0 + READY_S) is None
    assert mission.end(decisions, {}, 5.1 + READY_S) is End.NOT_READY


def test_an_emergency_stop_before_arming_ends_the_mission() -> None:
    mission = Mission(("a",), began_s=0.0)
    decisions = {"a": decision(EMERGENCY_STOP, faults=(EMERGENCY_STOP,))}
    mission.to_arm(decisions)
    assert mission.end(decisions, {}, 0.1) is End.STOPPED


def request(address: tuple[str, int], method: str, path: str, body: bytes) -> tuple[int, str]:
    connection = HTTPConnection(*address, timeout=5)
    connection.request(method, path, body)
    response = connection.getresponse()
    text = json.loads(response.read())["message"]
    connection.close()
    return response.status, text


def test_the_endpoint_takes_requests_with_its_token_only() -> None:
    taken: list[Any] = []

    def act(body: dict[str, Any]) -> dict[str, str]:
        if body.get("robots") == ["x"]:
            message = "x cannot be armed: stale"
            raise ValueError(message)
        taken.append(body)
        return {"message": "done"}

    async def serve() -> list[tuple[int, str]]:
        endpoint = Endpoint({"/stop": act})
        await endpoint.start()
        good = json.dumps({"token": endpoint.token}).encode()
        refused = json.dumps({"token": endpoint.token, "robots": ["x"]}).encode()
        requests = [
            ("POST", "/stop", good),
            ("POST", "/stop", b'{"token": "guess"}'),
            ("POST", "/stop", b"{}"),
            ("POST", "/stop", b""),
            ("POST", "/stop", b"[1]"),
            ("POST", "/stop", b"not json"),
            ("POST", "/stop", b"[" * 60_000),
            ("GET", "/stop", good),
            ("POST", "/else", good),
            ("POST", "/stop", refused),
        ]
        answers = [await asyncio.to_thread(request, endpoint.address, *each) for each in requests]
        endpoint.close()
        return answers

    answers = asyncio.run(serve())
    assert [status for status, _ in answers] == [200, 403, 403, 400, 400, 400, 400, 405, 404, 409]
    assert answers[-1][1] == "x cannot be armed: stale"
    assert len(taken) == 1


@pytest.mark.parametrize("robots", [["other/0"], [["bender/0"]], "bender/0", [{}], [], None])
def test_what_is_no_list_of_robots_is_refused(robots: Any) -> None:
    warden = Warden(lambda _: None, is_headless=False)
    drive = Drive(fleet.load("bender").plan, "bender", "bender.mcap")
    arm = Control(warden, drive, EventLog()).actions()["/arm"]
    with pytest.raises(ValueError, match="robots must be a list of one or more of bender/0"):
        arm({"robots": robots})


def test_messages_survive_any_split_and_keep_every_digit() -> None:
    messages: list[dict[str, Any]] = [
        {"t": 0.1 + 0.2, "line": "\x00\xff\n"},
        {"t": 1e-300},
        {"t": 12345.678901234567},
    ]
    stream = b"".join(encode(message) for message in messages)
    decoder = Decoder()
    received = [each for byte in stream for each in decoder.feed(bytes([byte]))]
    assert received == messages


def test_the_warden_loads_no_numpy_and_only_the_core_of_the_engine() -> None:
    program = (
        "import sys, agent_economy.cli.drive\n"
        "ours = {f'agent_economy.{name}' for name in ('runs', 'recording', 'scenario', 'study')}\n"
        "bad = (ours | {'numpy', 'pyarrow'}) & set(sys.modules)\n"
        "sys.exit(str(bad) if bad else 0)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr


def test_before_its_first_turn_the_warden_arms_no_robot() -> None:
    warden = Warden(lambda _: None, is_headless=False)
    with pytest.raises(ValueError, match="x cannot be armed: nothing is known of it yet"):
        warden.arm(["x"])

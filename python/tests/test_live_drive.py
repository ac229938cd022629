"""A whole drive: an emulated Bender reaches waypoints around a wall, and the recording agrees."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from live_bench import INEXACT, Drive, changed_scenario, driving, emulated, fleet_text
from mcap.records import Channel, McapRecord, Message
from test_recording_damaged import records_of, written

import agent_economy as ae

WAYPOINTS_M = [[13.0, 15.0], [13.0, 19.0]]
FAST: dict[str, Any] = {"forward_m_s_per_unit": 0.03, "reverse_m_s_per_unit": 0.03}
COURSE = {
    "obstacles": "obstacles = [{ polygon_m = [[8, 14.2], [8.4, 14.2], [8.4, 16.2], [8, 16.2]] }]",
    "max_speed_m_s": "max_speed_m_s = 1.2",
    "max_acceleration_m_s2": "max_acceleration_m_s2 = 4",
    "max_turn_rate_deg_s": "max_turn_rate_deg_s = 120",
    "noise_m = 0.2": "noise_m = 0.1",
    "rate_hz = 1 ": "rate_hz = 5",
    '{ kind = "correct"': '{ kind = "correct", within_m = 1, wait_s = 2, stop_when_done = true },',
    '{ kind = "avoid"': '{ kind = "avoid", near_m = 1, clearance_hysteresis_m = 0.4, hold_s = 2 },',
}
"""Changes of the bundled scenario: a faster robot, and a wall nearer to it."""


@dataclass(frozen=True)
class Driven:
    """A drive that has ended well, and the pose of the robot."""

    drive: Drive
    pose: dict[str, float]


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """Drive a robot to two waypoints behind a wall."""
    return drive_course(tmp_path_factory.mktemp("drive"))


@repeated_if_late
def drive_course(folder: Path) -> Driven:
    scenario = changed_scenario(folder / "course.toml", COURSE)
    fleet = folder / "fleet.toml"
    arguments = ("--scenario", str(scenario))
    with emulated(folder, arguments=arguments, gps_hz=5, sonar_hz=10, **FAST, **INEXACT) as bench:
        keys = {"bender/0": f"waypoints_m = {WAYPOINTS_M}"}
        text = fleet_text(bench, scenario=str(scenario), keys=keys, **FAST)
        fleet.write_text(text, encoding="utf-8")
        with driving(fleet) as drive:
            assert drive.wait(90) == 0
            pose = bench.request(get="state")["state"]["robots"][0]["pose"]
    return Driven(drive, pose)


def test_a_robot_reaches_two_waypoints_around_a_wall_and_stops(driven: Driven) -> None:
    goals = [each for each in driven.drive.events if each["type"] == "goal"]
    assert [each["goal"] for each in goals if each["verdict"] == "complete"] == ["1", "2"]
    assert math.dist((driven.pose["x_m"], driven.pose["y_m"]), WAYPOINTS_M[-1]) < 2.0
    assert driven.pose["speed_m_s"] == 0.0


def test_a_replay_makes_the_recorded_readings_percepts_and_setpoints(driven: Driven) -> None:
    replayed = ae.replay(driven.drive.record)
    assert replayed.mismatch_tick is None
    assert replayed.lines is not None
    assert replayed.readings is not None
    assert replayed.lines >= replayed.readings > 100


def later_line(message: dict[str, Any]) -> dict[str, Any]:
    # One line alone would not do: of two between two steps, only the second is read.
    return message | {"line": message["line"].replace(".", ".1")}


def farther_reading(message: dict[str, Any]) -> dict[str, Any]:
    return message | {"values": [value + 1e-9 for value in message["values"]]}


def faster_setpoint(message: dict[str, Any]) -> dict[str, Any]:
    return message | {"motions": {"bender/0": [9.0, 0.0, None]}}


def older_percept(message: dict[str, Any]) -> dict[str, Any]:
    for percept in message["percepts"].values():
        percept["time_s"] += 0.01
    return message


def test_a_replay_finds_setpoints_that_are_missing_before_the_end(
    driven: Driven, tmp_path: Path
) -> None:
    records = records_of(driven.drive.record)
    channel = next(
        each.id for each in records if isinstance(each, Channel) and each.topic == "/live/setpoints"
    )
    ours = [each for each in records if isinstance(each, Message) and each.channel_id == channel]
    without = [each for each in records if each is not ours[len(ours) // 2]]
    missing = ae.replay(written(tmp_path / "missing.mcap", without))
    assert missing.mismatch_tick == json.loads(ours[len(ours) // 2].data)["tick"]


@pytest.mark.parametrize(
    ("topic", "change", "mismatch"),
    [
        ("/wire/bender/0/gps", later_line, "readings"),
        ("/reading/bender/0/gps", farther_reading, "readings"),
        ("/live/setpoints", faster_setpoint, "setpoints"),
        ("/input", older_percept, "percepts"),
    ],
)
def test_a_replay_finds_what_was_changed_in_a_recording(
    driven: Driven,
    topic: str,
    change: Callable[[dict[str, Any]], dict[str, Any]],
    mismatch: str,
    tmp_path: Path,
) -> None:
    records = records_of(driven.drive.record)
    channel = next(each.id for each in records if isinstance(each, Channel) and each.topic == topic)
    changed: list[McapRecord] = []
    for each in records:
        if isinstance(each, Message) and each.channel_id == channel:
            data = json.dumps(change(json.loads(each.data))).encode()
            changed.append(replace(each, data=data))
        else:
            changed.append(each)
    assert ae.replay(written(tmp_path / "changed.mcap", changed)).mismatch == mismatch

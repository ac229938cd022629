"""Readings of real robots: in the frame of the world, made once, sent and recorded beside lines."""

import json
import math
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from mcap.records import Channel, McapRecord, Message, Schema
from recorded_drive import made
from test_recording_damaged import Records, records_of, written

from agent_economy.build import own_build
from agent_economy.cli.replay import as_sentence
from agent_economy.live import fleet
from agent_economy.live.channel import Message as Sent
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.frame import (
    bearing_deg,
    frame_of,
    heading_rad,
    place_deg,
    position_m,
)
from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import Origin, plan_of
from agent_economy.live.readings import Motion, Quantity, Reading, reading_of
from agent_economy.live.replay import read_drive, replay
from agent_economy.live.verification import INPUT
from agent_economy.live.warden.connection import Share
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.live.warden.robot import DriveContext, Robot
from agent_economy.recording.file import strict
from agent_economy.recording.live_topics import READINGS, TICKS
from agent_economy.runs.simulation import Simulation

PLAN = fleet.load("bender").plan
FRAME = frame_of(Origin(36.6, -121.9, rotation_deg=20.0, declination_deg=14.5))
ANY = st.floats() | st.floats(-400, 400)

OLD = Path(__file__).parent / "data" / "drive_before_readings.mcap"
"""A drive of 6 s that was recorded before recordings had readings, without its scenes."""


@given(ANY, ANY)
@example(90.0, 360.0)
@example(-90.0, -180.1)
def test_any_place_has_a_position_or_none_and_nothing_is_raised(
    latitude_deg: float, longitude_deg: float
) -> None:
    x_m, y_m = position_m(FRAME, latitude_deg, longitude_deg)
    is_place = abs(latitude_deg) <= 90 and abs(longitude_deg) <= 360
    assert math.isfinite(x_m) == math.isfinite(y_m) == is_place
    place = place_deg(FRAME, x_m, y_m)
    assert place is None or math.hypot(x_m, y_m) < 3e5


@given(ANY)
def test_any_bearing_has_a_heading_or_none_and_nothing_is_raised(magnetic_deg: float) -> None:
    heading = heading_rad(FRAME, magnetic_deg)
    assert math.isfinite(heading) == (abs(magnetic_deg) <= 360)
    if math.isfinite(heading):
        turned_deg = bearing_deg(FRAME, heading) - magnetic_deg
        assert math.cos(math.radians(turned_deg)) == pytest.approx(1.0)


@pytest.mark.parametrize("far", [2e6, 1e300, math.inf, -math.inf, math.nan])
def test_a_position_far_away_has_no_place_and_is_no_error(far: float) -> None:
    assert place_deg(FRAME, far, 0.0) is None
    assert place_deg(FRAME, 0.0, far) is None


@given(st.floats())
def test_a_turn_to_any_heading_is_written_or_a_stop(heading: float) -> None:
    driver = DRIVERS["bender"]
    settings = {key: each.default for key, each in driver.settings.items()}
    motors = MotorLines(driver, settings | {"turn": "coprocessor"}, FRAME, 0.2)
    lines = motors.due(Motion(0.0, 0.0, heading_rad=heading), 0.0, is_empty=True)
    assert lines[0].data == b"x,3,\n"
    assert len(lines) == (2 if math.isfinite(heading) else 1)


VALUES = st.lists(st.none() | st.floats(), max_size=6).map(tuple)


@given(st.sampled_from(Quantity), VALUES)
def test_a_reading_survives_its_message_which_is_strict_json(
    quantity: Quantity, values: tuple[float | None, ...]
) -> None:
    reading = Reading(quantity, values)
    text = json.dumps(reading.message("bender/0", "sonar", 1.0), allow_nan=False)
    assert repr(reading_of(json.loads(text))) == repr(reading)


def sent_by(lines: list[tuple[str, bytes]], share: Share) -> list[tuple[Sent, ...]]:
    """Return what the warden sends to the loop for lines that arrive at once, in one turn."""
    sent: list[tuple[Sent, ...]] = []
    context = DriveContext(FRAME, lambda: 1.0, lambda *each: sent.append(each), share)
    robot = Robot(PLAN.robots[0], context)
    for port, line in lines:
        robot._received(port, line)
    robot.inputs(1.0)
    return sent


def test_a_line_is_sent_to_the_loop_together_with_its_reading() -> None:
    valid, malformed = sent_by([("compass", b"100.0"), ("compass", b"x")], Share())
    assert [each["type"] for each in valid] == ["line", "reading"]
    assert [each["type"] for each in malformed] == ["line"]
    line, reading = valid
    assert {key: line[key] for key in ("robot", "port", "t")} == {
        key: reading[key] for key in ("robot", "port", "t")
    }


def test_of_a_flood_no_more_readings_than_lines_are_sent_to_the_loop() -> None:
    share = Share.of(40)
    sent = sent_by([("compass", b"%d" % (number % 300)) for number in range(10_000)], share)
    assert len(sent) == share.lines
    assert sum(len(each) for each in sent) == 2 * share.lines


# Recordings


def changed(records: Records, topic: str, change: Any) -> list[McapRecord]:
    """Return records without the messages of a topic for which `change` returns None."""
    channels = {r.id for r in records if isinstance(r, Channel) and r.topic == topic}
    found: list[McapRecord] = []
    for each in records:
        if isinstance(each, Message) and each.channel_id in channels:
            message = change(json.loads(each.data))
            if message is None:
                continue
            each.data = json.dumps(message).encode()
        found.append(each)
    return found


def test_recorded_readings_are_those_of_their_schema(tmp_path: Path) -> None:
    records = records_of(made(tmp_path / "drive.mcap"))
    schemas = {each.id: each for each in records if isinstance(each, Schema)}
    channels = {each.id: each for each in records if isinstance(each, Channel)}
    topics = set()
    for message in (each for each in records if isinstance(each, Message)):
        channel = channels[message.channel_id]
        if channel.topic.startswith(READINGS):
            schema = json.loads(schemas[channel.schema_id].data)
            jsonschema.validate(json.loads(message.data), schema)
            topics.add(channel.topic)
    assert topics == {f"/reading/bender/0/{port}" for port in ("compass", "gps", "sonar")}
    impossible = Reading(Quantity.RANGES, (math.inf, math.nan, None, 1.0))
    jsonschema.validate(impossible.message("a/0", "sonar", 1.0), schema)
    wrong = impossible.message("a/0", "sonar", 1.0) | {"values": ["far"]}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, schema)


def is_at_tick_30(message: dict[str, Any]) -> bool:
    return 103.0 < float(message["t"]) < 103.15


def test_a_replay_finds_a_reading_that_its_line_does_not_give(tmp_path: Path) -> None:
    def change(message: dict[str, Any]) -> dict[str, Any]:
        values = [message["values"][0] + 1e-12]
        return message | {"values": values} if is_at_tick_30(message) else message

    records = records_of(made(tmp_path / "drive.mcap"))
    file = written(tmp_path / "other.mcap", changed(records, "/reading/bender/0/compass", change))
    found = replay(file)
    assert (found.mismatch_tick, found.mismatch) == (30, "readings")


def test_a_replay_finds_a_reading_that_is_missing_behind_its_line(tmp_path: Path) -> None:
    def change(message: dict[str, Any]) -> dict[str, Any] | None:
        return None if is_at_tick_30(message) else message

    records = records_of(made(tmp_path / "drive.mcap"))
    file = written(tmp_path / "other.mcap", changed(records, "/reading/bender/0/compass", change))
    # Its percept does not follow from the readings before; the next line shows the gap itself.
    assert replay(file).mismatch == "percepts"
    lines = LineReadings(PLAN)
    line = {"type": "line", "robot": "bender/0", "port": "compass", "t": 1.0, "line": "1.0"}
    assert lines.agree(line)
    assert not lines.agree(line)


def test_the_percepts_of_a_replay_are_made_of_the_recorded_readings(tmp_path: Path) -> None:
    file = made(tmp_path / "drive.mcap")
    whole = replay(file)
    assert whole.agrees
    assert whole.readings == whole.lines


@pytest.fixture
def without_readings(tmp_path: Path) -> Records:
    """Return the records of a drive as earlier versions wrote them."""
    records = records_of(made(tmp_path / "drive.mcap"))
    for port in ("compass", "gps", "sonar"):
        records = changed(records, f"/reading/bender/0/{port}", lambda _: None)
    return records


def test_a_recording_without_readings_is_reproduced_from_its_lines(
    without_readings: Records, tmp_path: Path
) -> None:
    found = replay(written(tmp_path / "old.mcap", without_readings))
    assert found.agrees
    assert found.readings == 0


def test_a_recording_without_readings_that_differs_is_reported_with_the_version_that_wrote_it(
    without_readings: Records, tmp_path: Path
) -> None:
    def later(message: dict[str, Any]) -> dict[str, Any]:
        return message | {"line": "200.0"} if is_at_tick_30(message) else message

    records = changed(without_readings, "/wire/bender/0/compass", later)
    found = replay(written(tmp_path / "old.mcap", records))
    assert found.mismatch is not None
    assert "percepts" in found.mismatch
    text = as_sentence(found, is_unfinished=False)
    assert "it has no readings of robots: they were made of its lines" in text
    assert f"recorded by {own_build()}" in text


def test_a_recording_of_an_earlier_version_still_gives_its_percepts() -> None:
    drive = read_drive(OLD)
    assert drive is not None
    assert drive.values is not None
    assert (drive.lines, drive.readings) == (97, 0)
    plan = plan_of(json.loads(drive.values["plan"]))
    replayed = replay(OLD, verify=False)
    simulation = Simulation(replayed.scenario, external=[robot.name for robot in plan.robots])
    start_s = float(drive.values["start_s"])
    team, lines = Team(plan, simulation, {}, seed=0, start_s=start_s), LineReadings(plan)
    recorded = {each["tick"]: each["percepts"] for topic, each in drive.messages if topic == INPUT}
    assert len(recorded) > 10
    for topic, message in drive.messages:
        if topic == TICKS:
            percepts = strict(team.percepts(message["tick"], message["t"]))
            assert percepts == recorded.get(message["tick"], {})
        elif message.get("type") == "line":
            team.add(lines.of(message) or message)
        elif message.get("type") == "event":
            team.add(message)
    # Its setpoints are those of the brain of its time.
    assert replayed.agrees or replayed.engine != own_build().engine

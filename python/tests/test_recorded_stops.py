"""When robots of a recorded drive were stopped: events on the timeline of the page."""

import json
from pathlib import Path
from typing import Any

from recorded_drive import ROBOT, STEP_S, made, messages

from agent_economy.live import fleet
from agent_economy.live.line_readings import LineReadings
from agent_economy.recording.live_topics import EVENTS, TICKS
from agent_economy.recording.stops import Stop, Stops
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.runs.timeline import Timeline
from agent_economy.server.workspace import Workspace

FOREVER_S = 60.0


def event(action: str, *faults: str, latched: tuple[str, ...] = ()) -> bytes:
    """A message of the warden about a robot."""
    (sent, *_) = messages(0, 100.0, LineReadings(fleet.load("bender").plan))
    return json.dumps({**sent, "action": action, "faults": faults, "latched": latched}).encode()


def tick(number: int) -> bytes:
    """A message of the loop that a step begins."""
    return json.dumps({"tick": number, "t": 0.0, "lateness_s": 0.0}).encode()


def test_a_robot_that_stops_and_moves_again_is_reported_with_the_reasons() -> None:
    stops = Stops()
    for topic, data in (
        (EVENTS, event("move")),
        (TICKS, tick(6)),
        (EVENTS, event("stop", "gps: too old")),
        (EVENTS, event("stop", "gps: too old")),
        (TICKS, tick(7)),
        (EVENTS, event("latched_stop", latched=("emergency stop",))),
        (TICKS, tick(20)),
        (EVENTS, event("move")),
    ):
        stops.add(topic, data)
    assert stops.all == [
        Stop(7, ROBOT, "stop", ("gps: too old",)),
        Stop(8, ROBOT, "latched_stop", ("emergency stop",)),
        Stop(21, ROBOT, "move", ()),
    ]


def test_a_robot_that_has_not_moved_was_not_stopped_and_damaged_messages_change_nothing() -> None:
    stops = Stops()
    for data in (event("stop"), b"{", b"[]", b"null", b'{"robot": 7}', b'{"tick": "x"}'):
        stops.add(EVENTS, data)
        stops.add(TICKS, data)
        stops.add("/other", data)
    assert stops.all == []


def test_the_stops_of_a_recorded_drive_are_events_at_their_steps(tmp_path: Path) -> None:
    path = tmp_path / "drive.mcap"
    made(path, steps=30)
    identity, recorded = RecordingStore(Workspace(tmp_path)).load(path.name)
    assert recorded.stops.all == []
    recorded.stops.add(TICKS, tick(11))
    recorded.stops.add(EVENTS, event("latched_stop", latched=("emergency stop",)))
    timeline = Timeline(identity.scenario, identity.seed, identity.run, None, recorded)
    timeline.seek(recorded.points[-1].tick, FOREVER_S)
    timeline.seek(5, FOREVER_S)
    timeline.seek(29, FOREVER_S)
    stopped = [each for each in timeline.events.since(0) if each.kind == "stopped"]
    found: list[Any] = [(each.tick, each.of, each.text) for each in stopped]
    assert found == [(12, ROBOT, "stopped: emergency stop")]
    assert timeline.step_s == STEP_S

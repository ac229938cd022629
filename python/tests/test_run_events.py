"""The events of a run that a page displays: those of its recording, and in bounded memory."""

from pathlib import Path
from typing import Any

import pytest
from page_client import Page
from recorded import SECOND_NS, contents

import agent_economy as ae
from agent_economy.server.runs import run_events
from agent_economy.server.runs.run_events import RunEvents
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 60.0


def received(page: Page, until: int) -> list[dict[str, Any]]:
    """Return the events that a page has after the run was stepped to a tick."""
    page.open(scenario="mines", seed="7", run="0", tick=until)
    rows: list[dict[str, Any]] = []
    for message in page.received:
        if message["type"] == "events":
            rows = [row for row in rows if row["tick"] < message["since"]] + message["rows"]
    return rows


def test_a_page_lists_the_events_that_the_recording_has_in_its_log(
    page: Page, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    with ae.Recording(ae.Simulation("mines", 7), path) as recording:
        recording.step(1200)
    step_s = ae.Simulation("mines", 7).step_s
    logged = {
        (round(line.time_ns / SECOND_NS / step_s), line.content.name, line.content.message)
        for line in contents(path).topics["/log"]
    }
    rows = received(page, 1200)
    assert {row["kind"] for row in rows} >= {"awarded", "marked", "sent", "acted", "found"}
    for row in rows:
        found_s = f"found at {row['tick'] * step_s:.3f} s"
        text = found_s if row["kind"] == "found" else row["text"]
        assert (row["tick"] + 1, row["of"], text) in logged
    finds = [row for row in rows if row["kind"] == "found"]
    assert all(row["text"] == f"found by {row['agent']}" for row in finds)


def test_events_are_the_same_at_any_speed_and_after_any_seek() -> None:
    scenario = ae.Scenario.load("mines")
    one, other = Timeline(scenario, 7), Timeline(scenario, 7)
    one.seek(500, FOREVER_S)
    for tick in (3, 200, 100, 350, 0, 500):
        while not other.seek(tick, 0.0):
            pass
    assert one.events.since(0) == other.events.since(0) != []
    assert one.events.since(300) == [event for event in one.events.since(0) if event.tick >= 300]


def test_the_finds_of_a_classic_run_are_events(page: Page) -> None:
    page.open(scenario="classic", seed="7")
    end = page.finish()["tick"]
    rows = [row for each in page.received if each["type"] == "events" for row in each["rows"]]
    simulation = ae.ClassicSimulation("classic", 7)
    simulation.finish()
    found_s = simulation.items["found_s"].to_pylist()
    expected = {
        (f"item/{place}", round(at_s / simulation.step_s) - 1)
        for place, at_s in enumerate(found_s)
        if at_s is not None
    }
    assert {(row["of"], row["tick"]) for row in rows if row["kind"] == "found"} == expected
    assert [row["tick"] for row in rows if row["kind"] == "ended"] == [end - 1]


def test_of_very_many_events_of_a_kind_every_second_one_is_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(run_events, "MAX_EVENTS", 8)
    timeline = Timeline(ae.Scenario.load("mines"), 7)
    timeline.seek(600, FOREVER_S)
    kept = timeline.events
    counts = dict.fromkeys(kept.strides, 0)
    for event in kept.since(0):
        if event.kind in counts:
            counts[event.kind] += 1
    assert counts
    assert all(4 <= count <= 9 for count in counts.values())
    monkeypatch.setattr(run_events, "MAX_EVENTS", 10_000)
    complete = Timeline(ae.Scenario.load("mines"), 7)
    complete.seek(600, FOREVER_S)
    for kind, stride in kept.strides.items():
        same_kind = [event for event in complete.events.since(0) if event.kind == kind]
        assert [event for event in kept.since(0) if event.kind == kind] == same_kind[::stride]


def test_the_end_is_an_event_until_a_change_continues_the_run() -> None:
    timeline = Timeline(ae.Scenario.load("search"), 3)
    timeline.seek(100_000, FOREVER_S)
    end = timeline.events.since(0)[-1]
    assert (end.kind, end.text, end.tick) == ("ended", "complete", timeline.tick - 1)
    timeline.seek(timeline.tick - 1, FOREVER_S)
    timeline.change("items.mine.count", 40)
    assert all(event.kind != "ended" for event in timeline.events.since(0))
    timeline.undo()
    assert timeline.events.since(0)[-1] == end


def test_a_copy_of_events_is_independent() -> None:
    timeline = Timeline(ae.Scenario.load("mines"), 7)
    timeline.seek(300, FOREVER_S)
    copy = timeline.events.copy()
    copy.discard_from(0)
    assert isinstance(copy, RunEvents)
    assert copy.since(0) == []
    assert timeline.events.since(0)

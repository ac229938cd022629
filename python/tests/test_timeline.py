"""Seeking back and forth in a run."""

from contextlib import suppress

import pytest

import agent_economy as ae
from agent_economy import _core
from agent_economy.recording.reading import Point, Recorded
from agent_economy.runs import factory
from agent_economy.runs.stepped import Change
from agent_economy.server.runs import snapshots
from agent_economy.server.runs.snapshots import FIRST_INTERVAL, MAX_SNAPSHOTS
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 60.0


def begun(log: tuple[Change, ...] = ()) -> Timeline:
    return Timeline(ae.Scenario.load("search-beliefs"), 7, 0, log)


def hashes(timeline: Timeline, ticks: range | list[int]) -> list[int]:
    visited = []
    for tick in ticks:
        assert timeline.seek(tick, FOREVER_S)
        assert timeline.tick == tick
        visited.append(timeline.simulation.hash)
    return visited


def test_back_and_forth_gives_the_same_run() -> None:
    timeline = begun()
    ticks = [0, 1, FIRST_INTERVAL - 1, FIRST_INTERVAL, FIRST_INTERVAL + 1, 120, 200]
    once = hashes(timeline, ticks)
    assert hashes(timeline, ticks[::-1]) == once[::-1]
    assert timeline.latest_tick == 200
    simulation = ae.Simulation("search-beliefs", 7)
    simulation.step(200)
    assert simulation.hash == once[-1]


def test_back_and_forth_gives_the_same_classic_run() -> None:
    timeline = Timeline(ae.Scenario.load("classic"), 7)
    ticks = [0, 1, 11, 12, FIRST_INTERVAL, 77, 200]
    once = hashes(timeline, ticks)
    assert hashes(timeline, ticks[::-1]) == once[::-1]
    timeline.seek(60, FOREVER_S)
    timeline.change("robots.wanderer.count", 40)
    timeline.seek(100, FOREVER_S)
    timeline.change("contact", "ahead")
    timeline.undo()
    changed = hashes(timeline, [100, 59, 60, 30, 100])
    again = Timeline(ae.Scenario.load("classic"), 7, 0, timeline.log)
    assert hashes(again, [59, 60, 100]) == [changed[1], changed[2], changed[4]]
    assert again.simulation.scenario.to_dict()["contact"] == "touch"


def test_a_classic_run_that_is_over_continues_after_a_change() -> None:
    timeline = Timeline(ae.Scenario.load("classic").replace("clock.time_limit_s", 5), 7)
    assert timeline.seek(100_000, FOREVER_S)
    assert timeline.tick == 5 * 56
    timeline.change("clock.time_limit_s", 10)
    assert timeline.seek(300, FOREVER_S)
    assert timeline.tick == 300


def test_a_classic_run_that_ends_before_its_recording_is_reported() -> None:
    scenario = ae.Scenario.load("classic").replace("clock.time_limit_s", 1)
    simulation = ae.ClassicSimulation("classic", 7)
    points = []
    for tick in range(101):
        points.append(Point(tick, 0, f"{simulation.hash:016x}"))
        simulation.step()
    timeline = Timeline(scenario, 7, recorded=Recorded(points))
    assert timeline.latest_tick == 100
    assert timeline.seek(100, FOREVER_S)
    assert (timeline.tick, timeline.latest_tick, timeline.recorded.mismatch_tick) == (56, 56, 57)


def test_a_change_discards_later_ticks_and_its_log_replays_the_run() -> None:
    timeline = begun()
    hashes(timeline, [150, 60])
    timeline.change("robots.rover.count", 6)
    assert (timeline.latest_tick, timeline.tick) == (60, 60)
    changed = hashes(timeline, [60, 90, 100, 90, 60, 30])
    assert changed[0] == changed[4]
    again = begun(timeline.log)
    assert hashes(again, [30, 60, 90, 100]) == [changed[-1], changed[0], *changed[1:3]]


def test_before_a_change_the_scenario_is_the_old_one_and_after_it_the_new_one() -> None:
    timeline = begun()
    hashes(timeline, [60])
    timeline.change("robots.rover.count", 6)
    counts = []
    for tick in (59, 60, 61, 0):
        timeline.seek(tick, FOREVER_S)
        counts.append(len(timeline.simulation.robots))
    assert counts == [4, 6, 6, 4]


def test_setting_the_same_value_changes_nothing() -> None:
    timeline = begun()
    hashes(timeline, [30, 10])
    timeline.change("robots.rover.count", 4)
    assert (timeline.latest_tick, timeline.log) == (30, ())


def test_undo_restores_the_run_without_the_change() -> None:
    timeline = begun()
    once = hashes(timeline, [40, 70])
    timeline.seek(40, FOREVER_S)
    # The scenario does not contain this key: there is no value to restore.
    timeline.change("robots.rover.radius_m", 0.3)
    assert hashes(timeline, [70]) != once[1:]
    timeline.undo()
    assert timeline.log == ()
    assert timeline.latest_tick == 70
    assert hashes(timeline, [40, 70]) == once


@pytest.mark.parametrize("tick", [0, 60])
def test_undo_removes_one_change_after_another(tick: int) -> None:
    timeline = begun()
    before = hashes(timeline, [tick])
    for count in (6, 5):
        timeline.change("robots.rover.count", count)
    timeline.seek(tick + 10, FOREVER_S)
    timeline.undo()
    timeline.seek(tick + 5, FOREVER_S)
    assert len(timeline.simulation.robots) == 6
    timeline.undo()
    assert hashes(timeline, [tick]) == before
    assert timeline.log == ()


@pytest.mark.parametrize("tick", [0, 60])
def test_a_replaced_value_leaves_no_trace(tick: int) -> None:
    timeline, straight = begun(), begun()
    for each in (timeline, straight):
        hashes(each, [tick])
        each.change("clock.time_limit_s", 300)
    timeline.change("robots.rover.count", 6)
    for count in (90, 17, 8):
        timeline.change("robots.rover.count", count, replaces_last=True)
    straight.change("robots.rover.count", 8)
    assert timeline.log == straight.log
    assert hashes(timeline, [tick, tick + 40]) == hashes(straight, [tick, tick + 40])
    timeline.undo()
    assert [change.path for change in timeline.log] == ["clock.time_limit_s"]


def test_an_invalid_replacement_keeps_the_current_value() -> None:
    timeline = begun()
    hashes(timeline, [30])
    timeline.change("robots.rover.count", 6)
    before = hashes(timeline, [30])
    for count in (-1, 500_000):
        with pytest.raises(ae.InputError):
            timeline.change("robots.rover.count", count, replaces_last=True)
    assert hashes(timeline, [30]) == before
    assert [change.value for change in timeline.log] == [6]


def test_a_slider_dragged_back_to_its_start_changes_nothing() -> None:
    timeline = begun()
    before = hashes(timeline, [30])
    timeline.change("robots.rover.count", 6)
    timeline.change("robots.rover.count", 4, replaces_last=True)
    assert timeline.log == ()
    assert hashes(timeline, [30]) == before


def test_a_replacement_keeps_values_of_other_paths_and_ticks() -> None:
    timeline = begun()
    timeline.change("robots.rover.count", 6, replaces_last=True)
    timeline.change("clock.time_limit_s", 300, replaces_last=True)
    timeline.seek(1, FOREVER_S)
    timeline.change("clock.time_limit_s", 200, replaces_last=True)
    assert [change.value for change in timeline.log] == [6, 300, 200]


@pytest.mark.parametrize("first", [500_000, 6])
def test_a_replacement_does_not_replace_a_refused_value(first: int) -> None:
    timeline = begun()
    timeline.change("robots.rover.count", 6)
    with suppress(ae.InputError):
        timeline.change("robots.rover.count", first)
    timeline.change("robots.rover.count", 8, replaces_last=True)
    assert [change.value for change in timeline.log] == [6, 8]


def test_a_value_replaces_the_last_one_after_a_seek_and_return() -> None:
    timeline = begun()
    hashes(timeline, [30])
    timeline.change("robots.rover.count", 6)
    hashes(timeline, [90, 30])
    timeline.change("robots.rover.count", 8, replaces_last=True)
    assert timeline.log == (Change(30, "robots.rover.count", 8),)
    straight = begun()
    hashes(straight, [30])
    straight.change("robots.rover.count", 8)
    assert hashes(timeline, [30, 60]) == hashes(straight, [30, 60])


def test_true_differs_from_one() -> None:
    timeline = begun()
    timeline.change("robots.rover.count", 1)
    with pytest.raises(ae.InputError):
        timeline.change("robots.rover.count", True)  # noqa: FBT003


def test_the_snapshot_before_a_change_is_always_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(snapshots, "MEMORY_BYTES", 0)
    timeline = begun()
    for tick in (10, 20, 30, 40):
        timeline.seek(tick, FOREVER_S)
        timeline.change("robots.rover.count", tick)
        timeline.change("robots.rover.count", tick + 1, replaces_last=True)
    assert [change.value for change in timeline.log] == [11, 21, 31, 41]


def test_undo_without_a_change_is_refused() -> None:
    with pytest.raises(ae.InputError, match="must be after a change"):
        begun().undo()


def test_setting_the_value_of_a_robot_model_changes_nothing() -> None:
    timeline = begun()
    document = _core.read_filled(timeline.simulation.scenario.source)
    timeline.change("robots.rover.radius_m", document["robots"]["rover"]["radius_m"])
    assert timeline.log == ()


@pytest.mark.parametrize("name", ["search", "search-beliefs", "flock", "classic"])
def test_a_run_ends_at_the_same_tick_at_any_speed(name: str) -> None:
    scenario = ae.Scenario.load(name)
    timeline = Timeline(scenario, 7)
    assert timeline.seek(10_000, FOREVER_S)
    simulation = factory.create(scenario, 7, 0)
    while not simulation.is_over:
        simulation.step()
    assert timeline.latest_tick == timeline.tick == simulation.tick < 10_000
    assert timeline.simulation.hash == simulation.hash


def test_a_long_seek_is_divided_into_time_slices() -> None:
    timeline = Timeline(ae.Scenario.load("search-beliefs").replace("clock.time_limit_s", 10_000), 1)
    pieces = 0
    while not timeline.seek(2_000, 0.0):
        pieces += 1
    assert pieces > 1


def test_snapshots_are_thinned_and_every_tick_remains_reachable() -> None:
    long = (
        ae.Scenario.load("search")
        .replace("clock.time_limit_s", 10_000)
        .replace("items.mine.count", 0)
    )
    timeline = Timeline(long, 1)
    end = FIRST_INTERVAL * (MAX_SNAPSHOTS + 10)
    last = hashes(timeline, [end])
    assert len(timeline._snapshots._kept) <= MAX_SNAPSHOTS
    assert hashes(timeline, [17, end])[1:] == last


def test_a_change_without_room_is_reported_at_its_tick() -> None:
    log = (Change(20, "robots.rover.count", 100_000),)
    timeline = begun(log)
    with pytest.raises(ae.InputError):
        timeline.seek(30, FOREVER_S)
    assert timeline.log == ()
    assert timeline.seek(30, FOREVER_S)

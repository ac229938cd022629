"""The versions of a run that changes make: undo, redo and branches."""

import itertools
import random

import pytest

import agent_economy as ae
from agent_economy.runs.stepped import Change
from agent_economy.server.runs import versions
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 60.0
ROVERS = "robots.rover.count"


def begun(log: tuple[Change, ...] = ()) -> Timeline:
    return Timeline(ae.Scenario.load("search-beliefs"), 7, 0, log)


def at(timeline: Timeline, tick: int) -> int:
    assert timeline.seek(tick, FOREVER_S)
    return timeline.simulation.hash


def changed(timeline: Timeline, tick: int, count: int) -> None:
    at(timeline, tick)
    timeline.change(ROVERS, count)


def straight(log: tuple[Change, ...], tick: int) -> Timeline:
    """A run with these changes that was never moved back."""
    timeline = begun(log)
    at(timeline, tick)
    return timeline


def test_undo_restores_the_future_that_a_change_has_cut_and_redo_the_change() -> None:
    timeline = begun()
    changed(timeline, 40, 6)
    changed(timeline, 70, 5)
    before = at(timeline, 85)
    changed(timeline, 50, 3)
    after = at(timeline, 80)
    timeline.undo()
    assert [change.tick for change in timeline.log] == [40, 70]
    assert timeline.latest_tick == 85
    assert at(timeline, 85) == before
    timeline.redo()
    assert [change.tick for change in timeline.log] == [40, 50]
    assert timeline.latest_tick == 80
    assert at(timeline, 80) == after
    for _ in range(2):
        timeline.undo()
    timeline.undo()
    assert timeline.log == ()
    for _ in range(3):
        timeline.redo()
    assert at(timeline, 80) == after
    with pytest.raises(ae.InputError, match="must be after an undo"):
        timeline.redo()


def test_a_change_after_an_undo_leaves_the_version_that_was_undone_as_a_branch() -> None:
    timeline = begun()
    changed(timeline, 40, 6)
    first = timeline.versions.current.number
    branch = at(timeline, 80)
    timeline.undo()
    changed(timeline, 30, 2)
    assert at(timeline, 80) != branch
    timeline.choose_version(first)
    assert at(timeline, 80) == branch
    timeline.undo()
    timeline.redo()
    assert timeline.versions.current.number == first
    with pytest.raises(ae.InputError, match="must be the number of a version"):
        timeline.choose_version(17)


def test_dragging_a_slider_makes_one_version_and_dragging_it_back_none() -> None:
    timeline = begun()
    at(timeline, 60)
    future = at(timeline, 90)
    at(timeline, 60)
    for count in (6, 7, 8):
        timeline.change(ROVERS, count, replaces_last=True)
    assert len(timeline.versions.all) == 2
    timeline.change(ROVERS, 4, replaces_last=True)
    assert len(timeline.versions.all) == 1
    assert (timeline.log, timeline.latest_tick) == ((), 90)
    assert at(timeline, 90) == future


def test_a_log_that_was_opened_is_undone_change_by_change() -> None:
    log = (Change(10, ROVERS, 6), Change(30, ROVERS, 5))
    timeline = begun(log)
    at(timeline, 50)
    for made in (1, 0):
        timeline.undo()
        assert timeline.log == log[:made]
        assert at(timeline, 50) == straight(log[:made], 50).simulation.hash


def test_the_oldest_branch_is_forgotten_and_never_what_undo_leads_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(versions, "MAX_VERSIONS", 4)
    timeline = begun()
    for count in (6, 7, 8, 9, 10):
        timeline.change(ROVERS, count)
        timeline.undo()
    timeline.redo()
    assert [change.value for change in timeline.log] == [10]
    assert len(timeline.versions.all) == 4
    for count in (1, 2, 3, 4):
        timeline.change(ROVERS, count)
    assert [change.value for change in timeline.log] == [10, 1, 2, 3, 4]
    for _ in range(5):
        timeline.undo()
    assert timeline.log == ()


@pytest.mark.parametrize("seed", range(2))
def test_whatever_was_moved_changed_and_undone_the_run_is_that_of_its_log(seed: int) -> None:
    chance, timeline = random.Random(seed), begun()  # noqa: S311
    for _ in range(12):
        at(timeline, chance.randrange(0, 160))
        way = chance.choice(["change", "drag", "undo", "redo", "choose"])
        if way == "change":
            timeline.change(ROVERS, chance.randrange(1, 7))
        elif way == "drag":
            timeline.change(ROVERS, chance.randrange(1, 7), replaces_last=True)
        elif way == "undo" and timeline.versions.current.parent is not None:
            timeline.undo()
        elif way == "redo" and timeline.versions.can_redo:
            timeline.redo()
        elif way == "choose":
            timeline.choose_version(chance.choice(list(timeline.versions.all)))
        tick = chance.randrange(0, 160)
        end = max(tick, timeline.latest_tick)
        assert at(timeline, end) == straight(timeline.log, end).simulation.hash
        assert at(timeline, tick) == straight(timeline.log, tick).simulation.hash
        plain = straight(timeline.log, end)
        assert timeline.events.since(0) == plain.events.since(0)
        assert finds(timeline) == finds(plain)


def finds(timeline: Timeline) -> list[tuple[int, float]]:
    """The steps after which the number of items found was another one, and that number."""
    series = timeline.series.since(0)
    column = series["columns"].index("found")
    rows = [(row["tick"], row["values"][column]) for row in series["rows"]]
    pairs = itertools.pairwise(rows)
    return [(tick, float(found or 0)) for (_, before), (tick, found) in pairs if found != before]

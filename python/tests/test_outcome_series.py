"""The outcome over time: exact finds at any speed, in bounded memory."""

import itertools
from typing import Any

import pytest
from page_client import Page

import agent_economy as ae
from agent_economy.server.runs import outcome_series
from agent_economy.server.runs.outcome_series import OutcomeSeries
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 60.0


def table(page: Page, since: int = 0) -> list[dict[str, Any]]:
    """Return the rows of the series of a page."""
    page.send("request_series", since=since)
    series = page.wait_for("series")
    assert series["since"] == since
    names = ["tick", *series["columns"]]
    return [dict(zip(names, [row["tick"], *row["values"]], strict=True)) for row in series["rows"]]


def finds(rows: list[dict[str, Any]]) -> list[tuple[int, float]]:
    """Return the rows at which items were found."""
    return [
        (row["tick"], row["found"])
        for before, row in itertools.pairwise(rows)
        if row["found"] != before["found"]
    ]


def exact_finds(name: str, seed: int) -> list[tuple[int, float]]:
    """Return the ticks at which items were found in a run, and how many then."""
    run = ae.Simulation(name, seed)
    last, rows = 0, []
    while not run.is_over:
        run.step()
        if (found := run.outcome().row["found"]) != last:
            rows.append((run.tick, found))
            last = found
    return rows


@pytest.mark.parametrize("seed", [3, 7])
def test_at_maximum_speed_each_find_has_its_row(page: Page, seed: int) -> None:
    page.open(seed=str(seed))
    page.finish()
    assert finds(table(page)) == exact_finds("search-beliefs", seed) != []


def test_a_run_opened_at_a_moment_has_the_rows_before_it(page: Page) -> None:
    page.open(tick=exact_finds("search-beliefs", 7)[-1][0])
    rows = table(page)
    assert rows[0]["tick"] == 0
    assert finds(rows) == exact_finds("search-beliefs", 7)


def test_rows_from_a_tick_on_are_requested_separately(page: Page) -> None:
    page.open(tick=200)
    rows = table(page)
    assert table(page, 100) == [row for row in rows if row["tick"] >= 100] != []


def test_a_classic_run_has_a_series_too(page: Page) -> None:
    page.open(scenario="classic")
    over = page.finish()
    assert table(page)[-1]["found"] == over["outcome"]["found"]


def test_a_change_discards_the_rows_after_it_and_an_undo_those_of_the_change() -> None:
    timeline = Timeline(ae.Scenario.load("search-beliefs"), 3)  # no finds from tick 100 to 200
    timeline.seek(200, FOREVER_S)
    before = timeline.series.since(0)
    timeline.seek(100, FOREVER_S)
    assert timeline.series.since(0) == before
    timeline.change("robots.rover.count", 8)
    rows = timeline.series.since(0)["rows"]
    assert rows[-1]["tick"] == 100
    assert rows[:-1] == before["rows"][: len(rows) - 1]
    timeline.seek(200, FOREVER_S)
    robots = timeline.series.since(150)["columns"].index("robots")
    assert {row["values"][robots] for row in timeline.series.since(150)["rows"]} == {8}
    timeline.undo()
    timeline.seek(200, FOREVER_S)
    assert finds_of(timeline) == [
        each for each in exact_finds("search-beliefs", 3) if each[0] <= 200
    ]


def finds_of(timeline: Timeline) -> list[tuple[int, float]]:
    series = timeline.series.since(0)
    names = ["tick", *series["columns"]]
    rows = [[row["tick"], *row["values"]] for row in series["rows"]]
    return finds([dict(zip(names, row, strict=True)) for row in rows])


def test_rows_are_bounded_and_finds_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(outcome_series, "MAX_ROWS", 12)
    series, run = OutcomeSeries(), ae.Simulation("search-beliefs", 7)
    while not run.is_over:
        series.note(run)
        run.step()
    series.note(run)
    rows = series.since(0)["rows"]
    found = series.since(0)["columns"].index("found")
    assert len(rows) <= 12
    exact = exact_finds("search-beliefs", 7)
    assert set(exact) <= {(row["tick"], row["values"][found]) for row in rows}


def test_a_request_for_the_series_is_answered_without_another_state(page: Page) -> None:
    page.open(tick=20)
    page.refusal("undo")
    received = len(page.received)
    table(page)
    page.refusal("undo")
    assert [each["type"] for each in page.received[received:]] == ["series", "refused"]

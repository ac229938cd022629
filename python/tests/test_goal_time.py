"""Where the time of a goal goes: its chart, its table and its sentence in studies."""

import json
from pathlib import Path
from typing import Any

import altair as alt
import in_memory_study
import numpy as np
import pytest
import vl_convert
from in_memory_study import WANDERERS, Columns, Floats, Values

from agent_economy import InputError, Scenario, study
from agent_economy.study import files, report
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.goal_time import PARTS, goal_time, in_words
from agent_economy.study.answer.labels import label, recommendation
from agent_economy.study.report import charts
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.sections import sections
from agent_economy.study.teams import costs

HEADING = "Where the time of a goal goes"
ROVERS, BASES = "robots.rover.count", "controllers.base.count"
ALLOCATION = "controllers.base.allocation"


def with_goals(values: Values, first_run: int, runs: int) -> Columns:
    """Return runs in which larger teams shorten the waiting, and robots block each other."""
    columns = in_memory_study.classic(values, first_run, runs)
    robots = float(values[WANDERERS])
    parts = {"waiting_s": 60 / robots, "travel_s": 20.0, "blocked_s": robots, "service_s": 2.0}
    return columns | {name: np.full(runs, value) for name, value in counted(parts).items()}


def counted(parts: dict[str, float]) -> dict[str, float]:
    """Return the columns of a run that served ten goals."""
    return {"served": 10.0, "served_twice": 1.0, **parts}


def sample(**columns: list[float]) -> Sample:
    """Return a sample with the columns of goals; those that are not given are zero."""
    runs = len(columns["served"])
    given: dict[str, Floats] = {name: np.zeros(runs) for name in ("served_twice", *PARTS)}
    given |= {name: np.array(values) for name, values in columns.items()}
    return Sample({}, given, {}, 0)


@pytest.fixture(scope="module")
def teams() -> tuple[Answer, Evidence]:
    """Return a study of goals with one to four robots."""
    given: list[Values] = [{WANDERERS: robots} for robots in range(1, 5)]
    return in_memory_study.study(given, with_goals, runs=20)


@pytest.fixture(scope="module")
def waypoints() -> Scenario:
    """Return a small scenario with goals and controllers, whose study takes seconds."""
    scenario = Scenario.load("waypoints").replace("goals.spot.count", 8)
    varied = {BASES: "0,1", ROVERS: "2,4"}
    return scenario.replace("study.vary", varied)


def test_a_run_counts_by_the_goals_that_it_served() -> None:
    time = goal_time(sample(served=[30, 10, 0], waiting_s=[10, 50, 0], travel_s=[5, 5, 0]))
    assert time is not None
    assert (time.waiting_s, time.travel_s) == (20, 5)
    assert time.served == pytest.approx(40 / 3)


def test_quarantined_runs_are_left_out() -> None:
    time = goal_time(sample(served=[10, np.nan], waiting_s=[10, np.nan], travel_s=[1, np.nan]))
    marked = goal_time(sample(served=[10, 60], waiting_s=[10, 900], quarantined=[0, 1]))
    assert time is not None
    assert marked is not None
    assert time.waiting_s == marked.waiting_s == 10


def test_without_served_goals_there_is_no_time_of_a_goal() -> None:
    assert goal_time(sample(served=[0, 0])) is None
    assert goal_time(Sample({}, {"time_s": np.ones(2)}, {}, 0)) is None


def test_the_sentence_has_the_share_of_each_part() -> None:
    parts = {"waiting_s": [60.0], "travel_s": [30.0], "blocked_s": [8.0], "service_s": [2.0]}
    time = goal_time(sample(served=[4], **parts))
    assert time is not None
    assert in_words(time) == (
        "a goal is served 100 s after its issue on average: waiting 60%, travel 30%, blocked 8%, "
        "service 2%."
    )


def test_the_parts_of_a_bar_add_up_to_its_number(teams: tuple[Answer, Evidence]) -> None:
    spec = charts.specifications(MeritView(*teams))["goal-time"]
    bars, numbers = spec["data"]["values"], spec["layer"][1]["data"]["values"]
    assert len(bars) == 4 * len(numbers)
    for number in numbers:
        parts = [bar["time"] for bar in bars if bar["label"] == number["label"]]
        assert sum(parts) == pytest.approx(number["sum"])


def test_the_table_has_the_numbers_of_the_chart(teams: tuple[Answer, Evidence]) -> None:
    bars = charts.specifications(MeritView(*teams))["goal-time"]["data"]["values"]
    section = next(each for each in sections(MeritView(*teams)) if each.heading == HEADING)
    (table,) = section.tables
    drawn = [bar["time"] for bar in bars]
    written = [float(cell.text) for row in table.rows for cell in row.cells[1:5]]
    assert written == pytest.approx(drawn, abs=0.05)
    names = ["1 wanderer", "2 wanderers", "3 wanderers", "4 wanderers"]
    assert [row.cells[0].text for row in table.rows] == names


def test_the_chart_is_valid_and_can_be_drawn(teams: tuple[Answer, Evidence]) -> None:
    spec = charts.specifications(MeritView(*teams))["goal-time"]
    alt.LayerChart.from_dict(spec)
    svg = vl_convert.vegalite_to_svg(spec | {"width": 600})
    for part in ("waiting", "travel", "blocked", "service"):
        assert f">{part}<" in svg


def test_a_study_without_goals_has_no_trace_of_them() -> None:
    given: list[Values] = [{WANDERERS: robots} for robots in (2, 3)]
    answer, evidence = in_memory_study.study(given, in_memory_study.classic, runs=10)
    assert "goal-time" not in charts.specifications(MeritView(answer, evidence))
    assert HEADING not in report.html(answer, evidence, "")
    assert "goal_time" not in files.as_json(answer)


def test_a_study_of_goals_has_the_chart_and_its_numbers(
    waypoints: Scenario, tmp_path: Path
) -> None:
    plan = study.make_plan(waypoints, runs=10)
    answer = study.run_plan(plan, tmp_path)
    page = (tmp_path / "report.html").read_text("utf-8")
    assert f"<h2>{HEADING}</h2>" in page
    assert 'id="goal-time"' in page
    results = json.loads((tmp_path / "answer.json").read_text("utf-8"))["results"]
    runs = study.open(tmp_path).runs()
    means = runs.aggregate(
        "configuration, sum(served * waiting_s) / sum(served) AS waiting_s", "configuration"
    ).fetchall()
    for configuration, waiting_s in means:
        assert results[configuration]["goal_time"]["waiting_s"] == pytest.approx(waiting_s)
    labels = {"2 rovers, 0 bases", "4 rovers, 0 bases", "2 rovers, 1 base", "4 rovers, 1 base"}
    assert {result.label for result in answer.results} == labels
    assert "How many bases are enough" in page
    assert "complete means that all goals are served" in page


def test_a_requirement_on_goals_has_the_chart(waypoints: Scenario, tmp_path: Path) -> None:
    required: Any = {"all": ["served >= 8"], "probability": 0.5, "tolerance": 0.4}
    plan = study.make_plan(waypoints.replace("require", required), max_runs=40)
    study.run_plan(plan, tmp_path)
    assert f"<h2>{HEADING}</h2>" in (tmp_path / "report.html").read_text("utf-8")


def test_controllers_come_after_robots_in_names() -> None:
    values: Values = {ALLOCATION: "auction", BASES: 1, ROVERS: 8}
    assert label(values) == "8 rovers, 1 base, allocation auction"
    assert recommendation(values) == "Send 8 rovers with 1 base, allocation auction"
    assert recommendation({BASES: 2}) == "Choose 2 bases"
    assert label({ALLOCATION: "auction", BASES: 0, ROVERS: 8}) == "8 rovers, 0 bases"
    assert label({ALLOCATION: "none", "controllers.van.allocation": "auction"}) == (
        "controllers.base.allocation none, controllers.van.allocation auction"
    )


def test_the_cost_of_a_team_can_count_controllers(waypoints: Scenario) -> None:
    required: Any = {"all": ["served >= 8"]}
    scenario = waypoints.replace("require", required)
    counted = study.make_plan(scenario.replace("study.minimize", "rover + 0.5 * base"))
    assert costs(counted.engine, counted.scenario.cost).tolist() == [2, 4, 2.5, 4.5]
    priced = study.make_plan(scenario.replace("study.minimize", "price"))
    assert costs(priced.engine, priced.scenario.cost).tolist() == [20_000, 40_000, 22_000, 42_000]
    robots = study.make_plan(scenario.replace("study.minimize", "robots"))
    assert costs(robots.engine, robots.scenario.cost).tolist() == [2, 4, 2, 4]
    with pytest.raises(InputError, match="'bas' is unknown.*did you mean 'base'"):
        study.make_plan(scenario.replace("study.minimize", "rover + bas"))

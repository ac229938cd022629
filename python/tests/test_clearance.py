"""Lanes that are declared clear: the risk beside the share declared, in runs and answers."""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import altair as alt
import in_memory_study
import numpy as np
import pytest
import vl_convert
from command_line import succeed
from in_memory_study import WANDERERS
from lane_study import FILE, LIMIT_S, OAVS, UGVS, Lanes, answered, lane

from agent_economy import study
from agent_economy.cli.lane_rows import lane_rows
from agent_economy.study import RequirementAnswer, files, report
from agent_economy.study.answer.any_answer import expect_best
from agent_economy.study.answer.clearance import Clearance, clearance, in_words, percent
from agent_economy.study.answer.evidence import Sample
from agent_economy.study.report.clearance_section import front
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.tables import Table

HEADING = "Lanes declared clear"
NEVER: Lanes = {(0, 1): (0.0, 0.0), (1, 1): (0.95, 0.05), (0, 2): (0.5, 0.4), (1, 2): (1.0, 0.0)}
"""The cheapest team never declares, and the dearest always does and is right."""


def sample(
    declared: Sequence[float],
    not_clear: Sequence[float],
    risk: Sequence[float],
    **more: Sequence[float],
) -> Sample:
    """Return a sample of lanes; those that were declared took 100 s."""
    columns = {
        "declared": np.array(declared),
        "declared_not_clear": np.array(not_clear),
        "stated_risk": np.array(risk),
        "declared_s": np.where(np.array(declared) == 1, 100.0, LIMIT_S),
    }
    return Sample({}, columns | {name: np.array(each) for name, each in more.items()}, {}, 0)


def known(of: Clearance | None) -> Clearance:
    """Return declarations that must be known."""
    assert of is not None
    return of


def row(**changes: Any) -> dict[str, Any]:
    """Return the outcome of a run whose lane was declared clear and is clear."""
    stated = {
        "declared": True,
        "declared_not_clear": False,
        "given_up": False,
        "stated_risk": 0.046,
    }
    acts = {"marked": 8, "false_marks": 1, "confirmed": 7, "false_confirmations": 2}
    times = {"declared_s": 412.2, "given_up_s": 300.4}
    ends = {"neutralised": 6, "left": 0, "robots_lost": 3}
    reasons = ("called_off", "controllers_lost", "robots_lost")
    ended = {f"ended_{reason}": False for reason in reasons}
    return {
        **stated,
        **acts,
        **times,
        **ends,
        **ended,
        "unmarked_from_air": 2,
        "met_unmarked": 1,
        **changes,
    }


def required(**changes: Any) -> study.Plan:
    """Return a plan for the cheapest team that declares a lane clear in 9 of 10 missions."""
    given = {"require.tolerance": 0.05, "require.probability": 0.9, **changes}
    return study.make_plan(lane(**given))


def test_the_risk_is_a_share_of_the_declared_lanes_only() -> None:
    found = known(clearance(sample([1, 1, 1, 1, 0], [1, 0, 0, 0, 0], [0.1, 0.3, 0, 0, 1]), 0.95))
    assert (found.lanes, found.declared, found.not_clear) == (5, 4, 1)
    assert (found.declared_share.value, found.risk and found.risk.value) == (0.8, 0.25)
    assert found.stated_risk == pytest.approx(0.1)
    assert (found.declared_s, found.cleared_s) == (100, 120)


def test_intervals_are_those_of_clopper_and_pearson() -> None:
    found = known(clearance(sample([1] * 10, [1] + [0] * 9, [0.1] * 10), 0.95))
    assert found.risk is not None
    # Clopper and Pearson (1934): 1 of 10 at 95%.
    assert (found.risk.low, found.risk.high) == pytest.approx((0.0025, 0.4450), abs=5e-5)
    assert found.declared_share.low == pytest.approx(0.6915, abs=5e-5)


def test_without_a_declared_lane_the_risk_is_not_known() -> None:
    found = known(clearance(sample([0, 0], [0, 0], [1, 0.4]), 0.95))
    assert (found.risk, found.stated_risk, found.declared_s) == (None, None, None)
    assert in_words(found) == "declared none of 2 lanes clear, so that the risk is not known"


def test_a_quarantined_run_declares_nothing() -> None:
    nan = np.nan
    missing = known(clearance(sample([1, nan], [0, nan], [0.1, nan]), 0.95))
    worst = known(clearance(sample([1, 1], [0, 1], [0.1, 1], quarantined=[0, 1]), 0.95))
    assert missing == worst
    assert (worst.lanes, worst.declared, worst.not_clear) == (2, 1, 0)


def test_scenarios_without_a_lane_and_teams_without_runs_have_no_declarations() -> None:
    assert clearance(Sample({}, {"time_s": np.ones(2)}, {}, 0), 0.95) is None
    assert clearance(sample([], [], []), 0.95) is None


def test_the_share_declared_is_beside_the_risk() -> None:
    found = known(clearance(sample([1] * 19 + [0], [1] + [0] * 19, [0.044] * 20), 0.95))
    assert in_words(found) == (
        "declared 95% of lanes clear; of these, 5.3% (0.13 to 26%) were not clear; stated 4.4%"
    )


@pytest.mark.parametrize(
    ("share", "text"),
    [(0, "0%"), (1, "100%"), (0.95, "95%"), (0.0466, "4.7%"), (0.00031, "0.031%")],
)
def test_shares_have_two_figures(share: float, text: str) -> None:
    assert percent(share) == text


def test_a_share_that_is_not_all_is_not_written_as_all() -> None:
    assert percent(0.9997) == "99.97%"


def test_a_run_states_the_declaration_and_the_truth() -> None:
    rows = dict(lane_rows(row()))
    stated = "declared clear at 412 s with a stated risk of 4.6%"
    assert rows["lane"] == f"{stated}; 0 mines left"
    assert rows["mines marked"] == "8, and 1 false mark"
    assert rows["mines confirmed"] == "7, and 2 false confirmations"
    assert rows["not marked from the air"] == "2, 1 of them met by ground robots"
    assert (rows["mines neutralised"], rows["robots lost"]) == ("6", "3")
    wrong = dict(lane_rows(row(declared_not_clear=True, left=1)))
    assert wrong["lane"] == f"{stated}, but it was not clear; 1 mine left"


def test_a_lane_that_is_not_declared_does_not_look_clear() -> None:
    given_up = dict(lane_rows(row(declared=False, given_up=True, stated_risk=0.34, left=3)))
    assert given_up["lane"] == (
        "not declared clear: given up at 300 s with a stated risk of 34.0%, as nothing lowered the "
        "risk; 3 mines left"
    )
    called = row(declared=False, given_up=True, ended_called_off=True, stated_risk=0.34)
    assert "as a person ended the mission" in dict(lane_rows(called))["lane"]
    lost = dict(lane_rows(row(declared=False, ended_controllers_lost=True)))
    assert lost["lane"].startswith("neither declared clear nor given up: all controllers were lost")
    neither = dict(lane_rows(row(declared=False, stated_risk=1.0, left=0)))
    assert neither["lane"] == "neither declared clear nor given up; 0 mines left"
    certain = dict(lane_rows(row(declared=False, given_up=True, stated_risk=1.0, left=0)))
    assert "given up at 300 s with a stated risk of 100.0%" in certain["lane"]


def test_runs_without_a_lane_have_no_such_rows() -> None:
    assert list(lane_rows({"time_s": 3.0, "left": 2})) == []
    assert list(lane_rows(dict.fromkeys(row()))) == []
    assert "lane" not in succeed("run", "search").stdout


def test_a_team_that_never_declares_is_neither_selected_nor_called_safe(tmp_path: Path) -> None:
    answer = answered(required(), NEVER, tmp_path)
    assert isinstance(answer, RequirementAnswer)
    assert answer.results[answer.selected or 0].label == "1 oav, 2 ugvs"
    words = "Declared 100% of lanes clear; of these, 0% (0 to "
    assert words in answer.verdict[1]
    assert words in answer.sentence
    results = json.loads((tmp_path / "answer.json").read_text("utf-8"))["results"]
    never = next(each for each in results if each["label"] == "0 oavs, 1 ugv")["clearance"]
    assert (never["declared"], never["risk"]) == (0, None)
    assert never["declared_share"]["value"] == 0


def tables_of(folder: Path) -> tuple[Table, ...]:
    """Return the tables of the section on declared lanes."""
    parts = report.parts(*study.load_answer(folder))
    return next(each.tables for each in parts.sections if each.heading == HEADING)


def test_the_report_has_the_teams_in_its_order_with_the_risk_or_not_known(tmp_path: Path) -> None:
    answered(required(), NEVER, tmp_path)
    table, *_ = tables_of(tmp_path)
    names = [each.cells[0].text for each in table.rows]
    assert names == ["0 oavs, 1 ugv", "1 oav, 1 ugv", "0 oavs, 2 ugvs", "1 oav, 2 ugvs"]
    assert table.rows[0].cells[3].text == "not known"
    assert table.rows[3].cells[2].text == "100%"
    assert f"<h2>{HEADING}</h2>" in (tmp_path / "report.html").read_text("utf-8")


def test_a_team_without_a_declared_lane_is_not_on_the_front(tmp_path: Path) -> None:
    answer = answered(required(), NEVER, tmp_path)
    assert isinstance(answer, RequirementAnswer)
    _, evidence = study.load_answer(tmp_path)
    labels = [answer.results[index].label for index in front(RequirementView(answer, evidence))]
    # The cheapest one declares nothing, and the one of two ground vehicles is worse and dearer.
    assert labels == ["1 oav, 1 ugv", "1 oav, 2 ugvs"]


def test_few_declarations_without_an_error_do_not_bring_a_team_to_the_front(
    tmp_path: Path,
) -> None:
    often, seldom = (0.95, 0.1), (0.05, 0.0)
    lanes: Lanes = {(0, 1): often, (1, 1): seldom, (0, 2): seldom, (1, 2): seldom}
    answer = answered(study.make_plan(lane(), runs=100), lanes, tmp_path)
    _, evidence = study.load_answer(tmp_path)
    found = [known(each.clearance) for each in answer.results]
    assert all(each.risk is not None for each in found)
    on_front = front(MeritView(expect_best(answer), evidence))
    assert [answer.results[index].label for index in on_front] == ["0 oavs, 1 ugv"]


def test_the_map_of_a_requirement_has_the_status_of_each_team_as_a_shape(tmp_path: Path) -> None:
    answered(required(), NEVER, tmp_path)
    parts = report.parts(*study.load_answer(tmp_path))
    spec = parts.charts["heat"]
    alt.LayerChart.from_dict(spec)
    assert "<path" in vl_convert.vegalite_to_svg(spec | {"width": 400})
    cells, marks = spec["data"]["values"], spec["layer"][-1]
    status = {(each["across"], each["down"]): each["mark"] for each in cells}
    assert status == {
        (0, 1): "refuted",
        (1, 1): "may meet",
        (0, 2): "refuted",
        (1, 2): "selected",
    }
    scale = marks["encoding"]["shape"]["scale"]
    assert len(set(scale["range"])) == len(scale["domain"]) == 3
    heading = "Missions that meet it by oavs and ugvs"
    (table,) = next(each.tables for each in parts.sections if each.heading == heading)
    assert [cell.range for each in table.rows for cell in each.cells[1:]].count("selected") == 1


def test_a_team_that_is_not_needed_has_a_mark_without_a_share(tmp_path: Path) -> None:
    lanes: Lanes = dict.fromkeys(NEVER, (1.0, 0.0))
    answered(required(), lanes, tmp_path)
    cells = report.parts(*study.load_answer(tmp_path)).charts["heat"]["data"]["values"]
    last = next(each for each in cells if (each["across"], each["down"]) == (1, 2))
    assert (last["value"], last["mark"]) == (None, "not needed")


def test_the_map_of_merit_marks_what_is_not_decided(tmp_path: Path) -> None:
    lanes: Lanes = {**dict.fromkeys(NEVER, (0.9, 0.0)), (0, 2): (0.0, 0.0)}
    plan = study.make_plan(lane(), delta=0.5, runs=200)
    answered(plan, lanes, tmp_path)
    cells = report.parts(*study.load_answer(tmp_path)).charts["heat"]["data"]["values"]
    marks = {(each["across"], each["down"]): each["mark"] for each in cells}
    assert marks[0, 1] == "selected"
    assert marks[0, 2] is None
    assert marks[1, 1] not in {None, "selected"}


def test_a_study_of_a_real_lane_states_its_risk(tmp_path: Path) -> None:
    out = tmp_path / "lane"
    given = succeed("study", str(FILE), "--runs", "20", "--out", str(out))
    runs = study.open(out).runs()
    counted = runs.aggregate(
        "configuration, sum(declared::int), sum(declared_not_clear::int)", "configuration"
    ).fetchall()
    answer = json.loads((out / "answer.json").read_text("utf-8"))
    assert len(counted) == 4
    for configuration, declared, not_clear in counted:
        found = answer["results"][configuration]["clearance"]
        assert (found["lanes"], found["declared"], found["not_clear"]) == (20, declared, not_clear)
    words = " ".join(given.stdout.split())
    assert re.search(r"Declared [\d.]+% of lanes clear; of these, [\d.]+% \([\d.]+ to", words)
    assert "share of these that were not clear" in words
    assert {OAVS, UGVS} == answer["results"][0]["values"].keys()


def test_a_run_of_a_real_lane_prints_what_json_has() -> None:
    outcome = json.loads(succeed("run", str(FILE), "--seed", "1", "--json").stdout)
    printed = " ".join(succeed("run", str(FILE), "--seed", "1").stdout.split())
    assert outcome["declared"] is True
    stated = f"declared clear at {outcome['declared_s']:.0f} s"
    assert f"{stated} with a stated risk of {outcome['stated_risk']:.1%}" in printed


def test_a_study_without_a_lane_has_no_trace_of_one() -> None:
    given: list[in_memory_study.Values] = [{WANDERERS: robots} for robots in (2, 3)]
    answer, evidence = in_memory_study.study(given, in_memory_study.classic, runs=10)
    assert HEADING not in report.html(answer, evidence, "")
    assert "clearance" not in files.as_json(answer)
    assert "lanes" not in " ".join(answer.verdict) + answer.sentence

"""Cheaper teams that may meet a requirement: they are named, and decided with further runs."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from command_line import refuse, succeed
from requirement_study import answered, required, simulated

from agent_economy import InputError, Scenario, study
from agent_economy.study import RequirementAnswer, teams
from agent_economy.study.api import answer_so_far
from agent_economy.study.plan import decided
from agent_economy.study.questions.cheapest import Cheapest

INSIDE = {1: 0.3, 2: 0.7, 3: 0.915, 4: 0.999, 5: 1.0, 6: 1.0}
"""Three wanderers meet the requirement of 0.9, but not with the tolerance of 0.05 to spare."""

BELOW = {**INSIDE, 3: 0.88}
"""They do not meet it."""


def plan_of(classic_toml: Path) -> study.Plan:
    return study.make_plan(required(classic_toml))


def resumed(plan: study.Plan, shares: dict[int, float], out: Path, **more: Any) -> Any:
    answer = study.resume(out, decide=True, compute=simulated(plan, shares), **more)
    assert isinstance(answer, RequirementAnswer)
    return answer


@pytest.mark.parametrize("shares", [INSIDE, BELOW])
def test_a_cheaper_team_that_may_meet_it_is_named_with_the_runs_that_decide(
    classic_toml: Path, tmp_path: Path, shares: dict[int, float]
) -> None:
    answer = answered(plan_of(classic_toml), shares, tmp_path)
    assert answer.selected == 3
    assert answer.results[2].status == "may meet"
    met = answer.results[2].met
    assert met is not None
    share = f"{met.value:.1%} of {answer.results[2].runs}"
    assert f"3 wanderers ({share} did) may meet it as well" in answer.verdict[2]
    assert "more runs would decide (--decide)." in answer.verdict[2]
    assert "3 wanderers: met in fewer" not in answer.sentence
    stored = json.loads((tmp_path / "answer.json").read_text())
    assert stored["runs_to_decide"] == answer.runs_to_decide
    assert stored["results"][2]["status"] == "may meet"
    assert "may meet" in (tmp_path / "report.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("shares", "selected", "status"),
    [
        (INSIDE, 2, "selected"),
        (BELOW, 3, "refuted"),
    ],
)
def test_deciding_selects_the_cheaper_team_if_it_meets_it_and_refutes_it_if_not(
    classic_toml: Path, tmp_path: Path, shares: dict[int, float], selected: int, status: str
) -> None:
    plan = plan_of(classic_toml)
    before = answered(plan, shares, tmp_path)
    answer = resumed(plan, shares, tmp_path)
    assert answer.selected == selected
    assert answer.results[2].status == status
    assert answer.is_guaranteed
    assert answer.requirement.tolerance == pytest.approx(0.0125)
    assert "meets it in 91.25% or more" in answer.guarantee
    assert answer.runs_to_decide is None
    assert "--decide" not in answer.sentence
    # The prediction is of the right size, and the stored runs are used again.
    assert before.runs_to_decide is not None
    further = answer.runs - before.runs
    assert before.runs_to_decide / 3 < further < 3 * before.runs_to_decide
    assert len(answer.questions) == 2


def test_a_study_that_decides_at_once_ends_with_the_bytes_of_one_that_decides_later(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = plan_of(classic_toml)
    answered(plan, INSIDE, tmp_path / "later")
    resumed(plan, INSIDE, tmp_path / "later")
    answered(decided(plan), INSIDE, tmp_path / "once")
    for name in ("answer.json", "report.html", "study.toml"):
        once = (tmp_path / "once" / name).read_bytes()
        assert (tmp_path / "later" / name).read_bytes() == once


def test_an_interrupted_decision_keeps_the_promise_so_far_and_is_resumed(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = plan_of(classic_toml)
    first = answered(plan, INSIDE, tmp_path / "stopped")

    def stop(progress: study.Progress) -> None:
        if progress.runs > first.runs + 300:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        resumed(plan, INSIDE, tmp_path / "stopped", on_progress=stop)
    so_far = answer_so_far(tmp_path / "stopped")
    assert isinstance(so_far, RequirementAnswer)
    assert so_far.is_guaranteed
    assert so_far.guarantee == first.guarantee
    assert so_far.runs > first.runs
    study.resume(tmp_path / "stopped", compute=simulated(plan, INSIDE))
    answered(decided(plan), INSIDE, tmp_path / "whole")
    whole = (tmp_path / "whole" / "answer.json").read_bytes()
    assert (tmp_path / "stopped" / "answer.json").read_bytes() == whole


def test_a_run_budget_ends_a_decision_with_the_promise_so_far(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = plan_of(classic_toml)
    shares = {**INSIDE, 3: 0.9 + 0.0125 / 2}
    first = answered(plan, shares, tmp_path)
    answer = resumed(plan, shares, tmp_path, max_runs=first.runs + 500)
    assert first.runs < answer.runs <= first.runs + 500
    assert answer.is_guaranteed
    assert answer.guarantee == first.guarantee
    assert "may meet it as well" in answer.sentence
    # The next decision continues at the tolerance that was not reached.
    further = resumed(plan, shares, tmp_path)
    assert further.requirement.tolerance == pytest.approx(0.0125)


def test_each_decision_quarters_the_tolerance_until_nothing_is_undecided(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = plan_of(classic_toml)
    shares = {**INSIDE, 3: 0.901}
    answered(plan, shares, tmp_path)
    tolerances = [resumed(plan, shares, tmp_path).requirement.tolerance for _ in range(2)]
    assert tolerances == pytest.approx([0.0125, 0.003125])
    answered(plan, {**BELOW, 3: 0.5}, tmp_path / "clear")
    clear = resumed(plan, {**BELOW, 3: 0.5}, tmp_path / "clear")
    assert clear.runs_to_decide is None
    again = resumed(plan, {**BELOW, 3: 0.5}, tmp_path / "clear")
    assert again.runs == clear.runs
    assert len(again.questions) == len(clear.questions)


def test_without_a_certified_team_those_that_may_meet_it_are_named(
    classic_toml: Path, tmp_path: Path
) -> None:
    shares = {**dict.fromkeys(range(1, 6), 0.2), 6: 0.9}
    plan = plan_of(classic_toml)
    answer = answered(plan, shares, tmp_path)
    assert answer.selected is None
    assert "6 wanderers (" in answer.verdict[2]
    assert " may meet it; about " in answer.verdict[2]


def test_the_table_shows_the_closest_teams_if_none_is_certified(
    classic_toml: Path, tmp_path: Path
) -> None:
    scenario = required(classic_toml, vary="1..30")
    shares = {size: 0.8 if size == 5 else 0.1 for size in range(1, 31)}
    answer = answered(study.make_plan(scenario), shares, tmp_path)
    assert answer.selected is None
    assert 4 in [answer.results.index(each) for each in answer.foremost(20)]


def test_teams_of_one_cost_are_equally_cheap_whatever_the_rounding(classic_toml: Path) -> None:
    scenario = required(classic_toml).replace("study.minimize", "0.1 * wanderer + 0.2")
    plan = study.make_plan(scenario)
    costs = teams.costs(plan.engine, scenario.cost)
    assert costs.tolist() == [0.3, 0.4, 0.5, 0.6, 0.7, 0.8]


@pytest.mark.parametrize("tolerance", [0.1, 0.1 - 1e-13])
def test_probability_and_tolerance_must_be_below_one_together(
    classic_toml: Path, tolerance: float
) -> None:
    scenario = required(classic_toml).replace("require.tolerance", tolerance)
    with pytest.raises(InputError, match=r"require.tolerance = 0.1: must be below 0.1"):
        study.make_plan(scenario)


def test_a_finished_study_with_a_tolerance_up_to_one_stays_readable(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = plan_of(classic_toml)
    assert isinstance(plan.question, Cheapest)
    wide = replace(plan.question.requirement, tolerance=0.1)
    scenario = plan.scenario.replace("require.tolerance", 0.1)
    old = replace(plan, scenario=scenario, question=replace(plan.question, requirement=wide))
    shares = dict.fromkeys(range(1, 7), 1.0)
    study.run_plan(old, tmp_path, compute=simulated(plan, shares))
    answer = study.rebuild(tmp_path)
    assert isinstance(answer, RequirementAnswer)
    assert answer.selected == 0


def test_deciding_needs_a_requirement(classic_toml: Path) -> None:
    text = classic_toml.read_text("utf-8")
    with pytest.raises(InputError, match="decide: needs a requirement"):
        decided(study.make_plan(Scenario.loads(text)))
    with pytest.raises(InputError, match="max_runs = 5: must be"):
        decided(plan_of(classic_toml), max_runs=5)


PRICED = """
engine = "metric"
summary = "Teams of two kinds."
merit = "equation-5.2"
clock.time_limit_s = 5
world.size_m = [10, 10]
items.box.count = 1
[robots.scout]
count = 1
radius_m = 0.3
sensors.eye = { kind = "items", range_m = 2 }
drive.max_speed_m_s = 1
[robots.alpha]
count = 1
radius_m = 0.3
sensors.eye = { kind = "items", range_m = 2 }
drive.max_speed_m_s = 2
[require]
all = ["time_s <= 4"]
probability = 0.6
[study]
minimize = "price"
vary = { "robots.scout.count" = "0..2", "robots.alpha.count" = "0..2" }
"""


@pytest.mark.parametrize(
    ("changes", "lacking"),
    [
        ({}, "robots.alpha, robots.scout"),
        ({"robots.alpha.price": 5}, "robots.scout"),
        ({"robots.alpha.price": 0, "robots.scout.price": 3}, None),
        ({"robots.alpha.price": 5, "study.vary.robots.scout.count": "0"}, None),
        ({"robots.alpha.price": 5, "study.minimize": "2 * robots + price"}, "robots.scout"),
        ({"study.minimize": "robots"}, None),
    ],
)
def test_a_cost_of_prices_needs_the_price_of_each_kind(
    changes: dict[str, Any], lacking: str | None
) -> None:
    scenario = Scenario.loads(PRICED)
    for path, value in changes.items():
        scenario = scenario.replace(path, value)
    if lacking is None:
        study.make_plan(scenario)
        return
    with pytest.raises(InputError, match=rf": {lacking} must have a price \(0 if it costs"):
        study.make_plan(scenario)


def test_the_command_decides_a_finished_study_and_names_what_is_left(tmp_path: Path) -> None:
    out = tmp_path / "study"
    question = ["--require", "time_s <= 60", "--probability", "0.9", "--tolerance", "0.04"]
    first = succeed("study", "classic", *question, "--out", out).stdout
    assert "may meet it as well" in " ".join(first.split())
    second = succeed("study", "--resume", out, "--decide", "--max-runs", "5000").stdout
    assert "shares from 90% to 91% are not distinguished" in second
    assert "2 questions were answered from these runs." in second
    assert "--max-runs" in refuse("study", "--resume", out, "--max-runs", "5000")
    error = refuse("study", "classic", "--decide", "--out", tmp_path / "merit")
    assert "decide: needs a requirement" in error

"""Studies of a requirement: the cheapest team that meets it."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from requirement_study import (
    RISING,
    TEAM,
    answered,
    required,
    simulated,
)

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.scenario import Condition, Override, Requirement
from agent_economy.study import RequirementAnswer, report
from agent_economy.study.plan import Plan


def test_the_smallest_team_that_meets_the_requirement_is_selected(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = study.make_plan(required(classic_toml))
    answer = answered(plan, RISING, tmp_path)
    statuses = [each.status for each in answer.results[:4]]
    assert statuses == ["refuted", "refuted", "may meet", "selected"]
    assert answer.selected == 3
    assert answer.is_guaranteed
    assert answer.sentence.startswith(
        "Send 4 wanderers: success within 50 s in at least 90% of missions (95% confidence). "
        "3 wanderers (60.0% of 15 did) may meet it as well; about 6 more runs would decide "
        "(--decide). 2 wanderers, and 1 other: met in fewer than 95% of missions."
    )
    # Those that are dearer take few runs.
    assert sum(each.runs for each in answer.results[4:]) < 0.2 * answer.runs
    met = answer.results[3].met
    assert met is not None
    assert met.low <= 0.98 <= met.high


def test_a_team_that_fails_often_is_never_recommended(classic_toml: Path, tmp_path: Path) -> None:
    plan = study.make_plan(required(classic_toml))
    answer = answered(plan, dict.fromkeys(range(1, 7), 0.5), tmp_path)
    assert answer.selected is None
    assert answer.sentence.startswith("No team is certified: success within 50 s in at least 90%")
    assert "The condition that fails most often there: time_s <= 50, in" in answer.sentence
    assert "no compared team meets the requirement in 95% or more" in answer.guarantee


def test_more_robots_are_not_assumed_to_be_better(classic_toml: Path, tmp_path: Path) -> None:
    plan = study.make_plan(required(classic_toml))
    shares = {1: 0.3, 2: 0.99, 3: 0.2, 4: 0.9, 5: 0.99, 6: 0.1}
    assert answered(plan, shares, tmp_path).selected == 1


def test_a_cost_can_turn_the_order_round(classic_toml: Path, tmp_path: Path) -> None:
    scenario = required(classic_toml).replace("study.minimize", "10 - wanderer")
    answer = answered(study.make_plan(scenario), RISING, tmp_path)
    assert answer.selected == 5
    assert answer.results[5].cost == 4


def test_only_the_allowed_combinations_are_compared(classic_toml: Path) -> None:
    scenario = required(classic_toml).replace("study.where", "wanderer == 1 or wanderer > 4")
    plan = study.make_plan(scenario)
    assert [each[TEAM] for each in plan.configurations] == [1, 5, 6]


def test_resumed_and_rebuilt_studies_have_the_same_bytes(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = study.make_plan(required(classic_toml))
    compute = simulated(plan, RISING)

    def stop(progress: study.Progress) -> None:
        if progress.round == 5:
            raise KeyboardInterrupt

    study.run_plan(plan, tmp_path / "whole", compute=compute)
    with pytest.raises(KeyboardInterrupt):
        study.run_plan(plan, tmp_path / "stopped", compute=compute, on_progress=stop)
    study.resume(tmp_path / "stopped", compute=compute)
    for name in ("answer.json", "report.html", "study.toml"):
        whole = (tmp_path / "whole" / name).read_bytes()
        assert (tmp_path / "stopped" / name).read_bytes() == whole
    assert (
        study.rebuild(tmp_path / "whole").sentence
        == study.load_answer(tmp_path / "whole")[0].sentence
    )


def test_runs_of_a_study_of_merit_serve_one_of_a_requirement_and_the_other_way_round(
    classic_toml: Path, tmp_path: Path
) -> None:
    vary = "3..5"
    loose = '[require]\nall = ["time_s <= 100"]\nprobability = 0.6\ntolerance = 0.2\n'
    merit = study.make_plan(required(classic_toml, "", vary), delta=0.3)
    requirement = study.make_plan(required(classic_toml, loose, vary))
    for first, second in ((merit, requirement), (requirement, merit)):
        folder = tmp_path / type(first.question).__name__
        fresh = tmp_path / f"fresh-{folder.name}"
        study.run_plan(first, folder)
        assert computed(second, folder) < computed(second, fresh)
        one, other = (json.loads((each / "answer.json").read_text()) for each in (folder, fresh))
        assert len(one.pop("questions")) == 2
        assert one == other


def computed(plan: Plan, folder: Path) -> int:
    """Run a study, and return how many runs it computed."""
    seen: list[int] = []
    study.run_plan(plan, folder, on_progress=lambda progress: seen.append(progress.computed))
    return seen[-1]


def test_the_time_of_a_mission_without_success_is_infinite() -> None:
    condition = Condition("time_s <= 120", "time_s", "<=", 120.0)
    columns = {"time_s": np.array([10.0, 120.0, 120.0]), "failed": np.array([0.0, 0.0, 1.0])}
    assert condition.holds(columns).tolist() == [True, True, False]


def test_a_quarantined_run_meets_no_condition() -> None:
    conditions = tuple(
        Condition(f"found {comparison} 1", "found", comparison, 1.0) for comparison in ("!=", ">=")
    )
    columns = {"found": np.array([np.nan, 2.0])}
    assert [each.holds(columns)[0] for each in conditions] == [False, False]
    requirement = Requirement(conditions, 0.9, 0.05)
    assert np.isnan(requirement.met(columns)[0])
    assert requirement.met(columns)[1] == 1


def test_the_report_shows_shares_conditions_and_the_distribution(
    classic_toml: Path, tmp_path: Path
) -> None:
    answer = answered(study.make_plan(required(classic_toml)), RISING, tmp_path)
    _, evidence = study.load_answer(tmp_path)
    parts = report.parts(answer, evidence)
    assert [each.heading for each in parts.sections] == [
        "Missions that meet the requirement",
        "Why missions failed",
        "The deciding condition",
    ]
    assert parts.charts.keys() == {"share", "failing", "distribution"}
    rows = parts.charts["share"]["data"]["values"]
    statuses = [row["status"] for row in rows[:4]]
    assert statuses == ["refuted", "refuted", "may meet", "selected"]
    assert json.loads((tmp_path / "answer.json").read_text("utf-8"))["selected"] == 3


def test_a_hopeless_team_does_not_squeeze_the_shares_of_the_contenders(
    classic_toml: Path, tmp_path: Path
) -> None:
    shares = {**RISING, 1: 0.02, 3: 0.88}
    answer = answered(study.make_plan(required(classic_toml)), shares, tmp_path)
    assert sorted(answer.contenders)[:2] == [2, 3]
    _, evidence = study.load_answer(tmp_path)
    chart = report.parts(answer, evidence).charts["share"]
    lowest = chart["layer"][0]["encoding"]["x"]["scale"]["domainMin"]["expr"]
    everything, near = map(float, lowest.removeprefix("all_teams ? ").split(" : "))
    hopeless = answer.results[0].met
    assert hopeless is not None
    assert everything <= hopeless.low <= hopeless.value < near


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"require.all": ["tyme_s <= 5"]}, 'did you mean "time_s <= 5"'),
        ({"require.all": ["time_s is 5"]}, "expected an operator"),
        ({"require.all": []}, "a list of 1 to 20 conditions"),
        ({"require.probability": 1}, "a share of missions above 0 and below 1"),
        ({"require.tolerance": 0.2}, "below 0.1, which is 1 - probability"),
        ({"study.minimize": "wanderers"}, "did you mean 'wanderer'"),
        ({"study.minimize": "__import__('os')"}, "is not allowed"),
        ({"study.minimize": "1 / (wanderer - 1)"}, "must not divide by zero"),
        ({"study.where": "wanderer > 99"}, "allows none of 6 configurations"),
        ({"study.minimize": "price"}, "has no prices"),
        ({"require.all": ["time_s <= 500"], "require.probability": 2}, "a share of missions"),
        ({"require.all": ["robots >= 7"]}, "never holds"),
        ({"require.all": ["robots <= 8"]}, "always holds"),
    ],
)
def test_a_wrong_requirement_is_refused_with_the_fix(
    classic_toml: Path, change: dict[str, Any], error: str
) -> None:
    changes = tuple(Override.at(path, value, "test") for path, value in change.items())
    scenario = required(classic_toml)
    with pytest.raises(InputError, match=re.escape(error)):
        study.make_plan(scenario.changed(changes))


def test_asking_for_the_best_by_merit_is_still_possible(classic_toml: Path) -> None:
    plan = study.make_plan(required(classic_toml), delta=0.3)
    assert type(plan.question).__name__ == "Best"


def test_run_takes_names_conditions_and_weights() -> None:
    options: dict[str, Any] = {"vary": {TEAM: [3, 8]}, "only_vary": True}
    answer = study.run("classic", require="time_s <= 100", probability=0.5, **options)
    assert isinstance(answer, RequirementAnswer)
    assert answer.requirement.probability == 0.5
    assert repr(answer).startswith("RequirementAnswer('Send 3 wanderers. Success within 100 s in")
    assert "<b>Send 3 wanderers.</b>" in answer._repr_html_()
    best = study.run("classic", merit="failed=-1", runs=20, **options)
    assert isinstance(best, study.Answer)
    assert best.scenario.merit.name == "failed=-1"
    assert "Varied: robots.wanderer.count = 3, 8." in repr(best.scenario)


def test_only_vary_leaves_out_the_factors_of_the_scenario(classic_toml: Path) -> None:
    scenario = required(classic_toml).replace("study.vary.clock.paints_per_s", "40,50")
    assert len(study.make_plan(scenario).configurations) == 12
    only = study.run(scenario, vary={TEAM: "3..4"}, only_vary=True, runs=2)
    assert len(only.results) == 2

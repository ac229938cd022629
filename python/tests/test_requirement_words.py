"""What answers about a requirement state, and what they do not."""

import json
import math
import signal
import subprocess
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import COMMAND
from requirement_study import RISING, answered, quarantined, required, simulated

from agent_economy import InputError, study
from agent_economy.runs import quarantine
from agent_economy.scenario import Condition, Requirement, Scenario
from agent_economy.study import RequirementAnswer
from agent_economy.study.answer.condition_words import in_words
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.quantiles import Quantile
from agent_economy.study.answer.requirement_results import RequirementEnding, RequirementResult
from agent_economy.study.answer.requirement_words import RequirementWords, seen
from agent_economy.study.answer.verdict import repeated
from agent_economy.study.api import answer_so_far
from agent_economy.study.plan import Plan
from agent_economy.study.report.tables import bounds_of
from agent_economy.study.run_block import Columns, RunBlock

ROVERS = "robots.rover.count"


def test_a_stopped_study_claims_only_what_is_certified(classic_toml: Path, tmp_path: Path) -> None:
    # A team that lies exactly between the limits takes the larger part of the budget.
    scenario = required(classic_toml, vary="3,6").replace("require.tolerance", 0.02)
    plan = study.make_plan(scenario, max_runs=800)
    answer = answered(plan, {3: 0.91, 6: 1.0}, tmp_path)
    assert [each.status for each in answer.results] == ["open", "selected"]
    assert not answer.is_guaranteed
    assert "Cheaper teams that are not decided may meet it as well." in answer.guarantee
    assert "3 wanderers: not decided" in answer.sentence


def test_the_errors_of_questions_with_different_confidences_add_up(
    classic_toml: Path, tmp_path: Path
) -> None:
    scenario = required(classic_toml)
    for confidence in (0.6, 0.99):
        plan = study.make_plan(scenario, confidence=confidence)
        answer = answered(plan, RISING, tmp_path)
    assert [each.confidence for each in answer.questions] == [0.6, 0.99]
    assert "together hold with a probability of at least 59% only" in repeated(answer.questions)
    assert "at least 59% only" in (tmp_path / "report.html").read_text("utf-8")
    raised = study.resume(tmp_path, confidence=0.995, compute=simulated(plan, RISING))
    assert "at least 58.5% only" in repeated(raised.questions)


@pytest.mark.parametrize("vary", ["4..6", "4"])
def test_the_promise_covers_compared_teams_only(
    classic_toml: Path, tmp_path: Path, vary: str
) -> None:
    answer = answered(study.make_plan(required(classic_toml, vary=vary)), RISING, tmp_path)
    assert "no compared team with fewer robots meets it" in answer.guarantee
    assert answer.verdict[2] == "No compared team is cheaper."
    assert answer.sentence.endswith(
        "No team with fewer robots was compared; one may meet it as well."
    )
    one = answered(
        study.make_plan(required(classic_toml)), dict.fromkeys(RISING, 1.0), tmp_path / "all"
    )
    assert "was compared" not in one.sentence


@pytest.mark.parametrize(
    ("cost", "words"),
    [
        ("robots ", "no compared team with fewer robots"),
        ("2 * wanderer", "no compared team of a lower cost (2 * wanderer)"),
    ],
)
def test_the_promise_names_what_is_minimised(
    classic_toml: Path, tmp_path: Path, cost: str, words: str
) -> None:
    scenario = required(classic_toml).replace("study.minimize", cost)
    answer = answered(study.make_plan(scenario), RISING, tmp_path)
    assert f"and {words} meets it in 95% or more." in answer.guarantee


def test_teams_that_cannot_be_run_are_named_with_the_reason(
    classic_toml: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(quarantine, "reason", lambda *_: "no room")
    plan = study.make_plan(required(classic_toml))
    compute = quarantined(simulated(plan, RISING), lambda size, _: size < 3)
    answer = study.run_plan(plan, tmp_path, compute=compute)
    assert isinstance(answer, RequirementAnswer)
    assert [each.status for each in answer.results[:4]] == [
        *["impossible"] * 2,
        "may meet",
        "selected",
    ]
    assert "2 wanderers; 1 wanderer: cannot be run (no room)." in answer.verdict[2]
    assert "no compared team with fewer robots meets it" in answer.guarantee


def test_a_stopped_study_is_answered_from_its_stored_runs(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = study.make_plan(required(classic_toml, vary="3,6").replace("require.tolerance", 0.01))
    compute = simulated(plan, {3: 0.905, 6: 1.0})

    def stop(progress: study.Progress) -> None:
        if progress.runs > 900:
            raise KeyboardInterrupt

    assert answer_so_far_of(plan, tmp_path / "none") is None
    with pytest.raises(KeyboardInterrupt):
        study.run_plan(plan, tmp_path, compute=compute, on_progress=stop)
    answer = answer_so_far(tmp_path)
    assert isinstance(answer, RequirementAnswer)
    assert [each.status for each in answer.results] == ["open", "selected"]
    assert not answer.is_guaranteed
    assert not (tmp_path / "answer.json").exists()
    with pytest.raises(InputError, match="is not finished"):
        study.rebuild(tmp_path)
    # Its promise counts when another question is answered from the same runs.
    more = study.run_plan(replace(plan, confidence=0.6), tmp_path, compute=compute)
    assert [each.confidence for each in more.questions] == [0.95, 0.6]


def answer_so_far_of(plan: Plan, folder: Path) -> study.AnyAnswer | None:
    """Stop a study before its first run, and return its answer."""

    def stop(_: RunBlock) -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.run_plan(plan, folder, compute=stop)
    return answer_so_far(folder)


def test_ctrl_c_prints_what_is_certified_and_how_to_resume(tmp_path: Path) -> None:
    options = ["--require", "time_s <= 110", "--probability", "0.6", "--tolerance", "0.0005"]
    process = subprocess.Popen(
        [*COMMAND, "study", "search", *options, "--vary", f"{ROVERS}=1..9", "--out", tmp_path],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        while len(list(tmp_path.glob("blocks/*"))) < 12 and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        printed, errors = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 130
    assert f"agent-economy study --resume {tmp_path}" in errors
    assert "Stopped early" in printed
    assert "Report:" not in printed
    assert not (tmp_path / "answer.json").exists()


@pytest.mark.parametrize(
    ("column", "comparison", "value", "words"),
    [
        ("failed", "==", 0, "success"),
        ("failed", "<", 0.5, "success"),
        ("failed", ">", 0.5, "`written`"),
        ("time_s", "<=", 1200, "success within 20 minutes"),
        ("time_s", "<", 90, "success in less than 90 s"),
        ("time_s", ">=", 30, "`written`"),
        ("found_parcel_9_s", "<=", 1200, "9 parcels found within 20 minutes"),
        ("found_lost_key_1_s", "<", 40, "1 lost key found in less than 40 s"),
        ("found_parcel_9_s", ">=", 1200, "`written`"),
        ("found_parcel", ">=", 3, "at least 3 parcels found"),
        ("missed", "<=", 0, "no targets missed"),
        ("missed_parcel", "<=", 1, "at most 1 parcel missed"),
        ("collisions", "<=", 1, "at most 1 collision"),
        ("collisions", "<", 3, "fewer than 3 collisions"),
        ("collisions", "<=", 2.5, "`written`"),
        ("robots_stopped", "==", 0, "no robots stopped"),
        ("false_alarms", "<=", 5000, "at most 5,000 false alarms"),
        ("energy_j", "<=", 5000, "at most 5,000 J of energy"),
        ("distance_m", ">=", 40, "at least 40 m driven"),
        ("price", "<=", 300, "a price of at most 300"),
        ("paints", "<=", 300, "`written`"),
    ],
)
def test_conditions_can_be_read_aloud_or_are_quoted_as_code(
    column: str, comparison: str, value: float, words: str
) -> None:
    assert in_words(Condition("written", column, comparison, float(value))) == words


def test_a_stopped_study_states_nothing_that_it_does_not_guarantee(
    classic_toml: Path, tmp_path: Path
) -> None:
    shares = {1: 0.0, 2: 0.5, 3: 0.91, 4: 1.0, 5: 1.0, 6: 1.0}
    plan = study.make_plan(required(classic_toml).replace("require.tolerance", 0.01), max_runs=900)
    answer = answered(plan, shares, tmp_path / "some")
    confidently = (
        "Stopped early: only that the selected team meets it is guaranteed (95% confidence)."
    )
    assert answer.verdict[2:] == (
        "2 wanderers, and 1 other: refuted so far, without a guarantee. 3 wanderers: not decided.",
        confidently,
    )
    none = answered(replace(plan, max_runs=30), shares, tmp_path / "none")
    assert none.guarantee.startswith("No guarantee: the study was stopped")
    assert none.verdict[0] == "Stopped before a team was certified."
    assert none.verdict[1].startswith("Best so far: ")
    assert none.verdict[3] == "Stopped early: nothing is guaranteed."
    few = answered(replace(plan, max_runs=10), shares, tmp_path / "few")
    assert few.verdict[1].startswith("No run met it. The condition that fails most often: time_s")


def test_a_share_below_one_is_never_printed_as_all(classic_toml: Path) -> None:
    requirement = required(classic_toml).requirement
    assert requirement is not None

    def words(met: int, runs: int, probability: float) -> str:
        shown = Interval(met / runs, 0, 1)
        result = RequirementResult(
            {}, "", 1, 1, runs, 0, "selected", shown, failing=(), quantiles=()
        )
        return seen(result, replace(requirement, probability=probability)).strip(" ()")

    assert words(153, 154, 0.95) == "99.4% of 154 did"
    assert words(154, 154, 0.95) == "all of 154 did"
    assert words(4999, 5000, 0.95) == "4,999 of 5,000 did"
    assert words(4999, 5000, 0.999) == "99.98% of 5,000 did"


def test_a_condition_that_never_failed_is_not_the_one_that_fails_most_often(
    classic_toml: Path, tmp_path: Path
) -> None:
    plan = study.make_plan(required(classic_toml), max_runs=10)
    answer = answered(plan, dict.fromkeys(RISING, 1.0), tmp_path)
    assert answer.chosen is None
    assert answer.verdict[1].startswith("Best so far: ")
    assert answer.verdict[1].endswith(", met in 100.0% of missions (43.4% to 100.0%).")
    report = (tmp_path / "report.html").read_text("utf-8")
    for text in (*answer.verdict, answer.sentence, report):
        assert "fails most often" not in text
    assert "No mission of these teams failed a condition." in report


def of_one_team(requirement: Requirement, runs: int, fails: int) -> RequirementWords:
    """Return the words about a team of which some runs fail the first condition."""
    share = fails / runs
    met = Interval(1 - share, max(0.0, 0.9999 - share), min(1.0, 1.0001 - share))
    result = RequirementResult(
        {}, "1 team", 1, 1, runs, 0, "open", met, failing=(share,), quantiles=()
    )
    ending = RequirementEnding(
        np.ones(1), None, frozenset(), frozenset(), frozenset(), is_over=False, is_finest=False
    )
    return RequirementWords(requirement, "robots", [result], 0.95, ending, None)


@pytest.mark.parametrize(
    ("fails", "met", "failed"),
    [
        (1, "met in 19,999 of 20,000 missions (99.98% to 100.0%).", "in 1 of 20,000 missions."),
        (600, "met in 97.0% of missions (97.0% to 97.0%).", "in 3.0% of missions."),
        (19_999, "met in 1 of 20,000 missions (0.0% to 0.01%).", "in 19,999 of 20,000 missions."),
    ],
)
def test_a_share_that_would_be_rounded_to_none_or_all_is_stated_as_a_count(
    classic_toml: Path, fails: int, met: str, failed: str
) -> None:
    requirement = required(classic_toml).requirement
    assert requirement is not None
    stated = of_one_team(requirement, 20_000, fails).verdict()[1]
    assert met in stated
    assert stated.endswith(f"fails most often there: time_s <= 50, {failed}")


def test_quarantined_runs_fail_every_condition_and_are_not_values(
    classic_toml: Path, tmp_path: Path
) -> None:
    require = '[require]\nall = ["found >= 0.5", "time_s >= 5"]\nprobability = 0.5\n'
    plan = study.make_plan(required(classic_toml, require, vary="4"))

    def found_once(block: RunBlock) -> Columns:
        columns: Columns = simulated(plan, dict.fromkeys(RISING, 1.0))(block)
        return {**columns, "found": columns["time_s"] / 10}

    compute = quarantined(found_once, lambda _, run: run % 3 == 0)
    answer = study.run_plan(plan, tmp_path, compute=compute)
    assert isinstance(answer, RequirementAnswer)
    (result,) = answer.results
    share = result.quarantined / result.runs
    assert 0.3 < share < 0.4
    assert result.failing == pytest.approx((share, share))
    found, time_s = result.quantiles
    assert [each.value for each in found.quantiles] == [1, 1, 1]
    assert found.never == 0
    assert time_s.never == pytest.approx(share)
    assert [each.value for each in time_s.quantiles] == [10, math.inf, math.inf]


def test_quantiles_that_are_never_reached_differ_from_unknown_ones(tmp_path: Path) -> None:
    require: dict[str, Any] = {"require": "time_s <= 20", "probability": 0.5}
    answer = study.run("search", **require, vary={ROVERS: "1"}, only_vary=True, out=tmp_path)
    stored = json.loads((tmp_path / "answer.json").read_text("utf-8"))
    assert isinstance(answer, RequirementAnswer)
    quantile = stored["results"][0]["quantiles"][0]["quantiles"][2]
    assert (quantile["value"], quantile["high"]) == ("inf", "inf")
    cases = [(None, 60.0), (None, math.inf), (40.0, math.inf), (math.inf, math.inf), (1.0, 2.0)]
    assert [bounds_of(Quantile(0.5, 50, *case), 0) for case in cases] == [
        "up to 60",
        "unknown",
        "40 to never",
        "never",
        "1 to 2",
    ]


def test_another_end_in_the_same_folder_is_refused_by_its_name(
    classic_toml: Path, tmp_path: Path
) -> None:
    end = '[end]\nwhen = "found_mine >= 3"\n'
    search = (classic_toml.parent / "search.toml").read_text("utf-8")
    one = Scenario.loads(search + end).replace("robots.rover.count", 2)
    other = one.replace("end.when", "found_mine >= 2").replace("require.all", ["time_s <= 90"])
    options: dict[str, Any] = {"vary": {ROVERS: "1"}, "only_vary": True, "out": tmp_path}
    study.run(one, **options, runs=2)
    with pytest.raises(InputError) as caught:
        study.run(other, **options)
    assert str(caught.value).splitlines()[1:] == [
        "  existing: runs = 2",
        "  requested: no runs",
        "  existing: end.when = 'found_mine >= 3'",
        "  requested: end.when = 'found_mine >= 2'",
    ]

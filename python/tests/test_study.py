"""Studies from the question to the answer, through the Python API."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_study
import synthetic_runs

import agent_economy as ae
from agent_economy import InputError, Scenario, study
from agent_economy.build import own_build
from agent_economy.study import files, race
from agent_economy.study.answer.any_answer import expect_best
from agent_economy.study.chunks import MIN_ROWS, in_chunks
from agent_economy.study.questions.best import Best
from agent_economy.study.run_block import RunBlock

TEAM = "robots.wanderer.count"


@pytest.fixture
def scenario(classic_toml: Path) -> Scenario:
    """Return the 2003 experiment."""
    return Scenario.load(classic_toml)


def test_forty_teams_are_decided_in_a_few_thousand_runs(scenario: Scenario) -> None:
    answer = expect_best(study.run(scenario, vary={TEAM: ["1..40"]}, delta=0.1))
    assert answer.results[answer.best].values[TEAM] in {4, 5}
    assert answer.runs < 8000
    assert "with 95% confidence" in answer.guarantee
    assert answer.sentence.startswith(f"Send {answer.results[answer.best].label}. ")


def test_the_default_delta_is_two_percent_of_the_range_of_merits(scenario: Scenario) -> None:
    plan = study.make_plan(scenario.replace("study.delta", 0.3))
    assert plan.question == Best(0.3, "indifference")
    text = scenario.source.text.replace("delta = 0.01", "")
    # From -0.2 (one robot, immediately) to -10.2 (eight robots, 120 s, failed).
    question = study.make_plan(Scenario.loads(text)).question
    assert isinstance(question, Best)
    assert question.delta == pytest.approx(0.02 * 10)


def test_the_same_question_again_computes_nothing(scenario: Scenario, tmp_path: Path) -> None:
    first = study.run(scenario, delta=0.2, out=tmp_path)
    before = (tmp_path / "answer.json").read_bytes()
    seen: list[study.Progress] = []
    again = study.run(scenario, delta=0.2, out=tmp_path, on_progress=seen.append)
    assert again.sentence == first.sentence
    assert {now.computed for now in seen} == {0}
    assert (tmp_path / "answer.json").read_bytes() == before
    assert study.rebuild(tmp_path).runs == first.runs


def test_a_stopped_study_continues_to_the_same_bytes(scenario: Scenario, tmp_path: Path) -> None:
    def stop(now: study.Progress) -> None:
        if now.round == 5:
            raise KeyboardInterrupt

    study.run(scenario, delta=0.2, out=tmp_path / "whole")
    with pytest.raises(KeyboardInterrupt):
        study.run(scenario, delta=0.2, out=tmp_path / "stopped", on_progress=stop)
    with pytest.raises(InputError, match="is not finished"):
        study.rebuild(tmp_path / "stopped")
    study.resume(tmp_path / "stopped")
    for name in ("answer.json", "study.toml"):
        whole = (tmp_path / "whole" / name).read_bytes()
        assert (tmp_path / "stopped" / name).read_bytes() == whole


def test_a_study_resumed_at_a_higher_confidence_equals_a_new_one(
    scenario: Scenario, tmp_path: Path
) -> None:
    study.run(scenario, delta=0.2, out=tmp_path / "more")
    seen: list[study.Progress] = []
    more = study.resume(tmp_path / "more", confidence=0.999, on_progress=seen.append)
    fresh = study.run(scenario, delta=0.2, confidence=0.999, out=tmp_path / "fresh")
    with pytest.raises(InputError, match="confidence = 0.6: must be above the study's 0.999"):
        study.resume(tmp_path / "more", confidence=0.6)
    assert len(more.questions) == 2
    assert files.as_json(replace(more, questions=())) == files.as_json(fresh)
    assert 0 < seen[-1].computed < fresh.runs


def test_another_delta_uses_the_stored_runs(scenario: Scenario, tmp_path: Path) -> None:
    study.run(scenario, delta=0.1, out=tmp_path)
    seen: list[study.Progress] = []
    study.run(scenario, delta=0.2, out=tmp_path, on_progress=seen.append)
    assert seen[-1].computed == 0


def test_another_merit_uses_the_stored_runs(scenario: Scenario, tmp_path: Path) -> None:
    study.run(scenario, delta=0.1, out=tmp_path)
    seen: list[study.Progress] = []
    scenario = scenario.replace("merit", {"time": -0.03, "robots": -0.2, "failed": -4})
    other = expect_best(study.run(scenario, delta=0.4, out=tmp_path, on_progress=seen.append))
    assert seen[-1].computed == 0
    assert other.results[0].merit.value > -4.5


def test_the_strict_guarantee_can_be_selected_and_is_stated(
    scenario: Scenario, tmp_path: Path
) -> None:
    answer = expect_best(study.run(scenario, delta=0.2, guarantee="pgs", out=tmp_path))
    assert answer.guarantee == (
        "The selected configuration is within 0.2 of the best with 95% confidence."
    )
    assert study.rebuild(tmp_path).sentence == answer.sentence


def test_a_study_that_reaches_its_budget_has_no_guarantee(
    scenario: Scenario, tmp_path: Path
) -> None:
    answer = expect_best(study.run(scenario, delta=0.001, max_runs=900, out=tmp_path))
    assert answer.runs <= 900
    assert not answer.is_guaranteed
    assert answer.guarantee.startswith("No guarantee")
    assert study.rebuild(tmp_path).runs == answer.runs
    assert study.open(tmp_path).decisions()[-1].facts["is_over"]
    with pytest.raises(InputError, match="max_runs = 79: must be a whole number of 80 or more"):
        study.run(scenario, max_runs=79)


def test_runs_of_another_version_are_not_mixed_in(
    scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study.run(scenario, delta=0.3, out=tmp_path)
    later = own_build()._replace(program="99.0")
    monkeypatch.setattr("agent_economy.study.plan.own_build", lambda: later)
    with pytest.raises(InputError, match="contains another study"):
        study.run(scenario, delta=0.3, out=tmp_path)


@pytest.mark.parametrize(
    ("there", "edited"),
    [('contact = \\"touch', 'contact = \\"ahead'), ('seed = "0"', 'seed = "5"')],
)
def test_a_study_toml_edited_for_other_runs_is_rejected(
    there: str, edited: str, scenario: Scenario, tmp_path: Path
) -> None:
    study.run(scenario, delta=0.3, out=tmp_path)
    path = tmp_path / "study.toml"
    text = path.read_text()
    assert there in text
    path.write_text(text.replace(there, edited))
    for ask_again in (study.rebuild, study.resume):
        with pytest.raises(InputError, match=r"\[data\] was changed"):
            ask_again(tmp_path)


def test_values_may_be_a_string_or_numpy_numbers(scenario: Scenario, tmp_path: Path) -> None:
    options: Any = {"delta": np.float32(0.5), "seed": np.int64(0)}
    texts = study.run(scenario, vary={TEAM: "3..5"}, delta=0.5, out=tmp_path)
    numbers = study.run(scenario, vary={TEAM: range(3, 6)}, out=tmp_path, **options)
    assert files.as_json(texts) == files.as_json(numbers)


def test_a_study_toml_must_be_text(scenario: Scenario, tmp_path: Path) -> None:
    study.run(scenario, delta=0.5, out=tmp_path)
    (tmp_path / "study.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        study.resume(tmp_path)


@pytest.mark.parametrize(
    "change", [{"seed": 1}, {"runs": 20}, {"vary": {TEAM: ["1..3"]}}], ids=["seed", "runs", "vary"]
)
def test_a_folder_with_other_runs_is_rejected(
    change: dict[str, Any], scenario: Scenario, tmp_path: Path
) -> None:
    study.run(scenario, delta=0.3, out=tmp_path)
    with pytest.raises(InputError, match="contains another study"):
        study.run(scenario, delta=0.3, out=tmp_path, **change)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"delta": 0.0}, "delta = 0.0: must be a number above 0"),
        ({"confidence": 1.5}, "confidence = 1.5: must be a number from 0.5 to below 1"),
        ({"guarantee": "sure"}, "guarantee = 'sure': must be one of"),
        ({"seed": -1}, "seed = -1: must be"),
        ({"runs": 1}, "runs = 1: must be a whole number from 2"),
        ({"design": "grid"}, "must be"),
        ({"vary": {"robots.rover.count": [1]}}, "did you mean robots.wanderer.count?"),
    ],
)
def test_invalid_questions_are_named(
    change: dict[str, Any], expected: str, scenario: Scenario
) -> None:
    with pytest.raises(InputError) as error:
        study.run(scenario, **change)
    assert expected in str(error.value)


def test_the_runs_can_be_queried_in_sql(scenario: Scenario, tmp_path: Path) -> None:
    answer = expect_best(study.run(scenario, delta=0.3, out=tmp_path))
    runs = study.open(tmp_path).runs()
    assert runs.count("*").fetchall() == [(answer.runs,)]
    means = runs.aggregate("configuration, avg(time_s) AS s").order("configuration").fetchall()
    for (_, mean_s), result in zip(means, answer.results, strict=True):
        assert mean_s == pytest.approx(result.time_s.value)


def test_a_run_of_a_study_equals_that_of_replicate(scenario: Scenario, tmp_path: Path) -> None:
    study.run(scenario, delta=0.3, seed=5, out=tmp_path)
    mine = study.open(tmp_path).runs().filter("configuration = 3").order("run").fetchnumpy()
    theirs = ae.replicate(scenario.replace(TEAM, 4), len(mine["run"]), seed=5)
    assert mine["collisions"].tolist() == theirs["collisions"].to_pylist()


def test_an_answer_contains_no_time_path_host_or_thread_count(
    scenario: Scenario, tmp_path: Path
) -> None:
    study.run(scenario, delta=0.3, out=tmp_path)
    text = (tmp_path / "answer.json").read_text()
    assert str(small_study.ROOT) not in text
    assert str(tmp_path) not in text
    stored = (tmp_path / "study.toml").read_text()
    assert str(small_study.ROOT) not in stored
    assert json.loads(text)["versions"].keys() >= {"agent-economy", "numpy", "python"}


def test_a_single_configuration_has_no_comparisons(scenario: Scenario) -> None:
    answer = expect_best(study.run(scenario, vary={TEAM: [4]}, runs=50))
    assert answer.best == 0
    assert answer.results[0].standing.verdict == "best"
    assert answer.results[0].standing.behind is None


def test_several_factors_are_compared_together(scenario: Scenario) -> None:
    vary: dict[str, Any] = {
        TEAM: ["1..6"],
        "contact": ["touch", "ahead", "within-2"],
        "clock.time_limit_s": [60, 120],
    }
    answer = expect_best(study.run(scenario, vary=vary, delta=0.5))
    assert len(answer.results) == 36
    assert answer.sensitivity is not None
    assert answer.omissions == ()
    assert {each.paths for each in answer.sensitivity.influences} == {(path,) for path in vary}
    shares = [each.with_interactions.value for each in answer.sensitivity.influences]
    assert shares == sorted(shares, reverse=True)
    assert files.as_json(study.run(scenario, vary=vary, delta=0.5)) == files.as_json(answer)
    assert " with " in answer.sentence


def test_space_filling_points_are_compared(scenario: Scenario) -> None:
    vary = {TEAM: ["1..20"], "clock.paints_per_s": ["41.0..57.0"]}
    answer = expect_best(study.run(scenario, vary=vary, design="lhs:40", delta=0.5))
    assert 30 < len(answer.results) <= 40
    rates = [result.values["clock.paints_per_s"] for result in answer.results]
    assert len(set(rates)) > 30


def test_merit_weights_decide_the_answer(scenario: Scenario) -> None:
    def best(merit: dict[str, Any]) -> object:
        answer = expect_best(study.run(scenario.replace("merit", merit), delta=0.2))
        return answer.results[answer.best].values[TEAM]

    assert best({"robots": -1}) == 1
    assert best({"time": -1}) == 8


def test_a_quarantined_run_counts_as_the_worst_and_is_reported(
    scenario: Scenario, tmp_path: Path
) -> None:
    plan = study.make_plan(scenario.replace(f"study.vary.{TEAM}", "3,4,5"), delta=0.3)

    def compute(block: Any) -> Any:
        columns = plan.engine(block)
        for row, configuration in enumerate(block.configurations):
            if configuration == 1:
                for values in columns.values():
                    values[row] = float("nan")
        return columns

    answer = expect_best(study.run_plan(plan, tmp_path, compute=compute))
    four = answer.results[1]
    assert answer.best != 1
    assert four.quarantined == four.runs > 0
    assert four.merit.value == pytest.approx(-9.4)
    assert four.failed.value == 1
    assert answer.results[0].quarantined == 0


def test_the_last_ranges_of_the_progress_are_those_of_the_answer(scenario: Scenario) -> None:
    seen: list[study.Progress] = []
    answer = expect_best(study.run(scenario, delta=0.5, on_progress=seen.append))
    ranged = seen[-1].intervals()
    assert len(ranged) == seen[-1].survivors
    for leader, merit in ranged:
        result = answer.results[leader.configuration]
        assert (leader.runs, merit) == (result.runs, result.merit)


def test_a_long_round_reports_its_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(race, "ROUND_S", 0.0)
    seen: list[study.Progress] = []
    left: list[tuple[float, float] | None] = []

    def look(now: study.Progress) -> None:
        seen.append(now)
        left.append(now.estimate_remaining())

    search = Scenario.load("search").replace("clock.time_limit_s", 5)
    vary = {"robots.rover.count": "1,2"}
    answer = expect_best(study.run(search, vary=vary, runs=60, on_progress=look))
    assert [each.round for each in seen] == [0] * (len(seen) - 1) + [1]
    assert len(seen) > 1
    runs = [each.runs for each in seen]
    assert runs == sorted(runs) == [each.computed for each in seen]
    assert 0 < runs[0] < runs[-1] == answer.runs == 120
    assert left == [(120 - each, 120 - each) for each in runs]
    assert seen[0].leaders == ()


def test_chunks_together_are_the_block() -> None:
    area = RunBlock(tuple(range(4)), 3, 1400)
    compute = in_chunks(synthetic_runs.slow_outcomes)
    assert synthetic_runs.same(compute(area), synthetic_runs.outcomes(area))
    rows = [part.rows for part, _ in in_chunks(synthetic_runs.slow_outcomes).parts(area)]
    assert sum(rows) == area.rows
    assert rows[0] <= MIN_ROWS


def test_a_new_question_removes_the_old_answer(scenario: Scenario, tmp_path: Path) -> None:
    def stop(_: study.Progress) -> None:
        raise KeyboardInterrupt

    study.run(scenario, delta=0.5, out=tmp_path)
    with pytest.raises(KeyboardInterrupt):
        study.run(scenario, delta=0.5, out=tmp_path, on_progress=stop)
    assert (tmp_path / "answer.json").exists()
    with pytest.raises(KeyboardInterrupt):
        study.resume(tmp_path, confidence=0.99, on_progress=stop)
    assert not (tmp_path / "answer.json").exists()
    assert not (tmp_path / "report.html").exists()


def written(folder: Path) -> dict[Path, int]:
    """Return the modification times of files, except the coordination files of SQLite."""
    own = [path for path in folder.rglob("*") if path.suffix not in (".sqlite-shm", ".sqlite-wal")]
    return {path: path.stat().st_mtime_ns for path in own if path.is_file()}


def test_loading_the_answer_of_a_finished_study_writes_nothing(
    scenario: Scenario, tmp_path: Path
) -> None:
    answer = expect_best(study.run(scenario, delta=0.5, out=tmp_path))
    before = written(tmp_path)
    found, evidence = study.load_answer(tmp_path)
    assert files.as_json(found) == files.as_json(answer)
    assert sum(sample.runs for sample in evidence.samples) == answer.runs
    assert written(tmp_path) == before
    (tmp_path / "ledger.sqlite").unlink()
    with pytest.raises(InputError, match="is not finished"):
        study.load_answer(tmp_path)


def test_errors_of_a_drive_are_factors_of_a_study(tmp_path: Path) -> None:
    search = Scenario.load("search").replace("clock.time_limit_s", 5)
    vary = {"robots.rover.drive.gain": "0.5,1", "robots.rover.drive.lag_s": "0,0.5"}
    study.run(search, vary=vary, only_vary=True, runs=2, out=tmp_path)
    runs = study.open(tmp_path).runs()
    means = dict(runs.aggregate("configuration, avg(distance_m)").fetchall())
    assert len(means) == 4
    plan = study.load_plan(tmp_path)
    drives = [plan.alone(each).to_dict()["robots"]["rover"]["drive"] for each in sorted(means)]
    by_errors = {(drive["gain"], drive["lag_s"]): means[each] for each, drive in enumerate(drives)}
    assert by_errors[0.5, 0] < by_errors[1, 0]
    assert by_errors[1, 0.5] < by_errors[1, 0]


def test_a_single_configuration_has_the_same_runs_as_in_the_study(tmp_path: Path) -> None:
    search = Scenario.load("search").replace("clock.time_limit_s", 5)
    vary = {"robots.rover.count": "1,2", "items.mine.count": "3"}
    study.run(search, vary=vary, runs=2, seed=5, out=tmp_path)
    plan = study.load_plan(tmp_path)
    stored = study.open(tmp_path).runs().filter("configuration = 1 AND run = 1").fetchnumpy()
    mine = ae.run(plan.alone(1), seed=5, run=1).row
    assert mine["distance_m"] == stored["distance_m"][0]
    assert mine["robots"] == 2
    with pytest.raises(InputError, match="from 0 to 1"):
        plan.alone(2)


def test_designs_with_other_columns_have_other_identities() -> None:
    search = (
        Scenario.load("search").replace("clock.time_limit_s", 5).replace("study.design", "lhs:1")
    )
    some, more = (
        study.make_plan(search.replace("study.vary", {"items.mine.count": counts}), runs=2, seed=4)
        for counts in ("3,4", "3,9")
    )
    assert some.configurations == more.configurations
    assert some.engine.columns != more.engine.columns
    assert some.identity != more.identity


@pytest.mark.parametrize(
    ("confidence", "end"),
    [
        (95, "; did you mean 0.95?"),
        (np.int64(95), "; did you mean 0.95?"),
        (99.9, "; did you mean 0.999?"),
        (99.9999999999999, ""),
        (np.float64(50), "; did you mean 0.5?"),
        (1, ""),
        (30, ""),
        (100, ""),
        ("95", ""),
        (True, ""),
        (float("nan"), ""),
    ],
)
def test_a_confidence_in_percent_is_reported_with_its_share(confidence: Any, end: str) -> None:
    with pytest.raises(ae.InputError) as caught:
        study.make_plan(ae.Scenario.load("classic"), confidence=confidence)
    allowed = f"must be a number from 0.5 to below 1, such as 0.95{end}"
    assert str(caught.value) == f"confidence = {confidence!r}: {allowed}"

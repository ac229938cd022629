"""What is wrong with the question of a requirement is reported at once, by file and line."""

import re
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from agent_economy import Scenario, study
from agent_economy._core import InputError
from agent_economy.cli import app
from agent_economy.scenario import Override


def warehouse(*conditions: str) -> Scenario:
    """Return the warehouse with other conditions."""
    changes = {"require.all": list(conditions), "study.where": None, "study.minimize": None}
    overrides = tuple(
        Override(tuple(path.split(".")), value, path.partition(".")[0])
        for path, value in changes.items()
        if value is not None
    )
    return Scenario.load("warehouse", overrides)


@pytest.mark.parametrize(
    "condition",
    [
        "found_parcel >= 10",
        "missed_parcel <= 0",
        "found_parcel_10_s <= 20",
        "time_until(found_parcel >= 10) <= 20",
    ],
)
def test_a_run_that_ends_at_the_ninth_find_shows_nothing_of_the_tenth(condition: str) -> None:
    with pytest.raises(InputError, match=r"until \[end\] ends a run, when found_parcel >= 9"):
        warehouse(condition)


@pytest.mark.parametrize(
    ("conditions", "fault"),
    [
        (["collisions == 0.5"], "never holds, because collisions is a whole number"),
        (["failed != 0.5"], "always holds, because failed is a whole number"),
        (["time_s <= 10", "time_s >= 20"], "never holds together with 'time_s <= 10'"),
        (["time_s < 10", "time_s == 10"], "never holds together with 'time_s < 10'"),
    ],
)
def test_conditions_that_decide_nothing_are_refused(conditions: list[str], fault: str) -> None:
    with pytest.raises(InputError, match=re.escape(fault)):
        study.make_plan(warehouse(*conditions))


def test_errors_of_the_question_its_expressions_and_conditions_are_reported_at_once() -> None:
    scenario = warehouse("time_s >= 0").replace("study.where", "rovr == 3")
    scenario = scenario.replace("study.minimize", "robts")
    with pytest.raises(InputError) as caught:
        study.make_plan(scenario, confidence=3, seed=0)
    lines = str(caught.value).splitlines()
    assert len(lines) == 4
    for line, part in zip(lines, ["confidence", "study.where", "robts", "always"], strict=True):
        assert part in line


@pytest.mark.parametrize("cost", ["-" * 994 + "robots", "+".join(["1"] * 498), "1e999", "True"])
def test_expressions_that_are_too_deep_or_no_numbers_are_refused(cost: str) -> None:
    with pytest.raises(InputError, match="study.minimize"):
        study.make_plan(warehouse("time_s <= 900").replace("study.minimize", cost))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ["--require", "time_s <= 40", "--delta", "0.1"],
            "--delta: expected one question",
        ),
        (["--require", "time_s <= 40", "--runs", "5"], "--runs: expected one question"),
        (["--minimize", "price"], "--minimize: needs a requirement"),
    ],
)
def test_options_of_two_questions_are_refused(options: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["study", "search", *options])
    assert result.exit_code == 2
    assert message in result.output


@pytest.mark.parametrize("wrong", [{"require": 5}, {"merit": 5}, {"require": [5]}])
def test_arguments_of_another_type_are_refused_as_input(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        study.run("classic", **wrong)


def test_numbers_of_numpy_are_numbers() -> None:
    plain = {"probability": 0.5, "tolerance": 0.25}
    of_numpy = {key: np.float32(value) for key, value in plain.items()}
    answers = [
        study.run("classic", require="time_s <= 30", max_runs=2000, **each)
        for each in (plain, of_numpy)
    ]
    assert answers[0].guarantee == answers[1].guarantee

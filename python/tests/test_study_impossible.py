"""Studies of teams that cannot be run, of any design, and of teams with prices."""

import json
from pathlib import Path

import command_line
import pytest

from agent_economy import InputError, Scenario, study
from agent_economy.study.answer.any_answer import expect_best

TEAM = "robots.rover.count"

STRIP = """
engine = "metric"
summary = "Rovers that start in a strip of 20 m by 2 m."
merit = "robots=1"
[clock]
time_limit_s = 1
[world]
size_m = [20, 20]
[items.mine]
count = 1
[robots.rover]
count = 2
radius_m = 0.3
start = { kind = "uniform", within_m = [[0, 0], [20, 2]] }
drive = { max_speed_m_s = 0.5 }
[robots.rover.sensors.detector]
kind = "items"
range_m = 0.5
"""


@pytest.fixture
def strip(tmp_path: Path) -> Path:
    """Return the file of a scenario whose merit prefers teams that do not fit their strip."""
    file = tmp_path / "strip.toml"
    file.write_text(STRIP)
    return file


@pytest.mark.parametrize("arguments", [("--delta", 1), ("--runs", 20), ("--guarantee", "pgs")])
def test_a_team_without_room_is_never_selected_and_the_answer_has_the_reason(
    strip: Path, arguments: tuple[str, str]
) -> None:
    vary = f"{TEAM}=1,2,150,160"
    given = command_line.succeed("study", strip, "--vary", vary, *arguments, cwd=strip.parent)
    printed = " ".join(given.stdout.split())
    assert "Send 2 rovers" in printed
    assert "Cannot be run: 150 rovers and 160 rovers (robots.rover: the run has no room" in printed
    assert "Configurations that cannot be run were not compared." in printed
    assert "quarantined" in given.stdout
    folder = strip.parent / "studies/strip"
    answer = json.loads((folder / "answer.json").read_text())
    verdicts = [result["standing"]["verdict"] for result in answer["results"]]
    assert verdicts[1:] == ["best", "impossible", "impossible"]
    assert "cannot be run" in (folder / "report.html").read_text()
    before = (folder / "answer.json").read_bytes()
    command_line.succeed("report", folder)
    assert (folder / "answer.json").read_bytes() == before


def test_a_study_of_teams_without_room_has_no_answer(strip: Path) -> None:
    errors = command_line.refuse("study", strip, "--vary", f"{TEAM}=150", cwd=strip.parent)
    assert "no configuration can be run: all of the first 10 runs" in errors
    assert "the run has no room for rover/" in errors
    assert not (strip.parent / "studies/strip/answer.json").exists()


def test_the_only_team_with_room_is_selected(strip: Path) -> None:
    answer = expect_best(study.run(Scenario.load(strip), vary={TEAM: [150, 1]}))
    assert answer.results[answer.best].values[TEAM] == 1
    assert answer.guarantee.startswith("Only one configuration can be run")
    assert answer.runs == 20


def test_a_design_whose_influences_cannot_be_stated_is_answered(tmp_path: Path) -> None:
    vary = {"robots.wanderer.count": ["1..8"], "clock.paints_per_s": ["41.0..57.0"]}
    classic = Scenario.load("classic")
    answer = expect_best(study.run(classic, vary=vary, design="lhs:40", delta=0.8, out=tmp_path))
    assert answer.is_guaranteed
    assert answer.sensitivity is None
    (omission,) = answer.omissions
    assert omission.reason.startswith("40 points of a space-filling design are too few")
    text = (tmp_path / "answer.json").read_text()
    assert json.loads(text, parse_constant=pytest.fail)["omissions"][0]["reason"] == omission.reason
    assert "Left out" in (tmp_path / "report.html").read_text()
    assert expect_best(study.rebuild(tmp_path)).omissions == answer.omissions


def test_the_answer_names_the_price_of_the_team(strip: Path) -> None:
    scenario = Scenario.load(strip)
    assert "price" not in study.run(scenario, vary={TEAM: [1, 2]}).sentence
    priced = scenario.replace("robots.rover.price", 12500.25)
    answer = expect_best(study.run(priced, vary={TEAM: [1, 2]}, out=strip.parent / "priced"))
    assert answer.sentence.startswith("Send 2 rovers. The price of the team is 25,000.5. A run")
    assert [result.place.price for result in answer.results] == [12500.25, 25000.5]


def test_a_merit_of_nothing_is_zero_without_a_sign(strip: Path) -> None:
    scenario = Scenario.load(strip).replace("merit", {"price": -1})
    answer = expect_best(study.run(scenario, vary={TEAM: [1, 2]}, out=strip.parent / "zero"))
    assert "the figure of merit is 0.00 (0.00 to 0.00)" in answer.sentence
    assert "-0.0" not in (strip.parent / "zero/answer.json").read_text()


def test_no_possible_configuration_is_an_input_error(strip: Path) -> None:
    with pytest.raises(InputError, match="no configuration can be run"):
        study.run(Scenario.load(strip), vary={TEAM: [150, 160]}, runs=2)

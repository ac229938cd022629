"""Scenarios: what is read from them, and the errors."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from agent_economy import InputError, Scenario
from agent_economy.scenario import Override

TEAM = ("study", "vary", "robots.wanderer.count")


def test_the_bundled_scenario_is_the_2003_experiment(classic_toml: Path) -> None:
    scenario = Scenario.load(classic_toml)
    assert (scenario.engine, scenario.time_limit_s) == ("classic", 120)
    assert scenario.robots == {"wanderer": 4}
    assert scenario.facts == (
        ("contact", "touch"),
        ("clock", "56 paints per second, time limit 120 s"),
    )
    (teams,) = scenario.factors
    assert (teams.path, teams.values) == ("robots.wanderer.count", (1, 2, 3, 4, 5, 6, 7, 8))
    assert scenario.merit.name == "equation-5.2"
    assert scenario.published is not None
    means = {
        robots: round(sum(times) / len(times))
        for robots, times in scenario.published.times_s.items()
    }
    assert means == {1: 69, 2: 81, 3: 37, 4: 37, 5: 69, 6: 120, 7: 120, 8: 120}


def test_all_errors_are_reported_with_file_line_value_and_what_is_allowed(
    classic_toml: Path,
) -> None:
    text = (
        classic_toml.read_text()
        .replace('contact = "touch"', 'contact = "tuch"')
        .replace("count = 4", 'count = "four"')
        .replace("time_limit_s = 120 #", "time_limit_s = -1 #")
        .replace("choice = 3", "chioce = 3")
    )
    with pytest.raises(InputError) as caught:
        Scenario.loads(text, file="my.toml")
    lines = str(caught.value).splitlines()
    assert len(lines) == 5
    for part in (
        'my.toml:7: contact = "tuch": must be one of "neighbour", "diagonal", "within-2", '
        '"within-3", "touch", "ahead"; did you mean "touch"?',
        'my.toml:18: robots.wanderer.count = "four": must be a whole number from 1 to 250',
        "my.toml:15: clock.time_limit_s = -1: must be a number from 0 to 1000000",
        "my.toml:26: published.chioce is not a known key: expected one of source, choice, "
        "time_limit_s, times_s; did you mean choice?",
        "my.toml:24: published.choice is missing: expected a whole number from 1 to 250",
    ):
        assert part in lines


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("", "engine is missing"),
        ("engine = 3", "engine = 3: must be one of"),
        ("[engine", "t.toml:1: not valid TOML: "),
        ("a = 1\na = 2", "t.toml:2: not valid TOML: "),
        ('engine = "clasic"', 'must be one of "classic", "metric"; did you mean "classic"?'),
    ],
)
def test_invalid_toml_is_an_error(text: str, part: str) -> None:
    with pytest.raises(InputError) as caught:
        Scenario.loads(text, file="t.toml")
    assert part in str(caught.value)


def test_unreadable_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="none.toml: cannot be read: No such file"):
        Scenario.load(tmp_path / "none.toml")
    with pytest.raises(InputError, match="cannot be read: Is a directory"):
        Scenario.load(tmp_path)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"a = '\xff'")
    with pytest.raises(InputError, match="is not UTF-8 text: byte 5 is 0xff"):
        Scenario.load(binary)


def test_bundled_names_are_scenarios_and_similar_names_are_suggested(
    classic_toml: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert Scenario.load("classic").source.text == classic_toml.read_text()
    own = classic_toml.read_text().replace("time_limit_s = 120 #", "time_limit_s = 60 #")
    (tmp_path / "classic").write_text(own)
    assert Scenario.load("classic").time_limit_s == 60
    with pytest.raises(InputError, match="clasic: cannot be read: .*; did you mean classic?"):
        Scenario.load("clasic")


def test_errors_have_their_files_and_lines(classic_toml: Path) -> None:
    text = classic_toml.read_text().replace('"touch"', '"tuoch"').replace("summary", "#")
    path = ("clock", "time_limit_s")
    with pytest.raises(InputError) as caught:
        Scenario.loads(text, "my.toml", (Override(path, -1, "--set clock.time_limit_s"),))
    assert "\n".join(error["message"] for error in caught.value.errors) == str(caught.value)
    places = {error["path"]: (error["file"], error["line"]) for error in caught.value.errors}
    assert places == {
        "contact": ("my.toml", 7),
        "summary": ("my.toml", None),
        "clock.time_limit_s": (None, None),
    }
    (contact,) = (error for error in caught.value.errors if error["path"] == "contact")
    assert (contact["origin"], contact["value"]) == ("my.toml:7", '"tuoch"')
    assert contact["suggestion"] == '"touch"'
    assert "one of" in contact["allowed"]
    assert InputError("of another kind").errors == ()


def test_a_scenario_is_available_as_a_dict_with_its_overrides(classic_toml: Path) -> None:
    scenario = Scenario.load(classic_toml)
    assert scenario.to_dict() == tomllib.loads(classic_toml.read_text())
    changed = scenario.replace("merit", {"time": -1, "found": {"weight": 2}})
    changed = changed.replace("merit.time", -3).replace("study.vary.contact", "touch,ahead")
    given = changed.to_dict()
    assert given["merit"] == {"time": -3, "found": {"weight": 2}}
    assert given["study"]["vary"]["contact"] == "touch,ahead"
    assert Scenario.loads(tomli_w.dumps(given)).merit == changed.merit
    assert changed.replace("merit.time", -1).to_dict()["merit"]["time"] == -1
    assert changed.to_dict() == given


def test_values_of_any_type_are_checked(classic_toml: Path) -> None:
    scenario = Scenario.load(classic_toml)
    given: dict[str, Any] = {
        "[true, [1, 0.5], {...}]": [True, [1, 0.5], {"a": "b"}],
        "true": True,
        '"x"': "x",
    }
    for shown, value in given.items():
        with pytest.raises(InputError) as caught:
            scenario.replace("clock.time_limit_s", value)
        assert f"replace: clock.time_limit_s = {shown}: must be a number" in str(caught.value)
    with pytest.raises(
        InputError, match="replace: clock.time_limit_s.a = None: must be a string, a number"
    ):
        scenario.replace("clock.time_limit_s", {"a": None})


def nested(depth: int) -> list[Any]:
    given: list[Any] = [1.5]
    for _ in range(depth - 1):
        given = [given]
    return given


def test_a_value_that_contains_itself_is_an_error(classic_toml: Path) -> None:
    scenario = Scenario.load(classic_toml)
    ring: list[Any] = []
    ring.append(ring)
    knot: dict[str, Any] = {}
    knot["a"] = [knot]
    for value in (ring, knot, nested(33), nested(100_000)):
        with pytest.raises(InputError, match="at most 32 levels deep"):
            scenario.replace("clock.time_limit_s", value)
    with pytest.raises(InputError, match="clock.time_limit_s = .*must be a number"):
        scenario.replace("clock.time_limit_s", nested(32))


@pytest.mark.parametrize(
    ("values", "sizes"),
    [("1..3", (1, 2, 3)), ("7", (7,)), ("4, 2,4", (2, 4)), ("1..2,9", (1, 2, 9))],
)
def test_values_are_ranges_and_lists(
    classic_toml: Path, values: str, sizes: tuple[int, ...]
) -> None:
    scenario = Scenario.load(classic_toml, (Override(TEAM, values, "--vary"),))
    assert scenario.factors[0].values == sizes


@pytest.mark.parametrize("values", ["", "3..1", "1...3", "1,,2", "a b"])
def test_an_invalid_list_of_values_is_an_error(classic_toml: Path, values: str) -> None:
    with pytest.raises(InputError, match="--vary: .*must be a string of values"):
        Scenario.load(classic_toml, (Override(TEAM, values, "--vary"),))


@pytest.mark.parametrize("values", ["0..3", "1..251", "x", "-1", "1.0..3.0"])
def test_values_that_a_factor_cannot_have_are_named(classic_toml: Path, values: str) -> None:
    design = Override(("study", "design"), "lhs:9", "--design")
    changes = (Override(TEAM, values, "--vary"), design)
    message = r"^--vary: robots.wanderer.count = \S+: must be a whole number from 1 to 250"
    with pytest.raises(InputError, match=message):
        Scenario.load(classic_toml, changes)

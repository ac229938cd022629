"""Fleet files: the plan of a fleet, warnings, schema, bundled fleets, and `check`."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from command_line import refuse, run, succeed
from fleet_files import FLEET, SCENARIO, load, swapped, with_key
from jsonschema import Draft7Validator

from agent_economy import InputError
from agent_economy.live import fleet
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.fleet_file.schema import fleet_schema
from agent_economy.live.plan import InputPlan, Origin, plan_of
from agent_economy.live.readings import Quantity
from agent_economy.scenario import Override

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "schemas" / "fleet.schema.json"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the scenario."""
    (tmp_path / "crawlers.toml").write_text(SCENARIO)
    return tmp_path


# What a fleet is


def test_a_fleet_has_its_scenario_and_the_plan_of_its_robots(folder: Path) -> None:
    found = load(folder, with_key("waypoints_m = [[10, 10]]\nmax_age_s = { gps = 2 }"))
    assert found.scenario.name == "crawlers"
    assert found.text == (folder / "fleet.toml").read_text()
    assert found.plan.origin == Origin(36.6, -121.9, 0.0, 14.5)
    assert (found.plan.period_s, found.plan.setpoint_lifetime_s) == (0.1, 0.3)
    assert found.waypoints_m == {"crawler/0": ((10.0, 10.0),)}
    first, second, _ = found.plan.robots
    assert (first.name, first.driver, first.host) == ("crawler/0", "bender", "10.0.0.1")
    assert first.ports == {"motors": 2000, "compass": 2001, "gps": 2002, "sonar": 2003}
    assert second.ports == {"motors": 2010, "compass": 2011, "gps": 2012, "sonar": 2013}
    assert (first.max_speed_m_s, first.manual_speed_m_s) == (0.6, 0.2)
    assert first.max_turn_rate_rad_s == pytest.approx(1.5708, abs=1e-4)
    assert first.settings.keys() == DRIVERS["bender"].settings.keys()
    assert (first.settings["no_echo"], second.settings["no_echo"]) == (0, None)


def test_the_inputs_of_a_robot_have_the_noise_of_the_scenario(folder: Path) -> None:
    compass, gps, sonar = load(folder, with_key("max_age_s = { gps = 2 }")).plan.robots[0].inputs
    assert compass == InputPlan("compass", Quantity.HEADING, 1.0, math.radians(2.0))
    assert gps == InputPlan("gps", Quantity.POSITION, 2.0, 0.3, None)
    # Of the sonar with the longest range: 0.02 + 1% of 8 m.
    assert (sonar.port, sonar.quantity, sonar.max_age_s) == ("sonar", Quantity.RANGES, 0.5)
    assert sonar.noise == pytest.approx(0.1)
    assert sonar.bounds is not None
    assert sonar.bounds == pytest.approx((0.0, 8.08 + 0.5))


def test_a_plan_is_the_same_after_json(folder: Path) -> None:
    plan = load(folder, with_key("fence_m = [[1, 1], [39, 1], [39, 29], [1, 29]]")).plan
    assert plan_of(json.loads(json.dumps(plan.to_dict(), allow_nan=False))) == plan


def test_motor_lines_are_repeated_well_within_the_deadman(folder: Path) -> None:
    text = swapped("deadman_s = 1.0", "deadman_s = 0.3")
    first, second, _ = load(folder, text).plan.robots
    assert first.repeat_s == pytest.approx(0.1)
    assert (first.deadman_s, second.deadman_s, second.repeat_s) == (0.3, None, 0.2)


def test_the_scenario_may_be_changed(folder: Path) -> None:
    load(folder)
    change = Override.at("robots.crawler.drive.max_speed_m_s", 0.1, "--set")
    changed = fleet.load(folder / "fleet.toml", (change,))
    assert {robot.max_speed_m_s for robot in changed.plan.robots} == {0.1}
    assert {robot.manual_speed_m_s for robot in changed.plan.robots} == {0.1}


# Warnings


def warned(folder: Path, text: str, scenario: str = SCENARIO) -> list[str]:
    """Return the warnings about a valid fleet, without the folder."""
    (folder / "crawlers.toml").write_text(scenario)
    found = load(folder, text)
    assert found.plan.warnings == tuple(map(str, found.warnings))
    return [str(each).removeprefix(f"{folder}/") for each in found.warnings]


def test_guesses_that_the_file_does_not_set_are_warned_of(folder: Path) -> None:
    text = swapped("track_width_m = 0.5\n", "")
    first, second, *_ = [each for each in warned(folder, text) if ".settings" in each]
    assert first == (
        'fleet.toml:6: robots."crawler/0".settings = {...}: guesses are used for what is not '
        "set: track_width_m = 0.5; measure and set them"
    )
    assert second.startswith(
        'fleet.toml:14: robots."crawler/1".settings: guesses are used for what is'
    )
    assert "range_unit_m = 0.3048, no_echo, " in second
    assert "compass_offset_deg" not in second


def test_robots_that_do_not_stop_by_themselves_are_warned_of(folder: Path) -> None:
    found = [each for each in warned(folder, FLEET) if "deadman_s" in each]
    assert [each.split(":")[1] for each in found] == ["15", "18"]
    assert "the robot drives on if this computer or the link fails" in found[0]


def test_waypoints_within_the_noise_of_positions_are_warned_of(folder: Path) -> None:
    scenario = swapped("within_m = 1", "within_m = 0.55", SCENARIO)
    found = [each for each in warned(folder, FLEET, scenario) if "within_m" in each]
    assert found == [
        "crawlers.toml:19: robots.crawler.brain.behaviours[1].within_m = 0.55: less than twice the "
        "standard deviation of positions, 0.6 m: the robot may circle around its waypoints"
    ]
    assert not any("within_m" in each for each in warned(folder, FLEET))


def test_robots_of_the_scenario_that_are_simulated_are_warned_of(folder: Path) -> None:
    text = FLEET[: FLEET.index('[robots."crawler/1"]')]
    assert warned(folder, text) == [
        "fleet.toml:2: robots = {...}: the scenario's team also has crawler/1 and 1 more of this "
        "kind, which the loop simulates",
        'fleet.toml:2: robots."crawler/0".fence_m: without a fence, simulated robots regard ever '
        "more of the world as taken while the robot sends no positions",
    ]


# Schema, bundled fleets, documents


def test_the_schema_follows_from_the_drivers() -> None:
    assert json.loads(SCHEMA.read_text()) == fleet_schema(), "run make schemas"
    Draft7Validator.check_schema(fleet_schema())


def test_bundled_fleets_are_valid_and_name_their_schema() -> None:
    assert (ROOT / "fleets").resolve() == ROOT / "python/agent_economy/fleets"
    for file in fleet.fleets().values():
        text = file.read_text(encoding="utf-8")
        assert list(Draft7Validator(fleet_schema()).iter_errors(tomllib.loads(text))) == []
        first = text.splitlines()[0].removeprefix("#:schema ")
        assert (file.parent / first).resolve() == SCHEMA.resolve()
        assert fleet.load(file).plan == fleet.load(file.stem).plan


def test_an_unknown_fleet_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"bendr: cannot be read: .*; did you mean bender\?"):
        fleet.load("bendr")
    with pytest.raises(InputError, match="cannot be read: Is a directory"):
        fleet.load(tmp_path)
    (tmp_path / "fleet.toml").write_bytes(b"\xff")
    with pytest.raises(InputError, match="is not UTF-8 text: byte 0 is 0xff"):
        fleet.load(tmp_path / "fleet.toml")


def described(schema: Any, page: str) -> list[str]:
    """Return the keys of a schema that a page does not describe in a table, with their defaults."""
    missing = []
    for key, part in schema.get("properties", {}).items():
        rows = [line for line in page.splitlines() if line.startswith(f"| `{key}` |")]
        default = part.get("default")
        shown = "" if default is None else f"`{json.dumps(default)}`"
        missing += [] if any(shown in row for row in rows) else [f"{key} {shown}"]
        missing += described(part, page)
    for part in [schema.get("additionalProperties"), *schema.get("oneOf", [])]:
        missing += described(part, page) if isinstance(part, dict) else []
    return missing


def test_the_page_of_fleets_describes_every_key_with_its_default() -> None:
    page = (ROOT / "docs/fleet.md").read_text()
    assert described(fleet_schema(), page) == []


def test_the_page_of_fleets_marks_the_settings_that_are_guesses() -> None:
    page = (ROOT / "docs/fleet.md").read_text().splitlines()
    for driver in DRIVERS.values():
        for key, setting in driver.settings.items():
            (row,) = [line for line in page if line.startswith(f"| `{key}` |")]
            assert ("guess" in row) == setting.is_guess, row


# The command


def test_check_recognises_fleets(folder: Path) -> None:
    file = folder / "fleet.toml"
    file.write_text(swapped("deadman_s = 1.0", ""))
    given = succeed("check", "fleet.toml", "crawlers.toml", cwd=folder)
    lines = given.stdout.splitlines()
    assert [line for line in lines if not line.startswith("  ")] == [
        "fleet.toml: valid: fleet of 3 robots, scenario crawlers",
        "crawlers.toml: valid: engine metric, factorial: 1 configuration",
    ]
    assert (
        'warning: fleet.toml:2: robots."crawler/0".deadman_s: the robot drives on' in given.stderr
    )
    listed = json.loads(succeed("check", "fleet.toml", "--json", cwd=folder).stdout)
    assert {each["severity"] for each in listed} == {"warning"}


def test_check_reports_errors_of_fleets(folder: Path) -> None:
    file = folder / "fleet.toml"
    file.write_text(swapped('"bender"', '"bendr"'))
    message = refuse("check", "fleet.toml", "--set", "clock.tim_limit_s=3", cwd=folder)
    assert 'fleet.toml:3: robots."crawler/0".driver = "bendr": must be one of "bender"' in message
    assert "--set clock.tim_limit_s: clock.tim_limit_s is not a known key" in message
    given = run("check", "fleet.toml", "--json", cwd=folder)
    (error,) = json.loads(given.stdout)
    assert (given.returncode, error["severity"], error["line"]) == (2, "error", 3)


@pytest.mark.parametrize("text", ["[robots]\nx = { driver = 1 }", 'scenario = "classic"'])
def test_a_file_with_drivers_or_a_scenario_is_a_fleet(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.toml").write_text(text)
    assert fleet.is_fleet_file(tmp_path / "a.toml")


@pytest.mark.parametrize(
    "text", ["", 'engine = "metric"\nscenario = "a"', "robots = 3", "[robots.a]\ncount = 1", "= 1"]
)
def test_other_files_are_no_fleets(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.toml").write_text(text)
    assert not fleet.is_fleet_file(tmp_path / "a.toml")
    assert not fleet.is_fleet_file(tmp_path / "none.toml")

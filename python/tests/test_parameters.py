"""The page lists every number, switch and choice of a scenario: see `Parameter` of its messages."""

from typing import Any

import pytest

from agent_economy import Scenario
from agent_economy.scenario import bundled
from agent_economy.server.parameters import parameters

TEXT = """
engine = "metric"
summary = "A search."
merit = { time = -0.03, energy = { weight = -1 } }
clock.time_limit_s = 120

[world]
size_m = [25, 20]
obstacles = [{ circle = { at_m = [8, 16], radius_m = 1.5 } }]

[items.mine]
count = 4

[models.cart]
model = "ugv"
price = 9000

[robots.rover]
model = "ugv"
count = 4
brain.arbitration = { kind = "goals" }
brain.behaviours = [{ kind = "bayesian_search" }, { kind = "avoid", near_m = 0.3 }]

[study]
delta = 0.1
"""


@pytest.fixture(scope="module")
def listed() -> dict[str, dict[str, Any]]:
    """Return the parameters of a scenario, by path."""
    return by_path(Scenario.loads(TEXT))


def by_path(scenario: Scenario) -> dict[str, dict[str, Any]]:
    """Return the parameters of a scenario, by path."""
    found = parameters(scenario)
    paths = {".".join(map(str, each["steps"])): each for each in found}
    assert len(paths) == len(found)
    return paths


def test_numbers_have_bounds_help_and_value(listed: dict[str, Any]) -> None:
    assert listed["robots.rover.count"] == {
        "steps": ["robots", "rover", "count"],
        "value": 4,
        "default": None,
        "low": 0,
        "high": 1_000_000,
        "kind": "whole",
        "values": None,
        "unit": None,
        "help": "Number of robots of this kind in the team.",
    }


def test_parameters_that_a_scenario_leaves_out_have_their_default(listed: dict[str, Any]) -> None:
    step, periodic = listed["clock.step_s"], listed["world.periodic"]
    assert (step["value"], step["default"], step["unit"]) == (None, 0.1, "s")
    assert (periodic["value"], periodic["default"]) == (None, False)
    assert periodic["values"] == [False, True]


def test_parameters_have_the_values_of_robot_models(listed: dict[str, Any]) -> None:
    assert listed["robots.rover.radius_m"]["value"] == 0.27
    assert listed["robots.rover.sensors.camera.fov_deg"]["value"] == 69


def test_names_to_choose_from_are_choices(listed: dict[str, Any]) -> None:
    model, layer = listed["robots.rover.model"], listed["robots.rover.layer"]
    assert model["values"] == ["tracked", "ugv", "quadrotor", "cart"]
    assert (model["kind"], model["value"]) == ("choice", "ugv")
    assert listed["models.cart.model"]["value"] == "ugv"
    assert (layer["values"], layer["value"]) == (["ground", "air"], "ground")


def test_the_values_of_a_model_of_the_scenario_are_parameters(listed: dict[str, Any]) -> None:
    assert listed["models.cart.price"]["value"] == 9000
    assert listed["models.cart.drive.max_speed_m_s"]["value"] == 2
    assert "models.cart.count" not in listed


def test_entries_of_lists_are_listed_by_their_kind(listed: dict[str, Any]) -> None:
    behaviours = "robots.rover.brain.behaviours"
    assert listed[f"{behaviours}.1.near_m"]["value"] == 0.3
    assert listed[f"{behaviours}.0.value"]["help"].startswith("Value of searching")
    assert f"{behaviours}.0.near_m" not in listed
    assert listed["world.obstacles.0.circle.radius_m"]["value"] == 1.5
    assert listed["world.size_m.1"]["value"] == 20


def test_alternatives_follow_the_scenario(listed: dict[str, Any]) -> None:
    assert listed["merit.time"]["value"] == -0.03
    assert listed["merit.energy.weight"]["value"] == -1
    assert listed["merit.found"]["value"] is None


@pytest.mark.parametrize("name", bundled.scenarios())
def test_the_study_and_strings_are_not_listed(name: str) -> None:
    listed = by_path(Scenario.load(name))
    assert listed
    assert not {path.split(".")[0] for path in listed} & {"study", "published", "summary", "engine"}
    assert not any(path.endswith(".kind") for path in listed)

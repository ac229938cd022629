"""Robot models of a scenario, from Python, the command line and the page."""

import json
import tomllib
from pathlib import Path

import pytest
from command_line import refuse, succeed
from jsonschema import Draft7Validator

import agent_economy as ae
from agent_economy.scenario import bundled
from agent_economy.server.studies.factors import factors

TEXT = """
engine = "metric"
summary = "Two carts that differ in their speed and their price."
merit = { time = -0.03, price = -0.001 }

[clock]
time_limit_s = 60

[world]
size_m = [12, 12]

[items.mine]
count = 2

[models.slow]
radius_m = 0.3
price = 400
drive = { max_speed_m_s = 0.4, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 12, range_m = 2 }
sensors.camera = { kind = "items", range_m = 2 }

[models.fast]
model = "slow"
price = 900
drive = { max_speed_m_s = 1.5 }

[robots.cart]
model = "slow"
count = 2

[study]
vary = { "robots.cart.model" = "slow,fast" }
"""


def cart(text: str = TEXT) -> ae.Scenario:
    """Return the scenario of the carts."""
    return ae.Scenario.loads(text, "carts.toml")


def test_the_model_of_a_kind_is_a_factor_of_a_study() -> None:
    answer = ae.study.run(cart(), runs=20)
    assert isinstance(answer, ae.study.Answer)
    values = {result.values["robots.cart.model"]: result for result in answer.results}
    assert set(values) == {"slow", "fast"}
    slow, fast = (
        ae.replicate(cart().replace("robots.cart.model", name), runs=20) for name in values
    )
    assert set(slow["price"].to_pylist()) == {800}
    assert set(fast["price"].to_pylist()) == {1800}


def test_a_kind_with_a_model_has_the_outcomes_of_a_kind_with_its_values() -> None:
    before, rest = TEXT.split("[models.slow]\n")
    values, rest = rest.split("[models.fast]")
    written = f"{before}[robots.cart]\ncount = 2\n{values}"
    assert ae.replicate(cart(), runs=20).equals(ae.replicate(cart(written), runs=20))


def test_a_value_of_a_model_can_be_set_and_varied(tmp_path: Path) -> None:
    file = tmp_path / "carts.toml"
    file.write_text(TEXT)
    outcome = json.loads(succeed("run", file, "--set", "models.slow.price=123", "--json").stdout)
    assert outcome["price"] == 246
    scenario = cart(
        TEXT.replace('"robots.cart.model" = "slow,fast"', '"models.slow.price" = "100,200"')
    )
    answer = ae.study.run(scenario, runs=5)
    assert isinstance(answer, ae.study.Answer)
    assert [result.label for result in answer.results] == ["price 100", "price 200"]
    assert "100" in answer.sentence


def test_errors_name_the_path_in_the_model_and_the_nearest_name(tmp_path: Path) -> None:
    file = tmp_path / "carts.toml"
    text = TEXT.replace("max_speed_m_s = 1.5", "max_sped_m_s = 1.5").replace(
        '"slow,fast"', '"slow,fats"'
    )
    file.write_text(text)
    errors = refuse(
        "check",
        file,
    )
    assert "carts.toml:25: models.fast.drive.max_sped_m_s is not a known key" in errors
    assert 'robots.cart.model = "fats"' in errors
    assert 'did you mean "fast"?' in errors
    refused = refuse("run", file, "--set", "models.slwo.price=3")
    assert "models.slwo.price = 3: must be in an existing entry of models: fast, slow" in refused
    with pytest.raises(ae.InputError, match="did you mean models.slow.price"):
        cart(TEXT.replace('"robots.cart.model" = "slow,fast"', '"models.slwo.price" = "100,200"'))


def test_the_page_offers_the_models_of_the_scenario_and_their_values() -> None:
    offered = {factor["path"]: factor for factor in factors(cart())}
    model = offered["robots.cart.model"]
    assert model["values"] == ["tracked", "ugv", "quadrotor", "fast", "slow"]
    assert (model["value"], model["varied"]) == ("slow", "slow,fast")
    assert offered["models.fast.price"]["value"] == 900
    assert offered["models.slow.drive.max_speed_m_s"]["high"] == 100


def test_editors_accept_models() -> None:
    file = Path(bundled.__file__).parent.parent / "schemas" / "metric.schema.json"
    validator = Draft7Validator(json.loads(file.read_text(encoding="utf-8")))
    assert validator.is_valid(tomllib.loads(TEXT))
    assert not validator.is_valid(tomllib.loads(TEXT.replace("price = 900", "price = -1")))
    assert not validator.is_valid(tomllib.loads(TEXT.replace("price = 900", "count = 3")))

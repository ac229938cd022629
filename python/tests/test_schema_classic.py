"""The JSON Schema of classic scenarios accepts exactly what the engine accepts."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from agent_economy import InputError, Scenario, _core
from agent_economy.scenario import bundled

TEXT = bundled.scenarios()["classic"].read_text(encoding="utf-8")

NUMBERS = {
    "robots.wanderer.count": ("robots", "wanderer", "count"),
    "clock.paints_per_s": ("clock", "paints_per_s"),
    "clock.time_limit_s": ("clock", "time_limit_s"),
}
"""All numbers that can be varied, and where the schema has them."""


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    file = Path(bundled.__file__).parent.parent / "schemas" / "classic.schema.json"
    read: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    Draft7Validator.check_schema(read)
    return read


def part(schema: dict[str, Any], *keys: str) -> dict[str, Any]:
    for key in keys:
        schema = schema["properties"][key]
    return schema


def is_taken(text: str) -> bool:
    try:
        Scenario.loads(text)
    except InputError:
        return False
    return True


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("", ""),
        ("time_limit_s = 120 #", "cpa_s = 120 #"),
        ("count = 4", ""),
        ("count = 4", "count = 4.5"),
        ("count = 4", 'count = "four"'),
        ("[robots.wanderer]", "[robots.rover]"),
        ('contact = "touch"', 'contact = "tuch"'),
        ('contact = "touch"', ""),
        ('merit = "equation-5.2"', 'merit = "appendix"'),
        ('merit = "equation-5.2"', 'merit = "equation-5"'),
        ('merit = "equation-5.2"', "merit = { time = -1, collisions = -0.1 }"),
        ('merit = "equation-5.2"', "merit = { energy = -1 }"),
        ('engine = "classic"', 'engine = "classic"\nextra = 1'),
    ],
)
def test_the_schema_and_the_engine_accept_the_same(
    schema: dict[str, Any], good: str, bad: str
) -> None:
    assert good in TEXT
    text = TEXT.replace(good, bad, 1)
    assert Draft7Validator(schema).is_valid(tomllib.loads(text)) == is_taken(text)


@pytest.mark.parametrize("path", NUMBERS)
def test_the_schema_has_the_bounds_of_the_engine(schema: dict[str, Any], path: str) -> None:
    bounds = part(schema, *NUMBERS[path])
    # Few paints per second: the time limit is at most a million paints.
    scenario = Scenario.loads(TEXT).replace("clock.paints_per_s", 0.1)
    for bound, beyond in (("minimum", -math.inf), ("maximum", math.inf)):
        value = bounds[bound]
        assert scenario.configuration({path: value})
        if bounds["type"] == "integer":
            over = value + (1 if beyond > 0 else -1)
        else:
            over = math.nextafter(value, beyond)
        with pytest.raises(InputError, match=path):
            scenario.configuration({path: over})


def test_the_schema_has_the_names_of_the_engine(schema: dict[str, Any]) -> None:
    assert part(schema, "contact")["enum"] == _core.CONTACTS
    named = part(schema, "merit")["anyOf"][0]["enum"]
    with pytest.raises(InputError) as error:
        Scenario.loads(TEXT).replace("merit", "none")
    assert f"must be one of {', '.join(map(json.dumps, named))}" in str(error.value)

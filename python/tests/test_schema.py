"""The JSON Schema of scenarios works in a standard validator."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator

from agent_economy.scenario import bundled

SCHEMAS = Path(bundled.__file__).parent.parent / "schemas"

METRIC = [file for file in bundled.scenarios().values() if 'engine = "metric"' in file.read_text()]


@pytest.fixture(scope="module")
def validator() -> Draft7Validator:
    schema = json.loads((SCHEMAS / "metric.schema.json").read_text(encoding="utf-8"))
    Draft7Validator.check_schema(schema)
    return Draft7Validator(schema)


@pytest.mark.parametrize("file", METRIC, ids=lambda file: file.stem)
def test_bundled_scenarios_are_valid_and_name_their_schema(
    file: Path, validator: Draft7Validator
) -> None:
    text = file.read_text(encoding="utf-8")
    assert list(validator.iter_errors(tomllib.loads(text))) == []
    first = text.splitlines()[0]
    assert (file.parent / first.removeprefix("#:schema ")).resolve() == (
        SCHEMAS / "metric.schema.json"
    )


SPOILED = [
    ("time_limit_s = 120", "cpa_s = 120"),
    ("time_limit_s = 120", "time_limit_s = -1"),
    ("size_m = [25, 25]", "size_m = [25]"),
    ("count = 4\n", ""),
    ('model = "ugv"', "model = 3"),
    ('model = "ugv"', ""),
    ("max_speed_m_s = 1", 'max_speed_m_s = "fast"'),
    ("circle = {", "cirle = {"),
    ('merit = "equation-5.2"', 'merit = "equation-5"'),
    ("[study]", "[stduy]"),
]


@pytest.mark.parametrize(("good", "bad"), SPOILED)
def test_scenarios_with_errors_are_not_valid(
    good: str, bad: str, validator: Draft7Validator
) -> None:
    text = bundled.scenarios()["search"].read_text(encoding="utf-8")
    assert good in text
    assert not validator.is_valid(tomllib.loads(text.replace(good, bad)))


def objects(part: Any) -> Iterator[dict[str, Any]]:
    """Yield every table of the schema that describes keys."""
    if isinstance(part, dict):
        if isinstance(part.get("properties"), dict):
            yield part["properties"]
        for value in part.values():
            yield from objects(value)
    elif isinstance(part, list):
        for value in part:
            yield from objects(value)


def test_every_key_is_described(validator: Draft7Validator) -> None:
    keys = [item for table in objects(validator.schema) for item in table.items()]
    assert len(keys) > 100
    explained = ("description", "$ref", "const")
    bare = [key for key, part in keys if not any(word in part for word in explained)]
    assert bare == []

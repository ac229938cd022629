"""The factors of a scenario that a study can vary, with their bounds from the engine's schema."""

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, cast

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario import Requirement, Scenario, Value
from agent_economy.study.paths import counted_kind, is_of_controllers
from agent_economy.study.plan import WITHOUT_RUNS
from agent_economy.types import page

Part = dict[str, Any]
"""A part of a schema."""

MISSING: Any = object()


def described(scenario: Scenario) -> page.Factors:
    """Return what the page needs to request a study of a scenario."""
    return {
        "name": scenario.name,
        "engine": cast("page.Engine", scenario.engine),
        "summary": scenario.summary,
        "factors": factors(scenario),
        "design": scenario.design,
        "merits": merits(scenario.engine),
        "merit": scenario.merit.name,
        "delta": scenario.delta,
        "confidence": scenario.confidence,
        "requirement": required(scenario.requirement) if scenario.requirement else None,
        "columns": columns(scenario),
        "minimize": scenario.cost,
        "where": scenario.where,
    }


def required(requirement: Requirement) -> page.Requirement:
    """Return a requirement as the page takes it."""
    return {
        "words": str(requirement),
        "conditions": [each.text for each in requirement.conditions],
        "probability": requirement.probability,
        "tolerance": requirement.tolerance,
    }


def columns(scenario: Scenario) -> list[str]:
    """Return the outcome columns that conditions can be about."""
    return [name for name, *_ in scenario.configuration({}).columns]


def factors(scenario: Scenario) -> list[page.Factor]:
    """Return all numbers and choices that a study can vary: robots and controllers first."""
    varied = scenario.to_dict().get("study", {}).get("vary", {})
    root = schema(scenario.engine)
    document = _core.read_filled(scenario.source)
    found: list[page.Factor] = [
        cast("page.Factor", {"path": path, **limits, "varied": varied.get(path)})
        for keys, limits in walk(root, document, [root], document)
        if keys[0] not in {*WITHOUT_RUNS, "engine"}
        and ((path := ".".join(keys)) in varied or can_be_varied(scenario, document, keys, limits))
    ]
    return sorted(found, key=lambda factor: place(factor["path"]))


def place(path: str) -> int:
    """Return the place of a factor: numbers of robots, of controllers, then all others."""
    if counted_kind(path) is None:
        return 2
    return 1 if is_of_controllers(path) else 0


def can_be_varied(
    scenario: Scenario, document: Part, keys: Sequence[str], limits: Mapping[str, Any]
) -> bool:
    """Return whether a factor has a value that is allowed alone, such as that of the document.

    A factor of a missing table may need other keys of the table.
    """
    for key in keys:
        document = document.get(key, MISSING)
        if document is MISSING:
            break
    else:
        return True
    usual = next((each for each in (limits["value"], limits["low"]) if each is not None), 1)
    samples = [usual] if limits["values"] is None else limits["values"]
    return any(is_allowed(scenario, {".".join(keys): each}) for each in samples)


def is_allowed(scenario: Scenario, values: Mapping[str, Value]) -> bool:
    """Return whether a configuration is valid."""
    try:
        scenario.configuration(values)
    except InputError:
        return False
    return True


def merits(engine: str) -> list[str]:
    """Return the names of the built-in figures of merit."""
    root = schema(engine)
    parts = branches(root, root["properties"]["merit"], MISSING)
    return [name for part in parts for name in part.get("enum", ())]


@cache
def schema(engine: str) -> Part:
    """Return the schema of an engine's scenarios."""
    file = files("agent_economy") / "schemas" / f"{engine}.schema.json"
    read: Part = json.loads(file.read_text(encoding="utf-8"))
    return read


def walk(
    root: Part, document: Part, parts: Sequence[Part], value: Any, keys: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Part]]:
    """Yield the keys and the limits of all numbers and choices that a path with dots can name.

    Args:
        root: The schema.
        document: The whole document; it defines names, such as those of models.
        parts: Those of the schema's parts that describe the value.
        value: The value; `MISSING` if the document has none.
        keys: Those from the root to the value.
    """
    inside = [each for part in parts for each in branches(root, part, value)]
    if not isinstance(value, dict | list) and (limits := allowed(inside, document)):
        default = next((each["default"] for each in inside if "default" in each), None)
        yield keys, {"value": default if value is MISSING else value, **limits, **words(inside)}
    elif isinstance(value, dict) or value is MISSING:
        for key in names(inside, value):
            described = [part for each in inside if (part := below(each, key)) is not None]
            within = value.get(key, MISSING) if isinstance(value, dict) else MISSING
            yield from walk(root, document, described, within, (*keys, key))


def names(parts: Sequence[Part], value: Any) -> list[str]:
    """Return the keys of a table that a study can vary."""
    known = dict.fromkeys(name for part in parts for name in part.get("properties", {}))
    if isinstance(value, dict):
        return [name for name in {**known, **value} if "." not in name]
    # Of a missing table with several kinds, none; of others, those that need no other key.
    tables = [part for part in parts if "properties" in part]
    required = {name for table in tables for name in table.get("required", ())}
    return [name for name in known if len(tables) == 1 and required <= {name}]


def words(parts: Sequence[Part]) -> Part:
    """Return the unit and the description of what parts describe."""
    unit = next((part["x-unit"] for part in parts if "x-unit" in part), None)
    help_text = next((part["description"] for part in parts if "description" in part), "")
    return {"unit": unit, "help": help_text}


def below(part: Part, key: str) -> Part | None:
    """Return the schema of a key, or that of any key."""
    any_name = part.get("additionalProperties")
    found: Part | None = part.get("properties", {}).get(key)
    return found or (any_name if isinstance(any_name, dict) else None)


def branches(root: Part, part: Part, value: Any) -> Iterator[Part]:
    """Yield a part of a schema and its alternatives, without those of another kind than a value."""
    if "$ref" in part:
        part = root["definitions"][part["$ref"].rsplit("/", 1)[-1]]
    if is_of_another_kind(part, value):
        return
    yield part
    for word in ("allOf", "anyOf", "oneOf"):
        for each in part.get(word, ()):
            yield from branches(root, each, value)


def is_of_another_kind(part: Part, value: Any) -> bool:
    """Return whether a key of a table, such as `kind`, excludes a part."""
    if not isinstance(value, dict):
        return False
    properties = part.get("properties", {})
    return any(
        key in value and value[key] != each["const"]
        for key, each in properties.items()
        if "const" in each
    )


def allowed(parts: Sequence[Part], document: Any) -> dict[str, Any] | None:
    """Return the bounds or choices of the values that parts describe."""
    kinds = {part.get("type") for part in parts}
    if kinds & {"number", "integer"}:
        return {
            "low": bound(parts, "minimum", "exclusiveMinimum"),
            "high": bound(parts, "maximum", "exclusiveMaximum"),
            "kind": "real" if "number" in kinds else "whole",
            "values": None,
        }
    choices = [choice for part in parts for choice in (*part.get("enum", ()), *const(part))]
    choices += [name for part in parts for name in document.get(part.get("x-names"), ())]
    if "boolean" in kinds:
        choices = [False, True]
    if len(choices) < len(("one", "other")):
        return None
    return {"low": None, "high": None, "kind": "choice", "values": choices}


def bound(parts: Sequence[Part], *words: str) -> float | None:
    """Return the first bound that parts have under one of some keywords."""
    return next((part[word] for part in parts for word in words if word in part), None)


def const(part: Part) -> list[Any]:
    """Return the only value that a part allows, if it does."""
    return [part["const"]] if "const" in part else []

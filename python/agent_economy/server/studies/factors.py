"""The factors of a scenario that a study can vary, with their bounds from the engine's schema."""

import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from agent_economy.scenario import Scenario
from agent_economy.study.paths import robot_kind
from agent_economy.study.plan import WITHOUT_RUNS

Part = dict[str, Any]
"""A part of a schema."""

MISSING: Any = object()


def described(scenario: Scenario) -> dict[str, Any]:
    """Return what the page needs to request a study of a scenario."""
    return {
        "name": scenario.name,
        "engine": scenario.engine,
        "summary": scenario.summary,
        "factors": factors(scenario),
        "design": scenario.design,
        "merits": merits(scenario.engine),
        "merit": scenario.merit.name,
        "delta": scenario.delta,
        "confidence": scenario.confidence,
    }


def factors(scenario: Scenario) -> list[dict[str, Any]]:
    """Return all numbers and choices that a study can vary, team sizes first."""
    document = scenario.to_dict()
    varied = document.get("study", {}).get("vary", {})
    own = {key: part for key, part in document.items() if key not in {*WITHOUT_RUNS, "engine"}}
    values = {".".join(keys): value for keys, value in leaves(own)}
    values |= {path: None for path in varied if path not in values}
    found = []
    for path, value in values.items():
        allowed = allowed_at(schema(scenario.engine), document, path.split("."))
        if allowed:
            found.append({"path": path, "value": value, **allowed, "varied": varied.get(path)})
    return sorted(found, key=lambda factor: robot_kind(factor["path"]) is None)


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


def leaves(
    part: Mapping[str, Any], keys: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield the numbers and strings of a document that a path with dots can name."""
    for key, value in part.items():
        if "." in key or isinstance(value, list):
            continue
        if isinstance(value, dict):
            yield from leaves(value, (*keys, key))
        else:
            yield (*keys, key), value


def allowed_at(root: Part, document: Any, keys: Sequence[str]) -> dict[str, Any] | None:
    """Return the bounds or choices of a value at a path; None if it has neither."""
    parts, value = [root], document
    for key in keys:
        inside = [each for part in parts for each in branches(root, part, value)]
        parts = [part for each in inside if (part := below(each, key)) is not None]
        value = value.get(key, MISSING) if isinstance(value, dict) else MISSING
    return allowed([each for part in parts for each in branches(root, part, value)], document)


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
            "whole": "number" not in kinds,
            "values": None,
        }
    choices = [choice for part in parts for choice in (*part.get("enum", ()), *const(part))]
    choices += [name for part in parts for name in document.get(part.get("x-names"), ())]
    if "boolean" in kinds:
        choices = [False, True]
    if len(choices) < len(("one", "other")):
        return None
    return {"low": None, "high": None, "whole": False, "values": choices}


def bound(parts: Sequence[Part], *words: str) -> float | None:
    """Return the first bound that parts have under one of some keywords."""
    return next((part[word] for part in parts for word in words if word in part), None)


def const(part: Part) -> list[Any]:
    """Return the only value that a part allows, if it does."""
    return [part["const"]] if "const" in part else []

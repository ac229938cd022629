"""The factors of a scenario that a study can vary, with their bounds from the engine's schema."""

import json
from collections.abc import Mapping
from typing import Any, cast

from agent_economy._core import InputError
from agent_economy.scenario import Requirement, Scenario, Value
from agent_economy.server.changed_values import exported_from
from agent_economy.server.parameters import parameters, schema
from agent_economy.study.paths import counted_kind, is_of_controllers
from agent_economy.study.plan import WITHOUT_RUNS
from agent_economy.types import page


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
        "exported_from": exported_from(scenario.source.text, scenario.to_dict()),
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
    found: list[page.Factor] = []
    for each in parameters(scenario):
        steps, given, default = each.pop("steps"), each["value"], each.pop("default")
        if steps[0] in WITHOUT_RUNS or not all(isinstance(key, str) for key in steps):
            continue
        path, value = ".".join(steps), default if given is None else given
        factor: Any = {"path": path, **each, "value": value, "varied": varied.get(path)}
        if given is not None or path in varied or can_be_set(scenario, factor):
            found.append(factor)
    return sorted(found, key=lambda factor: place(factor["path"]))


def place(path: str) -> int:
    """Return the place of a factor: numbers of robots, of controllers, then all others."""
    if counted_kind(path) is None:
        return 2
    return 1 if is_of_controllers(path) else 0


def can_be_set(scenario: Scenario, factor: page.Factor) -> bool:
    """Return whether a factor that is not set has a value that is allowed alone.

    A factor of a missing table may need other keys of the table.
    """
    usual = next((each for each in (factor["value"], factor["low"]) if each is not None), 1)
    samples = factor["values"] or [usual]
    return any(is_allowed(scenario, {factor["path"]: each}) for each in samples)


def is_allowed(scenario: Scenario, values: Mapping[str, Value]) -> bool:
    """Return whether a configuration is valid."""
    try:
        scenario.configuration(values)
    except InputError:
        return False
    return True


def merits(engine: str) -> list[str]:
    """Return the names of the built-in figures of merit."""
    named, _ = json.loads(schema(engine))["properties"]["merit"]["anyOf"]
    names: list[str] = named["enum"]
    return names

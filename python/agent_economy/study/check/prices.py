"""Checks of prices: a cost of teams is wrong if only some of their kinds have one."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from agent_economy import _core
from agent_economy.scenario import Scenario
from agent_economy.scenario.origin import with_origin
from agent_economy.study.design import Values
from agent_economy.study.teams import cost_of

MAX_NAMED = 5
"""Kinds that an error names individually."""


def price_errors(scenario: Scenario, configurations: Sequence[Values]) -> list[str]:
    """Return the error of a cost that counts prices, if kinds of the compared teams have none."""
    if scenario.engine == "classic" or "price" not in cost_of(scenario, scenario.cost).names:
        return []
    lacking = [
        path
        for path in kinds(scenario)
        if is_used(scenario, path, configurations) and not has_price(scenario, path)
    ]
    if not lacking:
        return []
    named = ", ".join(lacking[:MAX_NAMED])
    more = f" and {len(lacking) - MAX_NAMED} more" if len(lacking) > MAX_NAMED else ""
    where = with_origin(scenario.source, "study", "minimize")
    fault = f"{where} = {scenario.cost!r}: {named}{more} must have a price (0 if it costs nothing)"
    return [f"{fault}: give it one, or minimize robots"]


def kinds(scenario: Scenario) -> Iterator[str]:
    """Yield the paths of the kinds of robots and controllers."""
    yield from (f"robots.{kind}" for kind in scenario.robots)
    yield from (f"controllers.{kind}" for kind in scenario.controllers)


def is_used(scenario: Scenario, path: str, configurations: Sequence[Values]) -> bool:
    """Return whether a compared team may contain a kind."""
    group, kind = path.split(".")
    count = getattr(scenario, group)[kind]
    return any(float(each.get(f"{path}.count", count)) > 0 for each in configurations)


def has_price(scenario: Scenario, path: str) -> bool:
    """Return whether the price of a kind is stated, in its table, its models or the design."""
    group, kind = path.split(".")
    if any(factor.path in {f"{path}.price", f"{path}.model"} for factor in scenario.factors):
        return True
    if _core.read_filled(scenario.source)[group][kind].get("price"):
        return True
    document = scenario.to_dict()
    return any("price" in table for table in chain(document, document[group][kind]))


def chain(document: Mapping[str, Any], table: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield a table and the models of the scenario that it is based on."""
    models, seen = document.get("models", {}), set[str]()
    while True:
        yield table
        model = table.get("model")
        if model is None or model in seen or model not in models:
            return
        seen.add(model)
        table = models[model]

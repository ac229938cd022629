"""The teams of a study's configurations: which are compared, and what they cost."""

from collections.abc import Sequence

import numpy as np

from agent_economy._core import InputError
from agent_economy.scenario import Scenario
from agent_economy.study.arguments import Floats
from agent_economy.study.design import Values
from agent_economy.study.engine import Engine
from agent_economy.study.expression import NOT_FINITE, Expression
from agent_economy.study.paths import counted_kind


def compared(scenario: Scenario, configurations: Sequence[Values]) -> tuple[Values, ...]:
    """Return the configurations that `study.where` of a scenario allows.

    Raises:
        InputError: If the expression is invalid, or allows none.
    """
    if scenario.where is None:
        return tuple(configurations)
    expression = allowed_by(scenario, scenario.where)
    values = evaluated(expression, Engine(scenario, configurations, 0))
    allowed = tuple(
        each for each, value in zip(configurations, values.tolist(), strict=True) if value
    )
    if not allowed:
        why = f"allows none of {len(configurations):,} configurations: must allow one or more"
        raise expression.error(why)
    return allowed


def costs(engine: Engine, cost: str) -> Floats:
    """Return the cost of each configuration, shape (configurations,).

    Raises:
        InputError: If the expression is invalid.
    """
    if cost not in engine.costs:
        expression = cost_of(engine.scenario, cost)
        found = evaluated(expression, engine)
        if not np.isfinite(found).all():
            raise expression.error(NOT_FINITE)
        # Costs that are equal must not differ by the rounding of their sums.
        engine.costs[cost] = np.array([rounded(each) for each in found.tolist()])
    return engine.costs[cost]


def allowed_by(scenario: Scenario, where: str) -> Expression:
    """Return which configurations of a scenario are compared.

    Raises:
        InputError: If the expression is invalid.
    """
    return Expression("study.where", where, names(scenario), scenario.source)


def cost_of(scenario: Scenario, cost: str) -> Expression:
    """Return what a team of a scenario costs.

    Raises:
        InputError: If the expression is invalid.
    """
    return Expression("study.minimize", cost, names(scenario), scenario.source)


def names(scenario: Scenario) -> tuple[str, ...]:
    """Return the names that expressions may contain."""
    return (*scenario.robots, *scenario.controllers, "robots", "price")


def evaluated(expression: Expression, engine: Engine) -> Floats:
    """Return the value of an expression for each configuration."""
    values = [
        expression.value(team(engine, index, has_price="price" in expression.names))
        for index in range(len(engine.configurations))
    ]
    return np.array(values)


def team(engine: Engine, configuration: int, *, has_price: bool) -> dict[str, float]:
    """Return the values of the names of an expression for a configuration.

    Raises:
        InputError: If its team has no price, but needs one.
    """
    varied = {
        kind: float(value)
        for path, value in engine.configurations[configuration].items()
        if (kind := counted_kind(path)) is not None
    }
    scenario = engine.scenario
    counts = {kind: float(n) for kind, n in (scenario.robots | scenario.controllers).items()}
    values = counts | varied
    values["robots"] = sum(values[kind] for kind in scenario.robots)
    return values | {"price": price(engine, configuration)} if has_price else values


def price(engine: Engine, configuration: int) -> float:
    """Return the price of a configuration's team.

    Raises:
        InputError: If it has none.
    """
    low, high = engine.limits(configuration).get("price", (np.nan, np.nan))
    if low == high:
        return rounded(low)
    message = "price: the engine of this scenario has no prices: use robots, or kinds of robots"
    raise InputError(message)


def rounded(cost: float) -> float:
    """Return a cost or a price without the error of its sum, as all output states it."""
    return float(f"{cost:.12g}")

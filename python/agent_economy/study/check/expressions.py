"""Checks of the expressions and conditions of a scenario."""

from collections.abc import Callable

from agent_economy._core import InputError
from agent_economy.scenario import Scenario
from agent_economy.scenario.origin import with_origin
from agent_economy.study import teams
from agent_economy.study.check.arguments import raise_all
from agent_economy.study.engine import Engine

ROUNDING = 1e-12
"""What the sum of a probability and a tolerance may be off by."""


def expression_errors(scenario: Scenario) -> list[str]:
    """Return the errors of the expressions on teams."""
    where = scenario.where
    found = error_of(lambda: where is None or teams.allowed_by(scenario, where))
    if scenario.requirement is not None:
        found += error_of(lambda: teams.cost_of(scenario, scenario.cost))
    return found


def check_conditions(scenario: Scenario, engine: Engine) -> None:
    """Check that each condition of a requirement decides something, and any two of them together.

    Raises:
        InputError: If one does not; it lists all.
    """
    requirement = scenario.requirement
    if requirement is None:
        return
    kinds = {column.name: column.kind for column in engine.columns}
    limits = [engine.limits(each) for each in range(len(engine.configurations))]
    found = []
    for number, condition in enumerate(requirement.conditions):
        of_column = [each[condition.column] for each in limits]
        if fault := condition.triviality(of_column, kinds[condition.column]):
            found.append((number, f"{fault}: must be a condition that can hold and can fail"))
    for first, second in requirement.contradictions:
        other = requirement.conditions[first].text
        found.append((second, f"never holds together with {other!r}: change one of them"))
    texts = [condition.text for condition in requirement.conditions]
    lines = [
        f"{with_origin(scenario.source, 'require', 'all', number)} = {texts[number]!r}: {fault}"
        for number, fault in found
    ]
    raise_all(lines)


def tolerance_errors(scenario: Scenario) -> list[str]:
    """Return the error of a tolerance with which a single failure refutes a configuration."""
    requirement = scenario.requirement
    if requirement is None or requirement.probability + requirement.tolerance < 1 - ROUNDING:
        return []
    probability, tolerance = requirement.probability, requirement.tolerance
    where = with_origin(scenario.source, "require", "tolerance")
    fault = (
        f"{where} = {tolerance:g}: must be below {1 - probability:.12g}, which is 1 - probability"
    )
    return [f"{fault}: at 100%, a single mission that fails would refute a team"]


def error_of(check: Callable[[], object]) -> list[str]:
    """Return the message of the error that a check finds, if it finds one."""
    try:
        check()
    except InputError as error:
        return [str(error)]
    return []

"""Why runs are quarantined."""

from agent_economy import _core
from agent_economy.runs import factory
from agent_economy.scenario import Scenario


def reason(scenario: Scenario, seed: int, run: int) -> str:
    """Return why a run that is quarantined has no outcome."""
    try:
        factory.create(scenario, seed, run)
    except _core.NoRoomError as error:
        return str(error)
    return "a value of its outcome is not finite"

"""Beginning a run, of whatever engine, that is stepped by hand."""

from collections.abc import Callable

from agent_economy.classic_simulation import ClassicSimulation
from agent_economy.scenario import Scenario
from agent_economy.simulation import Simulation
from agent_economy.stepped import Stepped

ENGINES: dict[str, Callable[[Scenario, int, int], Stepped]] = {
    "metric": Simulation,
    "classic": ClassicSimulation,
}


def begun(scenario: Scenario, seed: int, run: int) -> Stepped:
    """Begin a run of a scenario's engine.

    Raises:
        InputError: If an argument is out of range, or the world has no room for the team or the
            items.
    """
    return ENGINES[scenario.engine](scenario, seed, run)

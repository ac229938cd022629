"""Creates the stepped run of a scenario, for any engine."""

from collections.abc import Callable

from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.external import External
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario

ENGINES: dict[str, Callable[[Scenario, int, int], Stepped]] = {
    "metric": Simulation,
    "classic": ClassicSimulation,
}


def create(scenario: Scenario, seed: int, run: int, external: External = ()) -> Stepped:
    """Create a run of a scenario's engine, at its first step.

    Args:
        scenario: The scenario.
        seed: Seed of all random numbers.
        run: Run number.
        external: Robots that have external bodies from the start; of the metric engine.

    Raises:
        InputError: If an argument is out of range, or the world has no room for the team or the
            items.
    """
    if external:
        return Simulation(scenario, seed, run, external=external)
    return ENGINES[scenario.engine](scenario, seed, run)

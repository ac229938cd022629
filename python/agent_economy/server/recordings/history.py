"""Everything that is needed to replay a run."""

from dataclasses import dataclass

from agent_economy.recording.replayer import InputsByTick
from agent_economy.runs.stepped import Change
from agent_economy.scenario import Scenario


@dataclass(frozen=True)
class RunHistory:
    """Everything that is needed to replay a run up to its latest tick.

    Attributes:
        scenario: The scenario at the beginning of the run.
        seed: The seed of all random streams.
        run: The number of the run.
        log: Changes of the scenario, in order.
        inputs: External percepts and commands by tick, as keyword arguments of `Simulation.step`.
        latest_tick: The last tick that was reached.
        external: Names of the robots that had external bodies from the start.
    """

    scenario: Scenario
    seed: int
    run: int
    log: tuple[Change, ...]
    inputs: InputsByTick
    latest_tick: int
    external: tuple[str, ...] = ()

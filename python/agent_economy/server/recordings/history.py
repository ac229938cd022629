"""Everything that is needed to replay a run."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from agent_economy.recording.replayer import InputsByTick
from agent_economy.runs.external import ExternalBody
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
        external: The bodies that were external from the start, by robot name.
    """

    scenario: Scenario
    seed: int
    run: int
    log: tuple[Change, ...]
    inputs: InputsByTick
    latest_tick: int
    external: Mapping[str, ExternalBody] = field(default_factory=dict)

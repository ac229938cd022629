"""The external inputs of a recorded step."""

from collections.abc import Mapping
from typing import NamedTuple

from agent_economy.runs.brain import Command, Percept


class ExternalInputs(NamedTuple):
    """The arguments of `Simulation.step`, by robot name; None if they are not given."""

    percepts: Mapping[str, Percept] | None = None
    observed: Mapping[str, Percept] | None = None
    commands: Mapping[str, Command] | None = None

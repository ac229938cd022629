"""The robots whose percepts, commands and scans are recorded, and how often."""

from collections.abc import Sequence
from dataclasses import dataclass

from agent_economy.scenario import validation


@dataclass(frozen=True)
class Selection:
    """Robots whose percepts, commands and scans are recorded.

    Attributes:
        robots: Their names, KIND/INDEX.
        every: Number of steps per recorded percept of a robot, 1 or more.
    """

    robots: tuple[str, ...] = ()
    every: int = 1


def selection_of(percepts: "Sequence[str] | Selection") -> Selection:
    """Return the robots of an argument, by default in each step.

    Raises:
        InputError: If it is not a list of names.
    """
    if isinstance(percepts, Selection):
        return percepts
    return Selection(tuple(validation.texts("percepts", percepts, "a list of robot names")))

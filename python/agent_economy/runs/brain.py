"""A robot's mind, for whoever has percepts of their own: live robots, other simulators, learning.

A brain takes percepts and returns commands, and has no other input or output: no clock, no files,
and no random numbers but the random words of the percept. The same percepts give the same commands.
Both are plain dicts, with the names and units of the scenario: metres, seconds and radians; angles
are anticlockwise from the robot's front unless stated otherwise.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypedDict, cast

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy.scenario import Scenario, as_scenario, validation
from agent_economy.types.brain import BeliefState, Body, Command, Percept, Point

__all__ = [
    "BeliefState",
    "BelievedMap",
    "Body",
    "Brain",
    "Command",
    "Percept",
    "Watched",
    "schemas",
]


class Watched(TypedDict):
    """What a robot perceived in one step, what its brain made of it, and why.

    Attributes:
        tick: Steps of the run before that one.
        percept: What it perceived.
        command: What it decided.
        leading: Place in the brain's list of the behaviour that has its way; None if nothing is to
            be done, or all count together.
        holds_s: For so long each behaviour keeps control though it has nothing to do.
        thoughts: What it believes and wants then; None if it has no mind.
    """

    tick: int
    percept: Percept
    command: Command
    leading: int | None
    holds_s: list[float]
    thoughts: BeliefState | None


class BelievedMap(TypedDict):
    """What a robot believes to fill its mission's field, and where it has not looked.

    Attributes:
        corner: Where the first cell's least corner is, in the world.
        cell_m: Width of a cell.
        occupancy: How likely each cell is filled, in percent; -1 where nothing says either. Shape
            (rows, columns), the lowest row first.
        unseen: How likely an item in each cell would not have been seen, in percent; same shape.
    """

    corner: Point
    cell_m: float
    occupancy: NDArray[np.int8]
    unseen: NDArray[np.uint8]


class Brain:
    """The mind of one robot.

    Args:
        spec: What a scenario says under `[robots.KIND.brain]`; None for the default brain, which
            searches: ahead, at obstacles a random turn, and out of the way of what is too near.
        body: What it knows of its body. None in either is as if it were left out.

    Raises:
        InputError: If anything in either is wrong; all faults at once.

    Example:
        >>> from agent_economy import Brain
        >>> rover = {"radius_m": 0.25, "max_speed_m_s": 1, "max_turn_rate_rad_s": 1.5,
        ...          "period_s": 0.1}
        >>> Brain(None, rover).step({})["motion"]
        {'speed_m_s': 1.0, 'turn_rate_rad_s': 0.0}
    """

    def __init__(self, spec: Mapping[str, Any] | None, body: Body) -> None:
        """Make a mind that has just been switched on."""
        self._mind = _core.Brain({} if spec is None else spec, body)

    @classmethod
    def of(cls, scenario: Scenario | str | Path, kind: str) -> "Brain":
        """Return a brain as a scenario's robots of a kind have it, in their body.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of one that ships.
            kind: Name of a kind of robots.

        Raises:
            InputError: If the scenario is wrong or of another engine, or has no such kind.
        """
        validation.of_kind("kind", kind, str, "the name of a kind of robots")
        brain = cls.__new__(cls)
        vars(brain)["_mind"] = _core.Brain.of(as_scenario(scenario).metric(), kind)
        return brain

    def step(self, percept: Percept) -> Command:
        """Return what the robot is to do; to be called once in each of the body's periods.

        Raises:
            InputError: If the percept has a wrong name, or something of a wrong kind.
        """
        return cast("Command", self._mind.step(percept))

    def thoughts(self) -> BeliefState | None:
        """Return what it believes and wants, as of its last step.

        Returns:
            None if it has no mind: neither beliefs, nor a behaviour that needs them.
        """
        return cast("BeliefState | None", self._mind.thoughts())

    def copy(self) -> "Brain":
        """Return a brain with the same memories, which then goes its own way."""
        brain = Brain.__new__(Brain)
        vars(brain)["_mind"] = self._mind.copy()
        return brain


def schemas() -> dict[str, dict[str, Any]]:
    """Return the JSON Schemas of brains, for other languages.

    They are those of all that enters and leaves one, BrainSpec, Body, Percept and Command, and of
    BeliefState.
    """
    return _core.Brain.schemas()

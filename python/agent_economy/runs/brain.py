"""The brain of one robot, for percepts of your own: real robots, other simulators, learning.

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
from agent_economy.types.brain import (
    AssignedGoal,
    BeliefState,
    Body,
    Command,
    Percept,
    Point,
    ServedGoal,
)

__all__ = [
    "AssignedGoal",
    "BeliefState",
    "BelievedMap",
    "Body",
    "Brain",
    "Command",
    "Inspection",
    "Percept",
    "ServedGoal",
    "schemas",
]


class Inspection(TypedDict):
    """The percept and the decision of a robot in one step, with the reasons.

    Attributes:
        tick: Number of steps of the run before that step.
        percept: The percept.
        command: The command.
        leading: Index of the active behaviour in the brain's list; None if there is nothing to do,
            or if all behaviours are blended.
        holds_s: Remaining hold time of each behaviour.
        belief_state: Its beliefs and goals; None if its brain has no beliefs.
    """

    tick: int
    percept: Percept
    command: Command
    leading: int | None
    holds_s: list[float]
    belief_state: BeliefState | None


class BelievedMap(TypedDict):
    """The map that a robot believes, of the area of its mission.

    Attributes:
        corner: Corner of the first cell with the smallest x and y, in world coordinates.
        cell_m: Width of a cell.
        occupancy: Probability that each cell is occupied, in percent; -1 where it is unknown.
            Shape (rows, columns), the row with the smallest y first.
        unseen: Probability that an item in each cell was not detected, in percent; same shape.
    """

    corner: Point
    cell_m: float
    occupancy: NDArray[np.int8]
    unseen: NDArray[np.uint8]


class Brain:
    """The brain of one robot, for percepts of your own.

    Args:
        spec: The brain as in `[robots.KIND.brain]` of a scenario; None for the default brain,
            which goes straight ahead, turns by a random angle at obstacles, and avoids what is
            near.
        body: The body. An entry that is None counts as omitted, here and in `spec`.

    Raises:
        InputError: If there are errors in either; it lists all of them.

    Example:
        >>> from agent_economy import Brain
        >>> rover = {"radius_m": 0.25, "max_speed_m_s": 1, "max_turn_rate_rad_s": 1.5,
        ...          "period_s": 0.1}
        >>> Brain(None, rover).step({})["motion"]
        {'speed_m_s': 1.0, 'turn_rate_rad_s': 0.0}
    """

    def __init__(self, spec: Mapping[str, Any] | None, body: Body) -> None:
        """Create a brain in its initial state."""
        spec = validation.plain_value("spec", {} if spec is None else spec)
        self._brain = _core.Brain(spec, validation.plain_value("body", body))

    @classmethod
    def of(cls, scenario: Scenario | str | Path, kind: str) -> "Brain":
        """Return the brain of a robot kind of a scenario, in its body.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of a bundled one.
            kind: Name of the robot kind.

        Raises:
            InputError: If the scenario has errors, is of another engine, or has no such kind.
        """
        validation.of_type("kind", kind, str, "the name of a robot kind")
        brain = cls.__new__(cls)
        vars(brain)["_brain"] = _core.Brain.of(as_scenario(scenario).metric(), kind)
        return brain

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept.

        Percepts may come at any times: timers and the believed pose follow their `time_s`. A
        percept that is not later than the previous one changes nothing, and repeats the last
        motion.

        Raises:
            InputError: If an entry of the percept is unknown or has an invalid value.
        """
        return cast("Command", self._brain.step(validation.plain_value("percept", percept)))

    def belief_state(self) -> BeliefState | None:
        """Return the beliefs and goals of the brain, as of its last step.

        Returns:
            None if the brain has no beliefs.
        """
        return cast("BeliefState | None", self._brain.belief_state())

    def assigned_goals(self) -> list[AssignedGoal]:
        """Return the goals that a person has assigned, as of the last step.

        They are in the order of assignment, each with its verdict.

        Returns:
            An empty list if there are none, or no behaviour of the brain takes orders.
        """
        return cast("list[AssignedGoal]", self._brain.assigned_goals())

    def served_goals(self) -> list[ServedGoal]:
        """Return the goals of controllers that the robot has leases of, as of the last step.

        They are in the order in which it serves them, each with its owner, the remaining time of
        the lease on the robot's clock, and its verdict.

        Returns:
            An empty list if there are none, or the brain has no behaviour `serve`.
        """
        return cast("list[ServedGoal]", self._brain.served_goals())

    def copy(self) -> "Brain":
        """Return an independent copy in the same state."""
        brain = Brain.__new__(Brain)
        vars(brain)["_brain"] = self._brain.copy()
        return brain


def schemas() -> dict[str, dict[str, Any]]:
    """Return the JSON Schemas of brains, for other languages.

    By name: `BrainSpec`, `Body`, `Percept`, `Command`, `BeliefState` and `AssignedGoal`.
    """
    return _core.Brain.schemas()

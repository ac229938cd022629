"""Brains and controllers in Python that replace those of a scenario."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Protocol, TypeAlias, cast

from agent_economy import _core
from agent_economy.runs.batch import Batch, Commands, Inbox, Percepts
from agent_economy.runs.brain import Body, Command, Percept
from agent_economy.runs.commands import plain_columns, plain_command
from agent_economy.runs.controller import ControllerSettings
from agent_economy.scenario import Scenario, validation

BY_KIND = "a dict by the names of kinds of robots or controllers"
FACTORY = "a Batch, or a class or function that returns a robot's brain when called with its body"
CONTROLLER = "a class or function that returns a controller when called with its settings"
RETURNS = "a class or function that returns objects with a step method"


class BrainLike(Protocol):
    """An object that decides for one robot, such as `Brain`, or one controller (`Controller`)."""

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""


Make: TypeAlias = Callable[[Body], BrainLike] | Callable[[ControllerSettings], BrainLike]
"""A class or function that returns the brain of a robot when called with its body.

That of a controller is called with its settings.
"""

Brains: TypeAlias = Mapping[str, Make | Batch]
"""By kind: what makes the brain of each robot or controller, or one brain for all robots."""


@dataclass(frozen=True)
class SingleBrains:
    """One brain for each robot or controller of a kind.

    Attributes:
        kind: Name of the kind.
        make: Makes a brain.
        brains: The brains by the index of their robot or controller.
    """

    kind: str
    make: Make
    brains: tuple[BrainLike, ...] = ()
    is_in_arrays: ClassVar[bool] = False

    def resized(self, body: Body, count: int) -> "SingleBrains":
        """Return the same for `count` robots: existing brains are kept, missing ones are made."""
        missing = range(len(self.brains), count)
        # Each brain gets a body of its own, which it may modify.
        text = json.dumps(body)
        made = tuple(self._make(index, json.loads(text)) for index in missing)
        return replace(self, brains=self.brains[:count] + made)

    def step(self, index: int, percept: Percept) -> Command:
        """Return the command of a robot or controller."""
        time_s = percept["time_s"]
        try:
            command = self.brains[index].step(percept)
        except Exception as error:
            error.add_note(f"in the brain of {self.kind}/{index}, at {time_s:g} s")
            raise
        return cast("Command", plain_command(f"{self.kind}/{index}", command))

    def _make(self, index: int, body: Body) -> BrainLike:
        try:
            brain = cast("Callable[[Any], BrainLike]", self.make)(body)
        except Exception as error:
            error.add_note(f"while making the brain of {self.kind}/{index} from its body")
            raise
        is_brain = callable(getattr(brain, "step", None))
        validation.check(is_brain, f"brains.{self.kind}", brain, RETURNS)
        return brain


@dataclass(frozen=True)
class BatchBrain:
    """One brain for all robots of a kind.

    Attributes:
        kind: Name of the kind.
        batch: The brain.
        memory: The memory of the brain.
        constants: Entries of its percepts that are the same in each step.
    """

    kind: str
    batch: Batch
    memory: dict[str, Any] = field(default_factory=dict)
    constants: dict[str, Any] = field(default_factory=dict)
    is_in_arrays: ClassVar[bool] = True

    def resized(self, body: Body, count: int) -> "BatchBrain":
        """Return the same for `count` robots."""
        return replace(self, constants={"body": body, "count": count})

    def step(self, percepts: dict[str, Any]) -> Commands:
        """Return the commands of the robots that step."""
        time_s = percepts["time_s"]
        inbox = Inbox(percepts["inbox"])
        complete = cast("Percepts", self.constants | percepts | {"inbox": inbox})
        rows = len(complete["robots"])
        try:
            commands = self.batch.function(complete, self.memory)
        except Exception as error:
            error.add_note(f"in the brain of all robots of kind {self.kind}, at {time_s:g} s")
            raise
        return cast("Commands", plain_columns(f"brains.{self.kind}()", commands, rows))


PythonBrains: TypeAlias = SingleBrains | BatchBrain
"""The Python brains of a robot kind."""


def python_brains(brains: Brains | None, scenario: Scenario) -> list[PythonBrains]:
    """Return the Python brains of some kinds, for a new run.

    Raises:
        InputError: If a kind does not exist, or its brains cannot be made.
    """
    if brains is None:
        return []
    return resized(unmade(brains, scenario), scenario)


def unmade(brains: Brains, scenario: Scenario) -> list[PythonBrains]:
    """Return the Python brains of kinds that have no robots or controllers yet.

    Raises:
        InputError: If something cannot be a brain.
    """
    validation.of_type("brains", brains, Mapping, BY_KIND)
    every = [without_robots(*each) for each in brains.items()]
    for each in every:
        is_allowed = not (each.is_in_arrays and each.kind in scenario.controllers)
        validation.check(is_allowed, f"brains.{each.kind}", brains[each.kind], CONTROLLER)
    return every


def without_robots(kind: str, make: Make | Batch) -> PythonBrains:
    """Return the Python brains of a kind that has no robots yet."""
    validation.of_type("brains", kind, str, BY_KIND)
    if isinstance(make, Batch):
        return BatchBrain(kind, make)
    validation.check(callable(make), f"brains.{kind}", make, FACTORY)
    return SingleBrains(kind, make)


def resized(brains: list[PythonBrains], scenario: Scenario) -> list[PythonBrains]:
    """Return the brains for a team: robots of the old team keep theirs, others get new ones.

    Raises:
        InputError: If a kind does not exist.
    """
    metric, counts = scenario.metric(), scenario.robots | scenario.controllers
    bodies = [cast("Body", _core.body(metric, "brains", each.kind)) for each in brains]
    pairs = zip(brains, bodies, strict=True)
    return [each.resized(body, counts[each.kind]) for each, body in pairs]

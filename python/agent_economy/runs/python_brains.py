"""Brains and controllers in Python that replace those of a scenario."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import partial
from typing import Any, ClassVar, Protocol, TypeAlias, cast

from agent_economy import _core
from agent_economy.runs.batch import Batch, Commands, Inbox, Percepts
from agent_economy.runs.brain import Body, Command, Percept
from agent_economy.runs.commands import plain_columns, plain_command
from agent_economy.runs.controller import ControllerSettings
from agent_economy.scenario import Scenario, validation

RETURNS = "a class or function that returns objects with a step method"


class BrainLike(Protocol):
    """An object that decides for one robot, such as `Brain`, or one controller (`Controller`)."""

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""


MakeBrain: TypeAlias = Callable[[Body], BrainLike]
"""A class or function that returns the brain of a robot when called with its body."""

MakeController: TypeAlias = Callable[[ControllerSettings], BrainLike]
"""A class or function that returns a controller when called with its settings."""

Brains: TypeAlias = Mapping[str, MakeBrain | Batch]
"""By kind of robots: what makes the brain of each robot, or one brain for all robots."""

Controllers: TypeAlias = Mapping[str, MakeController]
"""By kind of controllers: what makes each controller."""


@dataclass(frozen=True)
class Parameter:
    """A parameter that replaces the brains of robots, or controllers.

    Attributes:
        name: Its name.
        agents: What it replaces, as scenarios name it.
        allowed: What it maps a kind to.
        called: What is made for a robot or controller, in words before its name.
        argument: What makes it is called with this.
    """

    name: str
    agents: str
    allowed: str
    called: str
    argument: str

    @property
    def by_kind(self) -> str:
        """What it must be."""
        return f"a dict by the names of kinds of {self.agents}"


BRAINS = Parameter(
    "brains",
    "robots",
    "a Batch, or a class or function that returns a robot's brain when called with its body",
    "the brain of",
    "its body",
)
CONTROLLERS = Parameter(
    "controllers",
    "controllers",
    "a class or function that returns a controller when called with its settings",
    "the controller",
    "its settings",
)
PARAMETERS = {each.name: each for each in (BRAINS, CONTROLLERS)}


@dataclass(frozen=True)
class SingleBrains:
    """One brain for each robot or controller of a kind.

    Attributes:
        parameter: The parameter that maps the kind to `make`.
        kind: Name of the kind.
        make: Makes a brain.
        brains: The brains by the index of their robot or controller.
    """

    parameter: Parameter
    kind: str
    make: MakeBrain | MakeController
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
            error.add_note(f"in {self.parameter.called} {self.kind}/{index}, at {time_s:g} s")
            raise
        at = f'{self.parameter.name}."{self.kind}/{index}".step()'
        return cast("Command", plain_command(at, command))

    def _make(self, index: int, body: Body) -> BrainLike:
        try:
            brain = cast("Callable[[Any], BrainLike]", self.make)(body)
        except Exception as error:
            name = f"{self.parameter.called} {self.kind}/{index}"
            error.add_note(f"while making {name} from {self.parameter.argument}")
            raise
        is_brain = callable(getattr(brain, "step", None))
        validation.check(is_brain, f"{self.parameter.name}.{self.kind}", brain, RETURNS)
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
    parameter: ClassVar[Parameter] = BRAINS
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
"""The Python brains of a kind of robots or controllers."""


def python_brains(
    brains: Brains | None, controllers: Controllers | None, scenario: Scenario
) -> list[PythonBrains]:
    """Return the Python brains of some kinds, for a new run.

    Raises:
        InputError: If a kind does not exist, or its brains cannot be made; it lists all errors.
    """
    given = {"brains": brains, "controllers": controllers}
    calls = (partial(unmade, name, each, scenario) for name, each in given.items())
    found = validation.all_of(calls)
    return resized([each for several in found for each in several], scenario)


def unmade(
    name: str, agents: Brains | Controllers | None, scenario: Scenario
) -> list[PythonBrains]:
    """Return the Python brains of a parameter for kinds without robots or controllers yet.

    Raises:
        InputError: If a kind does not exist, or what it has cannot make brains; it lists all
            errors.
    """
    if agents is None:
        return []
    parameter = PARAMETERS[name]
    validation.of_type(name, agents, Mapping, parameter.by_kind)
    calls = (partial(unmade_kind, parameter, kind, agents[kind], scenario) for kind in agents)
    return validation.all_of(calls)


def unmade_kind(parameter: Parameter, kind: str, make: Any, scenario: Scenario) -> PythonBrains:
    """Return those of one kind.

    Raises:
        InputError: As `unmade`.
    """
    validation.of_type(parameter.name, kind, str, parameter.by_kind)
    check_kind(parameter, kind, scenario)
    if parameter is BRAINS and isinstance(make, Batch):
        return BatchBrain(kind, make)
    validation.check(callable(make), f"{parameter.name}.{kind}", make, parameter.allowed)
    return SingleBrains(parameter, kind, make)


def check_kind(parameter: Parameter, kind: str, scenario: Scenario) -> None:
    """Check that a kind is one of those that a parameter replaces.

    Raises:
        InputError: If it does not exist, or is of the other parameter, which the error names.
    """
    kinds = {"brains": list(scenario.robots), "controllers": list(scenario.controllers)}
    own, other = kinds[parameter.name], CONTROLLERS if parameter is BRAINS else BRAINS
    near = get_close_matches(kind, own, 1)
    none = f"left out: the scenario has no {parameter.agents}"
    allowed = f"one of {', '.join(map(repr, own))}" if own else none
    if kind in kinds[other.name]:
        allowed += f"; it is a kind of {other.agents}: use {other.name}={{{kind!r}: ...}}"
    elif near:
        allowed += f"; did you mean {near[0]!r}?"
    validation.check(kind in own, parameter.name, kind, allowed)


def resized(brains: list[PythonBrains], scenario: Scenario) -> list[PythonBrains]:
    """Return the brains for a team: robots of the old team keep theirs, others get new ones.

    Raises:
        InputError: If a kind does not exist.
    """
    if not brains:
        return []
    metric, counts = scenario.metric(), scenario.robots | scenario.controllers
    bodies = [cast("Body", _core.body(metric, each.parameter.name, each.kind)) for each in brains]
    pairs = zip(brains, bodies, strict=True)
    return [each.resized(body, counts[each.kind]) for each, body in pairs]

"""Brains in Python, in place of those that a scenario's robots have."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Protocol, TypeAlias, cast

from agent_economy import _core
from agent_economy.runs.batch import Batch, Percepts
from agent_economy.runs.brain import Body, Command, Percept
from agent_economy.runs.commands import Commands, commands
from agent_economy.scenario import validation

BY_KIND = "a dict by the names of kinds of robots"
MAKES = "a Batch, or a class or function that makes a robot's brain when it is called with its body"


class BrainLike(Protocol):
    """Whatever decides for one robot; `Brain` is one."""

    def step(self, percept: Percept) -> Command:
        """Return what the robot is to do."""


Make: TypeAlias = Callable[[Body], BrainLike]
"""A class or function that makes the brain of a robot when it is called with its body."""

Brains: TypeAlias = Mapping[str, Make | Batch]
"""What makes the brains of robots, or is the brain of all, by kind."""


@dataclass(frozen=True)
class Each:
    """A brain for each robot of a kind.

    Attributes:
        kind: Name of the kind.
        make: What makes its brains.
        brains: Of the robots, in their order.
    """

    kind: str
    make: Make
    brains: tuple[BrainLike, ...] = ()
    is_in_arrays: ClassVar[bool] = False

    def of(self, body: Body, count: int) -> "Each":
        """Return the same for so many robots: those that are there, and new ones."""
        news = range(len(self.brains), count)
        made = tuple(self._made(index, body) for index in news)
        return replace(self, brains=self.brains[:count] + made)

    def step(self, index: int, percept: Percept) -> Command:
        """Return what a robot is to do."""
        time_s = percept["time_s"]
        try:
            return self.brains[index].step(percept)
        except Exception as error:
            error.add_note(f"in the brain of {self.kind}/{index}, at {time_s:g} s")
            raise

    def _made(self, index: int, body: Body) -> BrainLike:
        try:
            brain = self.make(body)
        except Exception as error:
            error.add_note(f"when the brain of {self.kind}/{index} was made of its body")
            raise
        is_brain = callable(getattr(brain, "step", None))
        validation.check(is_brain, f"brains.{self.kind}", brain, "what makes objects with a step")
        return brain


@dataclass(frozen=True)
class All:
    """A brain for all robots of a kind at once.

    Attributes:
        kind: Name of the kind.
        batch: What decides.
        memory: What it remembers.
        always: What is in its percepts besides what robots perceive.
    """

    kind: str
    batch: Batch
    memory: dict[str, Any] = field(default_factory=dict)
    always: dict[str, Any] = field(default_factory=dict)
    is_in_arrays: ClassVar[bool] = True

    def of(self, body: Body, count: int) -> "All":
        """Return the same for so many robots."""
        return replace(self, always={"body": body, "count": count})

    def step(self, percepts: dict[str, Any]) -> Commands:
        """Return what robots are to do."""
        time_s, robots = percepts["time_s"], len(percepts["robots"])
        whole = cast("Percepts", self.always | percepts)
        try:
            told = self.batch.function(whole, self.memory)
        except Exception as error:
            error.add_note(f"in the brain of all of {self.kind}, at {time_s:g} s")
            raise
        return commands(f"brains.{self.kind}()", told, robots)


Mind: TypeAlias = Each | All
"""What decides for the robots of a kind."""


def minds(
    brains: Brains | None, metric: _core.MetricScenario, robots: Mapping[str, int]
) -> list[Mind]:
    """Return what decides for the robots of some kinds, at the beginning of a run.

    Raises:
        InputError: If there is no such kind of robots, or nothing that makes brains.
    """
    if brains is None:
        return []
    validation.of_kind("brains", brains, Mapping, BY_KIND)
    return changed_minds([mind(*each) for each in brains.items()], metric, robots)


def mind(kind: str, make: Make | Batch) -> Mind:
    """Return what decides for the robots of a kind, before there are any."""
    validation.of_kind("brains", kind, str, BY_KIND)
    if isinstance(make, Batch):
        return All(kind, make)
    validation.check(callable(make), f"brains.{kind}", make, MAKES)
    return Each(kind, make)


def changed_minds(
    minds: list[Mind], metric: _core.MetricScenario, robots: Mapping[str, int]
) -> list[Mind]:
    """Return what decides from now on: robots that stay keep their brains, others get new ones.

    Raises:
        InputError: If there is no such kind of robots.
    """
    bodies = [cast("Body", _core.body(metric, "brains", mind.kind)) for mind in minds]
    return [mind.of(body, robots[mind.kind]) for mind, body in zip(minds, bodies, strict=True)]

"""What runs have in common that are stepped by hand and changed on the way, of either engine."""

from typing import Any, NamedTuple, Protocol

from agent_economy.outcome import Outcome
from agent_economy.scenario import Given, Scenario
from agent_economy.thoughts import Thoughts


class Change(NamedTuple):
    """A value that was put into a scenario in the middle of a run.

    Attributes:
        tick: Steps that had been taken.
        path: Keys from the scenario's root, with dots between.
        value: What was put there.
    """

    tick: int
    path: str
    value: Given


class Stepped(Protocol):
    """A run that is stepped by hand: `Simulation` and `ClassicSimulation` are such."""

    @property
    def scenario(self) -> Scenario:
        """What the run is of, with all changes so far."""

    @property
    def seed(self) -> int:
        """Of all chance."""

    @property
    def run(self) -> int:
        """Its number."""

    @property
    def changes(self) -> tuple[Change, ...]:
        """What was changed, in order: with it a run can be taken again."""

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, KIND/INDEX."""

    @property
    def tick(self) -> int:
        """Steps that have been taken."""

    @property
    def step_s(self) -> float:
        """Time in the world that a step takes."""

    @property
    def time_s(self) -> float:
        """Time in the world that all steps took."""

    @property
    def is_over(self) -> bool:
        """Whether nothing more can come."""

    @property
    def hash(self) -> int:
        """A number of 64 bits that tells runs apart that differ in anything that shows."""

    def step(self, steps: int = 1) -> Any:
        """Take steps."""

    def change(self, path: str, value: Given) -> None:
        """Put a value into the scenario, and go on with that."""

    def outcome(self) -> Outcome:
        """Return what the run has given so far."""

    def thoughts(self, robot: str) -> Thoughts | None:
        """Return what a robot believes and wants; None if it has no mind."""

    def snapshot(self) -> Any:
        """Return the whole run as it is now."""

    def restore(self, snapshot: Any) -> None:
        """Be the run that a snapshot is of."""

"""What runs have in common that are stepped by hand and changed on the way, of either engine."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from threading import RLock
from typing import Any, NamedTuple, Protocol

from agent_economy.runs.outcome import Columns, Outcome, so_far
from agent_economy.scenario import Scenario, TomlValue
from agent_economy.types.brain import BeliefState


class Change(NamedTuple):
    """A value that was put into a scenario in the middle of a run.

    Attributes:
        tick: Steps that had been taken.
        path: Keys from the scenario's root, with dots between.
        value: What was put there.
    """

    tick: int
    path: str
    value: TomlValue


class Inside(Protocol):
    """What of a run is compiled, of either engine; its properties are those of `Stepped`."""

    @property
    def columns(self) -> Columns: ...  # noqa: D102
    @property
    def tick(self) -> int: ...  # noqa: D102
    @property
    def step_s(self) -> float: ...  # noqa: D102
    @property
    def time_s(self) -> float: ...  # noqa: D102
    @property
    def is_over(self) -> bool: ...  # noqa: D102
    @property
    def hash(self) -> int: ...  # noqa: D102
    def outcome(self) -> Mapping[str, float] | None: ...  # noqa: D102


class Stepped(ABC):
    """A run that is stepped by hand: `Simulation` and `ClassicSimulation` are such.

    Threads may share one; each call waits until another thread's is done.

    Attributes:
        scenario: What the run is of, with all changes so far.
        seed: Of all chance.
        run: Its number.
    """

    scenario: Scenario
    seed: int
    run: int
    _run: Inside

    def __init__(self, scenario: Scenario, seed: int, run: int) -> None:
        """Begin without changes."""
        self.scenario, self.seed, self.run = scenario, seed, run
        self._changes: tuple[Change, ...] = ()
        self._lock = RLock()

    def __repr__(self) -> str:
        """Return which run it is, and where."""
        which = f"{self.scenario.name!r}, seed={self.seed}, run={self.run}"
        return f"<{type(self).__name__} of {which}: tick {self.tick}>"

    @property
    @abstractmethod
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, KIND/INDEX."""

    @abstractmethod
    def step(self, steps: int = 1) -> Any:
        """Take steps."""

    @abstractmethod
    def change(self, path: str, value: TomlValue) -> None:
        """Put a value into the scenario, and go on with that."""

    @abstractmethod
    def belief_state(self, robot: str) -> BeliefState | None:
        """Return what a robot believes and wants; None if it has no mind."""

    @abstractmethod
    def snapshot(self) -> Any:
        """Return the whole run as it is now."""

    @abstractmethod
    def restore(self, snapshot: Any) -> None:
        """Be the run that a snapshot is of."""

    def outcome(self) -> Outcome:
        """Return what the run has given so far; once it is over, what `run` returns."""
        with self._lock:
            columns, told = self._run.columns, self._run.outcome()
            is_over, merit = self._run.is_over, self.scenario.merit
        return so_far(columns, told or {}, merit, self.run, None if is_over else "running")

    @property
    def changes(self) -> tuple[Change, ...]:
        """What was changed, in order: with it a run can be taken again."""
        return self._changes

    @property
    def tick(self) -> int:
        """Steps that have been taken."""
        return self._run.tick

    @property
    def step_s(self) -> float:
        """Time in the world that one takes."""
        return self._run.step_s

    @property
    def time_s(self) -> float:
        """Time in the world that they took; of the classic engine's, as its clock goes now."""
        return self._run.time_s

    @property
    def is_over(self) -> bool:
        """Whether nothing more can come."""
        return self._run.is_over

    @property
    def hash(self) -> int:
        """A number of 64 bits that tells runs apart that differ in anything that shows."""
        return self._run.hash

"""The common base of interactive runs of both engines: they step and take changes."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from threading import RLock
from typing import Any, NamedTuple, Protocol

from agent_economy.runs.outcome import Columns, Outcome, Status, outcome_of
from agent_economy.scenario import Scenario, TomlValue
from agent_economy.types.brain import BeliefState


class Change(NamedTuple):
    """A change of a scenario during a run.

    Attributes:
        tick: Number of steps before the change.
        path: Keys from the scenario's root, separated by dots.
        value: The new value.
    """

    tick: int
    path: str
    value: TomlValue


class CompiledRun(Protocol):
    """The compiled part of a run, of either engine; its properties are those of `Stepped`."""

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
    """An interactive run: the base of `Simulation` and `ClassicSimulation`.

    Threads may share a run; each call waits until that of another thread has returned.

    Attributes:
        scenario: The scenario, with all changes made during the run.
        seed: Seed of all random numbers.
        run: Run number.
    """

    scenario: Scenario
    seed: int
    run: int
    _run: CompiledRun

    def __init__(self, scenario: Scenario, seed: int, run: int) -> None:
        """Create a run without changes."""
        self.scenario, self.seed, self.run = scenario, seed, run
        self._changes: tuple[Change, ...] = ()
        self._lock = RLock()

    def __repr__(self) -> str:
        """Return the scenario, seed, run number and current step."""
        which = f"{self.scenario.name!r}, seed={self.seed}, run={self.run}"
        return f"<{type(self).__name__} of {which}: tick {self.tick}>"

    @property
    @abstractmethod
    def robots(self) -> tuple[str, ...]:
        """Names of the robots, KIND/INDEX."""

    @abstractmethod
    def step(self, steps: int = 1) -> Any:
        """Advance the run."""

    @abstractmethod
    def change(self, path: str, value: TomlValue) -> None:
        """Change a value of the scenario, and continue with it."""

    @abstractmethod
    def belief_state(self, robot: str) -> BeliefState | None:
        """Return what a robot believes and its goals; None if its brain has no beliefs."""

    @abstractmethod
    def snapshot(self) -> Any:
        """Return a copy of the complete state of the run."""

    @abstractmethod
    def restore(self, snapshot: Any) -> None:
        """Return to the state of a snapshot."""

    def outcome(self) -> Outcome:
        """Return the outcome at the current step; at the end of the run, it is that of `run`."""
        with self._lock:
            columns, values = self._run.columns, self._run.outcome()
            is_over, merit = self._run.is_over, self.scenario.merit
        status: Status | None = None if is_over else "running"
        return outcome_of(columns, values or {}, merit, self.run, status)

    @property
    def changes(self) -> tuple[Change, ...]:
        """The changes in order.

        A run can be replayed from them, its initial scenario, its seed and its run number.
        """
        return self._changes

    @property
    def tick(self) -> int:
        """Number of steps taken."""
        return self._run.tick

    @property
    def step_s(self) -> float:
        """Simulated time per step, in seconds."""
        return self._run.step_s

    @property
    def time_s(self) -> float:
        """Simulated time in seconds; of the classic engine, at the current paints per second."""
        return self._run.time_s

    @property
    def is_over(self) -> bool:
        """Whether the run has ended."""
        return self._run.is_over

    @property
    def hash(self) -> int:
        """A 64-bit hash of the state: equal for runs without a visible difference."""
        return self._run.hash

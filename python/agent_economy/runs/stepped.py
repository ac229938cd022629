"""The common base of interactive runs of both engines: they step and take changes."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from threading import RLock
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from agent_economy._core import InputError
from agent_economy.runs.external import ExternalBody
from agent_economy.runs.outcome import Outcome, Status, outcome_of
from agent_economy.scenario import Scenario, TomlValue, validation
from agent_economy.types.brain import BeliefState

if TYPE_CHECKING:
    from agent_economy import _core


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


@dataclass(frozen=True)
class Snapshot:
    """The state of a run at one step, for `restore` of the same run in this process.

    That is any run that began with the same scenario, seed, run number and external bodies; its
    changes may differ. It cannot be pickled. To keep a run, store its scenario, seed, run number
    and `changes`, and step again.
    """

    scenario: Scenario
    seed: int
    run: int
    changes: tuple[Change, ...]
    _external: Mapping[str, ExternalBody] = field(repr=False)
    _initial: Scenario = field(repr=False)
    _state: Any = field(repr=False)

    @property
    def bytes(self) -> int:
        """Memory that it takes, in bytes, besides its scenario, which it shares with the run."""
        return int(self._state.bytes)


class Stepped(ABC):
    """An interactive run: the base of `Simulation` and `ClassicSimulation`.

    Threads may share a run; each call waits until that of another thread has returned.

    Attributes:
        scenario: The scenario, with all changes made during the run.
        seed: Seed of all random numbers.
        run: Run number.
        declared_external: The bodies that were external from the start, by robot name, sorted.
    """

    scenario: Scenario
    seed: int
    run: int
    declared_external: Mapping[str, ExternalBody]
    _run: "_core.CompiledRun"
    _state_type: ClassVar[type]

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        run: int,
        external: Mapping[str, ExternalBody] | None = None,
    ) -> None:
        """Create a run without changes."""
        self.scenario = scenario
        self.seed = validation.plain_value("seed", seed)
        self.run = validation.plain_value("run", run)
        self.declared_external = {} if external is None else external
        self._initial = scenario
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
    def hash_decisions(self, start: int = 0) -> None:
        """Hash all decisions from now on: see `decision_hash`."""

    @property
    @abstractmethod
    def decision_hash(self) -> int | None:
        """A 64-bit hash of all decisions since `hash_decisions`; None if there is none."""

    def snapshot(self) -> Snapshot:
        """Return a copy of the complete state of the run. It takes as much memory as the run."""
        with self._lock:
            state = self._run.snapshot()
            begun = self.scenario, self.seed, self.run
            return Snapshot(*begun, self._changes, self.declared_external, self._initial, state)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot: its state, its scenario and its changes.

        Raises:
            InputError: If `snapshot` is not a snapshot of this run: of one that began with the same
                scenario, seed, run number and external bodies.
        """
        state = getattr(snapshot, "_state", None)
        is_own = isinstance(state, self._state_type)
        validation.check(is_own, "snapshot", snapshot, "what snapshot() returned")
        self._check_same_run(snapshot)
        with self._lock:
            self._run.restore(state)
            self.scenario, self._changes = snapshot.scenario, snapshot.changes

    def _check_same_run(self, snapshot: Snapshot) -> None:
        theirs = begun(snapshot._initial, snapshot.seed, snapshot.run, snapshot._external)  # noqa: SLF001  (its own type)
        own = begun(self._initial, self.seed, self.run, self.declared_external)
        if theirs == own and is_same(snapshot._initial, self._initial):  # noqa: SLF001
            return
        other = " with another scenario of this name" if theirs == own else ""
        message = (
            f"snapshot is of the run {theirs}{other}: must be of this run, {own}; "
            "for another run, create another simulation"
        )
        raise InputError(message)

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
        """A 64-bit hash of the state: equal for runs in the same state.

        Of the metric engine, it covers the robots and what they believe, the messages that have not
        reached a brain, which items were found, and the obstacles and the terrain.
        """
        return self._run.hash


def begun(scenario: Scenario, seed: int, run: int, external: Mapping[str, ExternalBody]) -> str:
    """Return how a run began, in words."""
    is_plain = all(body == ExternalBody() for body in external.values())
    shown = tuple(external) if is_plain else external
    declared = f", external={shown!r}" if external else ""
    return f"{scenario.name!r}, seed={seed}, run={run}{declared}"


def is_same(one: Scenario, other: Scenario) -> bool:
    """Return whether two scenarios have the same values and files, whatever their source."""
    if one is other:
        return True
    return one.to_dict() == other.to_dict() and one.source.files == other.source.files

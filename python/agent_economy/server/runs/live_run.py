"""A run whose inputs arrive while it is displayed: that of real robots."""

import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from agent_economy.recording.stops import Stop, event_of
from agent_economy.runs.external import External
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Change
from agent_economy.scenario import Scenario, validation
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.recordings.input_log import InputLog, InputReader
from agent_economy.server.runs.outcome_series import OutcomeSeries
from agent_economy.server.runs.run_events import RunEvents, reader_of
from agent_economy.server.runs.versions import Versions


class LiveRun:
    """A run that is simulated again from the inputs of another process, as they arrive.

    The same scenario, seed and inputs give the same run, so that everything that a page displays of
    a simulated run it can display of a live one. Only `append` and `end` are called by the thread
    that receives the inputs: they never wait for the simulation, which may lag behind.

    Attributes:
        simulation: The run at its current tick.
        versions: One version: a live run has no changes.
    """

    simulation: Simulation
    versions: Versions

    def __init__(self, scenario: Scenario, seed: int = 0, external: External = ()) -> None:
        """Begin a run without inputs.

        Args:
            scenario: The scenario of the run.
            seed: Its seed.
            external: The robots with external bodies.

        Raises:
            InputError: As `Simulation`.
        """
        self.simulation = Simulation(scenario, seed=seed, external=external)
        self.versions = Versions((), 0)
        self._reader = reader_of(self.simulation)
        self.series.note(self.simulation)
        self._first = scenario
        # A drive lasts for hours: its inputs do not fit into memory.
        self._inputs = InputLog()
        self._unused = InputReader(self._inputs)
        # Before steps that have not been simulated.
        self._stops: deque[Stop] = deque()
        self._latest_tick = 0
        self._is_ended = False
        self._wake: Callable[[], None] = do_nothing

    def append(self, tick: int, inputs: Mapping[str, Any], stops: Iterable[Stop] = ()) -> None:
        """Add the inputs of the step from a tick; steps before it that have none get none.

        Args:
            tick: Not before the ticks of earlier inputs.
            inputs: Keyword arguments of `Simulation.step`, such as `percepts`.
            stops: The stops of real robots before that step.

        Raises:
            InputError: If the tick is in the past, or the run has ended.
        """
        allowed = f"{self._latest_tick} or more: inputs are added in the order of their ticks"
        validation.check(tick >= self._latest_tick, "tick", tick, allowed)
        validation.check(not self._is_ended, "tick", tick, "added before the end of the live run")
        # The simulation reads the latest tick first.
        self._stops += stops
        self._inputs.append(tick, inputs)
        self._latest_tick = tick + 1
        self._wake()

    def end(self) -> None:
        """Note that there will be no more inputs."""
        self._is_ended = True
        self._wake()

    def notify(self, wake: Callable[[], None] | None) -> None:
        """Call a function after every input, by the thread that adds it; None for no longer."""
        self._wake = do_nothing if wake is None else wake

    @property
    def is_finished(self) -> bool:
        """Whether all inputs that will ever arrive have been simulated."""
        return self._is_ended and self.tick >= self._latest_tick

    @property
    def series(self) -> OutcomeSeries:
        """The outcome over time."""
        return self.versions.current.series

    @property
    def events(self) -> RunEvents:
        """What has happened."""
        return self.versions.current.events

    @property
    def log(self) -> tuple[Change, ...]:
        """No changes: a live run has none."""
        return ()

    @property
    def is_recorded(self) -> bool:
        """Whether the changes are those of a recording: they are not."""
        return False

    @property
    def mismatch_tick(self) -> int | None:
        """None: there is no recording to compare with."""
        return None

    @property
    def tick(self) -> int:
        """The current tick."""
        return self.simulation.tick

    @property
    def latest_tick(self) -> int:
        """The tick to which there are inputs."""
        return self._latest_tick

    @property
    def step_s(self) -> float:
        """The simulated duration of a step."""
        return self.simulation.step_s

    @property
    def history(self) -> RunHistory:
        """Everything that is needed to replay the run up to the current tick."""
        simulation, tick = self.simulation, self.tick
        inputs = InputReader(self._inputs)
        begun = self._first, simulation.seed, simulation.run
        return RunHistory(*begun, (), inputs, tick, simulation.declared_external)

    def seek(self, tick: int, budget_s: float) -> bool:
        """Simulate inputs up to a tick for about `budget_s` of wall-clock time.

        Returns:
            Whether the run has arrived.

        Raises:
            InputError: If an input is not allowed; the run then ends before it.
        """
        end_s = time.monotonic() + budget_s
        while self.tick < min(tick, self._latest_tick) and time.monotonic() < end_s:
            self._step()
        return self.tick >= tick

    def _step(self) -> None:
        try:
            self.simulation.step(1, **self._unused.get(self.tick, {}))
        except ValueError:
            self._is_ended, self._latest_tick = True, self.tick
            raise
        self.series.note(self.simulation)
        events = self._reader.read(self.events.until)
        while self._stops and self._stops[0].tick < self.tick:
            events.append(event_of(self._stops.popleft()))
        self.events.note(events, self.simulation)


def do_nothing() -> None:
    """Do nothing."""

"""A run that can be moved back and forth in time, and changed at any tick."""

import time
from collections.abc import Callable, Iterable
from typing import Any, cast

from agent_economy import _core
from agent_economy.recording.reading import Recorded
from agent_economy.runs import factory
from agent_economy.runs.stepped import Change
from agent_economy.scenario import Scenario, TomlValue
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.runs.outcome_series import OutcomeSeries
from agent_economy.server.runs.recorded_run import RecordedRun, first_difference
from agent_economy.server.runs.run_events import RunEvents, reader_of
from agent_economy.server.runs.snapshots import Snapshots
from agent_economy.server.runs.versions import Versions

SLICE_S = 0.004
"""Steps are taken together for this long before the clock is read again."""

MISSING = object()


class Timeline:
    """A run from its beginning to its latest tick: the last one that was reached or recorded.

    Between snapshots the run is replayed, with the changes of the log at their ticks: moving back
    and forth gives the same bytes. A change makes another version of the run; the one in which it
    was made stays as it was.

    Attributes:
        recorded: The recording that the run is compared with; empty if it has none.
        versions: The versions of the run; all of it is about the current one.
    """

    recorded: RecordedRun
    versions: Versions

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        run: int = 0,
        log: Iterable[Change] | None = None,
        recorded: Recorded | None = None,
    ) -> None:
        """Begin a run.

        Args:
            scenario: The scenario at the beginning.
            seed: The seed of all random streams.
            run: The number of the run.
            log: Changes, made when the run reaches their ticks; None for those of the recording.
            recorded: The recording of the run, if there is one.

        Raises:
            InputError: If the world has no room for the team.
        """
        external = recorded.external if recorded else ()
        self.simulation = factory.create(scenario, seed, run, external)
        self._first = scenario
        self._is_recording = recorded is not None
        self.recorded = RecordedRun(recorded or Recorded())
        log = tuple(sorted(self.recorded.changes if log is None else log, key=tick_of))
        self.recorded.follow(log)
        self.versions = Versions(log, self.recorded.latest_tick)
        self._batch = 1
        # The tick of the last change that can be replaced, and the snapshot before it.
        self._replaceable: tuple[int, Any] | None = None
        # Before all changes, those of the first tick too: each can be undone.
        self._snapshots = Snapshots(self.simulation)
        self._apply_log()
        self.recorded.compare(self.simulation)
        self._reader = reader_of(self.simulation)
        self.series.note(self.simulation)
        self.series.until = 0

    @property
    def log(self) -> tuple[Change, ...]:
        """All changes up to the latest tick, in order."""
        return self.versions.current.log

    @property
    def latest_tick(self) -> int:
        """The last tick that was reached or recorded."""
        return self.versions.current.latest_tick

    @property
    def series(self) -> OutcomeSeries:
        """The outcome over time, up to the last tick that was reached."""
        return self.versions.current.series

    @property
    def events(self) -> RunEvents:
        """What has happened up to the last tick that was reached."""
        return self.versions.current.events

    @property
    def is_recorded(self) -> bool:
        """Whether the changes are those of a recording."""
        return self._is_recording and self.log == self.recorded.changes

    @property
    def mismatch_tick(self) -> int | None:
        """The first tick at which the run differed from its recording; None if it never did."""
        return self.recorded.mismatch_tick

    @property
    def history(self) -> RunHistory:
        """Everything that is needed to replay the run."""
        simulation, inputs = self.simulation, self.recorded.inputs
        return RunHistory(
            self._first,
            simulation.seed,
            simulation.run,
            self.log,
            inputs,
            self.latest_tick,
            simulation.declared_external,
        )

    @property
    def tick(self) -> int:
        """The current tick."""
        return self.simulation.tick

    @property
    def step_s(self) -> float:
        """The simulated duration of a step."""
        return self.simulation.step_s

    @property
    def is_finished(self) -> bool:
        """Whether the run cannot go beyond the current tick."""
        return self.simulation.is_over and self.tick >= self.latest_tick

    def seek(self, tick: int, budget_s: float) -> bool:
        """Move towards a tick for about `budget_s` of wall-clock time.

        Returns:
            Whether the run has arrived, or is finished before.

        Raises:
            InputError: If a change of the log is not allowed, or leaves no room for the team; the
                log then ends before it.
        """
        end_s = time.monotonic() + budget_s
        if tick < self.tick:
            self._restore(tick)
        while self.tick < tick and not self.is_finished:
            self._advance(tick)
            if time.monotonic() >= end_s:
                break
        return self.tick >= tick or self.is_finished

    def change(self, path: str, value: TomlValue, *, replaces_last: bool = False) -> None:
        """Set a value of the scenario from now on, in another version of the run.

        Args:
            path: Keys from the root, separated by dots.
            value: A value as in the scenario file.
            replaces_last: Whether the change replaces the last one, if that was made here, at this
                tick and path: as if the last one had never been made.

        Raises:
            InputError: If the value is not allowed; nothing has changed then.
        """
        now = self.simulation.snapshot()
        before = (self._before_last(path) if replaces_last else None) or now
        if not replaces_last:
            self._replaceable = None
        try:
            if before is not now:
                self.simulation.restore(before)
            if not self._is_current(path, value):
                self.simulation.change(path, value)
        except ValueError:
            self.simulation.restore(now)
            raise
        if self.simulation.changes != now.changes:
            self._replaceable = self.tick, before
            self._begin_version(before, is_replaced=before is not now)

    def undo(self) -> None:
        """Return to the version in which the last change was made.

        The run continues as if the change had never been made: no value has to be restored, and
        the log does not contain one.

        Raises:
            InputError: If there is no change.
        """
        self._move(self.versions.undo)

    def redo(self) -> None:
        """Return to the version that was left by the last `undo`.

        Raises:
            InputError: If there is none.
        """
        self._move(self.versions.redo)

    def choose_version(self, number: int) -> None:
        """Display another version; undo and redo then lead through it.

        Raises:
            InputError: If there is none with this number.
        """
        self._move(lambda: self.versions.choose(number))

    def _move(self, move: Callable[[], None]) -> None:
        """Display another version, at a tick at which it is as the one that is left."""
        left = self.versions.current
        move()
        now, self._replaceable = self.versions.current, None
        self.recorded.follow(now.log)
        fork = int(min(first_difference(left.log, now.log), left.latest_tick))
        if now.series.until < fork:
            now.series, now.events = left.series.copy(), left.events.copy()
            now.series.discard_from(fork)
            now.events.discard_from(fork)
        self._snapshots.discard_after(fork, now.log)
        if self.tick >= fork:
            self._restore(fork)

    def _before_last(self, path: str) -> Any:
        """Return the snapshot before the last change; None if that is of another path or tick."""
        if self._replaceable is None:
            return None
        (tick, before), made = self._replaceable, self.simulation.changes
        is_last = tick == self.tick and made[:-1] == before.changes and len(made) > 0
        return before if is_last and made[-1].path == path else None

    def _is_current(self, path: str, value: TomlValue) -> bool:
        current = value_at(_core.read_filled(self.simulation.scenario.source), path)
        # In Python True == 1.
        return bool(current == value) and isinstance(current, bool) == isinstance(value, bool)

    def _restore(self, tick: int) -> None:
        self.simulation.restore(self._snapshots.before(tick))
        self._apply_log()

    def _advance(self, tick: int) -> None:
        """Take some steps towards a tick, at most to the next change, snapshot or recorded tick."""
        steps = min(self._batch, self._next_stop(tick) - self.tick)
        start_s = time.monotonic()
        if steps > 0:
            self._step(steps)
        took_s = time.monotonic() - start_s
        self._batch = max(1, min(10_000, round(self._batch * SLICE_S / max(took_s, SLICE_S / 4))))
        known = self.events.until
        stops = self.recorded.stops(known, self.tick)
        self.events.note([*self._reader.read(known), *stops], self.simulation)
        self._apply_log()
        self.recorded.compare(self.simulation)
        self.versions.current.reached(self.tick)
        if self.tick >= self._snapshots.next_tick:
            self._snapshots.add(self.simulation, self.simulation.snapshot())

    def _next_stop(self, tick: int) -> int:
        stops = [tick, self.series.until] if self.tick < self.series.until else [tick]
        if self.tick >= self._snapshots.last_tick:
            stops.append(self._snapshots.next_tick)
        stops += [change.tick for change in self.log[len(self.simulation.changes) :][:1]]
        recorded = self.recorded.next_stop(self.tick)
        stops += [] if recorded is None else [recorded]
        return min(stops)

    def _step(self, steps: int) -> None:
        """Take steps, but none after the end, where a run of the metric engine would continue."""
        before = self.tick
        is_new = before >= self.series.until
        if inputs := self.recorded.input(before):
            # Only runs of the metric engine have external bodies.
            cast("Any", self.simulation).step(1, **inputs)
            if is_new:
                self.series.note(self.simulation)
            return
        for _ in range(steps):
            if self.is_finished:
                return
            self.simulation.step()
            if is_new:
                self.series.note(self.simulation)
        if self.tick == before:
            # A classic run that is over takes no steps, whatever its recording contains.
            self.versions.current.latest_tick = before
            self.recorded.end(before)

    def _apply_log(self) -> None:
        """Make the changes of the log that are due."""
        while (done := len(self.simulation.changes)) < len(self.log):
            change = self.log[done]
            if change.tick > self.tick:
                return
            try:
                self.simulation.change(change.path, change.value)
            except ValueError:
                self.versions.cut(done)
                raise

    def _begin_version(self, before: Any, *, is_replaced: bool) -> None:
        """Continue from a change; the snapshot before it is kept for an immediate undo."""
        if is_replaced:
            self.versions.forget_current()
        is_changed = self.simulation.changes != before.changes
        if is_changed:
            self.versions.begin(self.simulation.changes, self.tick)
        self.recorded.follow(self.log)
        self._snapshots.discard_after(self.tick, self.log)
        if not is_changed:
            return
        self.series.discard_from(self.tick)
        self.events.discard_from(self.tick)
        self.series.note(self.simulation)
        self.series.until = self.tick
        if self._snapshots.last_tick < self.tick:
            self._snapshots.add(self.simulation, before)


def tick_of(change: Change) -> int:
    """Return the tick at which a change is made."""
    return change.tick


def value_at(document: Any, path: str) -> Any:
    """Return the value of a document at a path, or `MISSING`."""
    for key in path.split("."):
        if not isinstance(document, dict) or key not in document:
            return MISSING
        document = document[key]
    return document

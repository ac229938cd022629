"""A run in which one can go back and forth, and change things on the way."""

import time
from bisect import bisect_right
from collections.abc import Iterable
from typing import Any, cast

from agent_economy import _core, given
from agent_economy.begin import begun
from agent_economy.recording.reading import Recorded
from agent_economy.scenario import Given, Scenario
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.runs.recorded_run import Replay
from agent_economy.stepped import Change

MEMORY_BYTES = 200_000_000
"""Snapshots together take no more, as far as that can be told."""

MIND_BYTES, BODY_BYTES = 100_000, 1_000
"""A robot in a snapshot, with a map in its mind or without; rather too many."""

MAX_KEPT = 128
FIRST_EVERY = 50
"""Steps between snapshots at first; twice as many whenever there are too many of them."""

SLICE_S = 0.004
"""Steps are taken together for so long: then the clock is looked at."""

MISSING = object()


class Timeline:
    """A run from its beginning to the latest moment that was seen or recorded, its edge.

    Between snapshots the run is taken again, with the changes of the log at their ticks: going back
    and forth gives the same bytes. A change in the past makes what came after it void.

    Attributes:
        edge: The latest tick seen or recorded.
        replay: What a recording says of the run; of a run that is of none, nothing.
    """

    edge: int
    replay: Replay

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        run: int = 0,
        log: Iterable[Change] | None = None,
        recorded: Recorded | None = None,
    ) -> None:
        """Begin a run; changes of a log are made when their ticks are come to.

        Args:
            scenario: What it is of.
            seed: Of all chance.
            run: Its number.
            log: Changes; None for those of the recording.
            recorded: What a recording says of the run.

        Raises:
            InputError: If there is no room for its team.
        """
        self.simulation = begun(scenario, seed, run)
        self._first = scenario
        self._recorded = recorded
        self.replay = Replay(recorded or Recorded())
        self.log = tuple(sorted(self.replay.changes if log is None else log, key=tick_of))
        self.edge = self.replay.edge
        self._every = FIRST_EVERY
        self._kept: list[Any] = []
        self._ticks: list[int] = []
        self._pace = 1
        # When the last change was put here that another may take the place of, and the run before.
        self._last: tuple[int, Any] | None = None
        # Of before all changes, those at its tick too: each can be undone.
        self._keep(self.simulation.snapshot())
        self._apply()
        self.replay.compare(self.simulation)

    @property
    def log(self) -> tuple[Change, ...]:
        """All changes up to the edge, in order."""
        return self._log

    @log.setter
    def log(self, log: tuple[Change, ...]) -> None:
        self._log = log
        self.replay.follow(log)

    @property
    def is_recorded(self) -> bool:
        """Whether the changes are those of a recording."""
        return self._recorded is not None and self.log == self.replay.changes

    @property
    def course(self) -> RunHistory:
        """What it takes to take the run again."""
        simulation, inputs = self.simulation, self.replay.inputs
        return RunHistory(self._first, simulation.seed, simulation.run, self.log, inputs, self.edge)

    @property
    def tick(self) -> int:
        """Where the run is now."""
        return self.simulation.tick

    @property
    def step_s(self) -> float:
        """Time in the world that a step takes."""
        return self.simulation.step_s

    def toward(self, tick: int, budget_s: float) -> bool:
        """Go towards a tick, back or forth, for about so long; return whether it is there.

        A run that is over goes no further.

        Raises:
            InputError: If a change of the log is not allowed, or has no room; it and what comes
                after it are void then.
        """
        end_s = time.monotonic() + budget_s
        if tick < self.tick:
            self._back(tick)
        while self.tick < tick and not self._is_at_the_end():
            self._advance(tick)
            if time.monotonic() >= end_s:
                break
        return self.tick >= tick or self._is_at_the_end()

    def change(self, path: str, value: Given, *, instead: bool = False) -> None:
        """Put a value into the scenario from now on; what was seen after now is void.

        Args:
            path: Keys from the root, with dots between.
            value: As the file could have it.
            instead: Whether it takes the place of the value that was put there last, if that was
                done here, at this very tick: as if it had never been.

        Raises:
            InputError: If the value is not allowed there; nothing has changed then.
        """
        now = self.simulation.snapshot()
        before = (self._before_last(path) if instead else None) or now
        if not instead:
            self._last = None
        try:
            if before is not now:
                self.simulation.restore(before)
            if not self._is_same(path, value):
                self.simulation.change(path, value)
        except ValueError:
            self.simulation.restore(now)
            raise
        if self.simulation.changes != now.changes:
            self._last = self.tick, before
            self._void_future(before)

    def undo(self) -> None:
        """Go back to before the last change was made, in a run in which it is not.

        Who goes on from there to where they were sees the run as if it had never been made: that
        needs no value to put back, and the log has nothing of it.

        Raises:
            InputError: If nothing has been changed.
        """
        made = self.simulation.changes
        given.check(bool(made), "undo", None, "after a change")
        self.log, made_at = made[:-1], made[-1].tick
        self.edge = max(made_at, self.replay.edge)
        self._forget_after(made_at)
        self._back(made_at)

    def _before_last(self, path: str) -> Any:
        """Return the run before its last change; None if that is of another path or tick."""
        if self._last is None:
            return None
        (tick, before), made = self._last, self.simulation.changes
        is_last = tick == self.tick and made[:-1] == before.changes and len(made) > 0
        return before if is_last and made[-1].path == path else None

    def _is_same(self, path: str, value: Given) -> bool:
        there = at(_core.read_filled(self.simulation.scenario.source), path)
        # To Python, true is one.
        return bool(there == value) and isinstance(there, bool) == isinstance(value, bool)

    def _is_at_the_end(self) -> bool:
        return self.simulation.is_over and self.tick >= self.edge

    def _back(self, tick: int) -> None:
        place = bisect_right(self._ticks, tick) - 1
        self.simulation.restore(self._kept[place])
        self._apply()

    def _advance(self, tick: int) -> None:
        """Take some steps towards a tick, to the next change or snapshot at most."""
        stops = [tick]
        if self.tick >= self._ticks[-1]:
            stops.append(self._ticks[-1] + self._every)
        waiting = self.log[len(self.simulation.changes) :]
        stops += [change.tick for change in waiting[:1]]
        told = self.replay.stop(self.tick)
        stops += [] if told is None else [told]
        steps = min(self._pace, min(stops) - self.tick)
        start_s = time.monotonic()
        if steps > 0:
            self._take(steps)
        took_s = time.monotonic() - start_s
        self._pace = max(1, min(10_000, round(self._pace * SLICE_S / max(took_s, SLICE_S / 4))))
        self._apply()
        self.replay.compare(self.simulation)
        self.edge = max(self.edge, self.tick)
        if self.tick >= self._ticks[-1] + self._every:
            self._keep(self.simulation.snapshot())

    def _take(self, steps: int) -> None:
        """Take steps, but none beyond the end, beyond which a run of the metric engine would go."""
        before = self.tick
        if given_here := self.replay.input(before):
            # Only runs of the metric engine have bodies outside.
            cast("Any", self.simulation).step(1, **given_here)
            return
        for _ in range(steps):
            if self._is_at_the_end():
                return
            self.simulation.step()
        if self.tick == before:
            # A run of the classic engine stands when it is over, whatever a recording says.
            self.edge = before
            self.replay.end(before)

    def _apply(self) -> None:
        """Make the changes of the log whose time has come."""
        while (done := len(self.simulation.changes)) < len(self.log):
            change = self.log[done]
            if change.tick > self.tick:
                return
            try:
                self.simulation.change(change.path, change.value)
            except ValueError:
                self.log = self.log[:done]
                raise

    def _void_future(self, before: Any) -> None:
        """Go on from a change, of before which there is a snapshot: it can be undone at once."""
        self.log = self.simulation.changes
        self.edge = self.tick
        self._forget_after(self.tick)
        if self._ticks[-1] < self.tick:
            self._keep(before)

    def _forget_after(self, tick: int) -> None:
        """Forget snapshots of after a tick, and those of other changes; but never the first."""
        kept = [
            (at_tick, each)
            for at_tick, each in zip(self._ticks, self._kept, strict=True)
            if each is self._kept[0]
            or (at_tick <= tick and each.changes == self.log[: len(each.changes)])
        ]
        self._ticks, self._kept = [each for each, _ in kept], [snapshot for _, snapshot in kept]

    def _keep(self, snapshot: Any) -> None:
        self._ticks.append(self.tick)
        self._kept.append(snapshot)
        if len(self._kept) > self._most():
            self._every *= 2
            # Every other one, counted from the newest, and the first.
            self._ticks = self._ticks[:1] + self._ticks[:0:-2][::-1]
            self._kept = self._kept[:1] + self._kept[:0:-2][::-1]

    def _most(self) -> int:
        """Return how many snapshots there may be."""
        robots = self.simulation.scenario.robots
        minded = [kind for kind, count in robots.items() if count and self._has_mind(kind)]
        each = sum(
            count * (MIND_BYTES if kind in minded else BODY_BYTES) for kind, count in robots.items()
        )
        return max(3, min(MAX_KEPT, MEMORY_BYTES // max(1, each)))

    def _has_mind(self, kind: str) -> bool:
        return self.simulation.thoughts(f"{kind}/0") is not None


def tick_of(change: Change) -> int:
    """Return when a change is made."""
    return change.tick


def at(document: Any, path: str) -> Any:
    """Return what a document has at a path, or `MISSING`."""
    for key in path.split("."):
        if not isinstance(document, dict) or key not in document:
            return MISSING
        document = document[key]
    return document

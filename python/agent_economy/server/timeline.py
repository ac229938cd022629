"""A run of the metric engine in which one can go back and forth, and change things on the way."""

import time
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from agent_economy import given
from agent_economy.scenario import Given, Scenario
from agent_economy.simulation import Change, Simulation, Snapshot

MEMORY_BYTES = 200_000_000
"""Snapshots together take no more, as far as that can be told."""

MIND_BYTES, BODY_BYTES = 100_000, 1_000
"""A robot in a snapshot, with a map in its mind or without; rather too many."""

MOST_KEPT = 128
FIRST_EVERY = 50
"""Steps between snapshots at first; twice as many whenever there are too many of them."""

SLICE_S = 0.004
"""Steps are taken together for so long: then the clock is looked at."""

MISSING = object()


class Timeline:
    """A run from its beginning to the latest moment that was seen, its edge.

    Between snapshots the run is taken again, with the changes of the log at their ticks: going back
    and forth gives the same bytes. A change in the past makes what came after it void.

    Attributes:
        edge: The latest tick seen.
        log: All changes up to the edge, in order.
    """

    edge: int
    log: tuple[Change, ...]

    def __init__(
        self, scenario: Scenario, seed: int = 0, run: int = 0, log: Iterable[Change] = ()
    ) -> None:
        """Begin a run; changes of a log are made when their ticks are come to.

        Raises:
            InputError: If the scenario is of another engine, or there is no room for its team.
        """
        self.simulation = Simulation(scenario, seed, run)
        self.log = tuple(sorted(log, key=lambda change: change.tick))
        self.edge = 0
        self._every = FIRST_EVERY
        self._kept: list[Snapshot] = []
        self._ticks: list[int] = []
        self._pace = 1
        self._apply()
        self._keep()

    @property
    def tick(self) -> int:
        """Where the run is now."""
        return self.simulation.tick

    @property
    def step_s(self) -> float:
        """Time in the world that a step takes."""
        return self.simulation._run.step_s  # noqa: SLF001  (ours)

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

    def change(self, path: str, value: Given) -> None:
        """Put a value into the scenario from now on; what was seen after now is void.

        Raises:
            InputError: If the value is not allowed there; nothing has changed then.
        """
        if self._is_same(path, value):
            return
        self.simulation.change(path, value)
        self._void_future()

    def undo(self) -> None:
        """Put back what was there before the last change, from now on.

        Raises:
            InputError: If nothing has been changed, or nothing was there.
        """
        last = self.simulation.changes[-1] if self.simulation.changes else None
        given.check(last is not None, "undo", None, "after a change")
        assert last is not None  # noqa: S101  (checked above)
        before = self._before(last.path)
        allowed = (
            f"of a change to what the scenario says; it did not say {last.path}: set it yourself"
        )
        given.check(before is not MISSING, "undo", last.value, allowed)
        self.change(last.path, before)

    def _before(self, path: str) -> Any:
        """Return what was at a path before the last change."""
        source = self.simulation.scenario.source
        earlier = Scenario.of(replace(source, overrides=source.overrides[:-1]))
        return at(earlier.to_dict(), path)

    def _is_same(self, path: str, value: Given) -> bool:
        return bool(at(self.simulation.scenario.to_dict(), path) == value)

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
        steps = min(self._pace, min(stops) - self.tick)
        start_s = time.monotonic()
        if steps > 0:
            self.simulation.step(steps)
        took_s = time.monotonic() - start_s
        self._pace = max(1, min(10_000, round(self._pace * SLICE_S / max(took_s, SLICE_S / 4))))
        self._apply()
        self.edge = max(self.edge, self.tick)
        if self.tick >= self._ticks[-1] + self._every:
            self._keep()

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

    def _void_future(self) -> None:
        self.log = self.simulation.changes
        self.edge = self.tick
        # A snapshot of this very moment is of before the change.
        kept = [each for each in zip(self._ticks, self._kept, strict=True) if each[0] < self.tick]
        self._ticks, self._kept = [tick for tick, _ in kept], [snapshot for _, snapshot in kept]
        self._keep()

    def _keep(self) -> None:
        self._ticks.append(self.tick)
        self._kept.append(self.simulation.snapshot())
        if len(self._kept) > self._most():
            self._every *= 2
            self._ticks, self._kept = self._ticks[::2], self._kept[::2]

    def _most(self) -> int:
        """Return how many snapshots there may be."""
        robots = self.simulation.scenario.robots
        minded = [kind for kind, count in robots.items() if count and self._has_mind(kind)]
        each = sum(
            count * (MIND_BYTES if kind in minded else BODY_BYTES) for kind, count in robots.items()
        )
        return max(3, min(MOST_KEPT, MEMORY_BYTES // max(1, each)))

    def _has_mind(self, kind: str) -> bool:
        return self.simulation.thoughts(f"{kind}/0") is not None


def at(document: Any, path: str) -> Any:
    """Return what a document has at a path, or `MISSING`."""
    for key in path.split("."):
        if not isinstance(document, dict) or key not in document:
            return MISSING
        document = document[key]
    return document

"""Compares a run with its recording, as long as the two have the same changes."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import zip_longest
from typing import Any

from agent_economy.recording.reading import Recorded
from agent_economy.recording.stops import event_of
from agent_economy.runs.events import Event
from agent_economy.runs.stepped import Change, Stepped


class RecordedRun:
    """The external inputs and the state hashes of a recorded run.

    Attributes:
        changes: The changes that were recorded.
        until: The tick at which the changes of the run begin to differ from the recorded ones.
        mismatch_tick: The first tick at which the state was not the recorded one; None if it always
            was.
    """

    changes: tuple[Change, ...]
    until: float
    mismatch_tick: int | None

    def __init__(self, recorded: Recorded) -> None:
        """Begin with a run that has the recorded changes."""
        self.changes = tuple(recorded.changes)
        self._inputs = recorded.inputs
        self._stopped = [event_of(stop) for stop in recorded.stops.all]
        self._hashes = {(point.tick, point.changes): point.hash for point in recorded.points}
        self._end = recorded.points[-1].tick if recorded.points else 0
        self._stops = sorted({tick for tick, _ in self._hashes} | self._inputs.keys())
        self.until, self.mismatch_tick = math.inf, None

    def follow(self, log: Sequence[Change]) -> None:
        """Compare with a run that has these changes from now on."""
        self.until = first_difference(log, self.changes)
        if self.mismatch_tick is not None and self.mismatch_tick >= self.until:
            self.mismatch_tick = None

    @property
    def latest_tick(self) -> int:
        """The last tick at which the recording is one of this run."""
        return int(min(self._end, self.until))

    @property
    def inputs(self) -> dict[int, dict[str, Any]]:
        """The external inputs of this run by tick."""
        return {tick: each for tick, each in self._inputs.items() if tick < self.until}

    def input(self, tick: int) -> dict[str, Any]:
        """Return the external inputs of the step from a tick, as keyword arguments of `step`."""
        return self._inputs.get(tick, {}) if tick < self.until else {}

    def stops(self, since: int, until: int) -> list[Event]:
        """Return when robots of a drive were stopped, in the steps from one tick to another."""
        end = min(until, self.until)
        return [event for event in self._stopped if since <= event.tick < end]

    def next_stop(self, tick: int) -> int | None:
        """Return the next tick that was recorded, or that has an external input."""
        place = bisect_right(self._stops, tick)
        return self._stops[place] if place < len(self._stops) else None

    def end(self, tick: int) -> None:
        """Note that the run ends at a tick: states recorded after it are mismatches."""
        beyond = [each for each, _ in self._hashes if tick < each < self.until]
        if self.mismatch_tick is None and beyond:
            self.mismatch_tick = min(beyond)

    def compare(self, simulation: Stepped) -> None:
        """Compare the current state with the recorded one, if there is one."""
        if self.mismatch_tick is not None and self.mismatch_tick <= simulation.tick:
            return
        recorded = self._hashes.get((simulation.tick, len(simulation.changes)))
        is_comparable = recorded is not None and simulation.tick < self.until
        if is_comparable and recorded != f"{simulation.hash:016x}":
            self.mismatch_tick = simulation.tick


def first_difference(one: Sequence[Change], other: Sequence[Change]) -> float:
    """Return the tick from which on runs with these changes differ."""
    for pair in zip_longest(one, other):
        if pair[0] != pair[1]:
            return min(each.tick for each in pair if each is not None)
    return math.inf

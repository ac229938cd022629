"""What a recording says of a run, as far as the run is still the one that was recorded."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import zip_longest
from typing import Any

from agent_economy.recording.reading import Recorded
from agent_economy.stepped import Change, Stepped


class Replay:
    """A recording beside a run: what came into it from outside, and what its states were.

    Attributes:
        changes: The recording's.
        until: From this tick on the run is another one, as other changes were made.
        differs_at: The first tick at which the run was found not to be as recorded; None if none.
    """

    changes: tuple[Change, ...]
    until: float
    differs_at: int | None

    def __init__(self, recorded: Recorded) -> None:
        """Begin with all of it."""
        self.changes = tuple(recorded.changes)
        self._inputs = recorded.inputs
        self._hashes = {(point.tick, point.changes): point.hash for point in recorded.points}
        self._end = recorded.points[-1].tick if recorded.points else 0
        self._stops = sorted({tick for tick, _ in self._hashes} | self._inputs.keys())
        self.until, self.differs_at = math.inf, None

    def follow(self, log: Sequence[Change]) -> None:
        """Be beside a run with these changes."""
        self.until = parting(log, self.changes)
        if self.differs_at is not None and self.differs_at >= self.until:
            self.differs_at = None

    @property
    def edge(self) -> int:
        """How far the recording goes, or is that of this run."""
        return int(min(self._end, self.until))

    @property
    def inputs(self) -> dict[int, dict[str, Any]]:
        """What came from outside, by the tick."""
        return {tick: each for tick, each in self._inputs.items() if tick < self.until}

    def input(self, tick: int) -> dict[str, Any]:
        """Return what came from outside into the step that follows a tick, by what `step` takes."""
        return self._inputs.get(tick, {}) if tick < self.until else {}

    def stop(self, tick: int) -> int | None:
        """Return the next tick at which the recording has something to say."""
        place = bisect_right(self._stops, tick)
        return self._stops[place] if place < len(self._stops) else None

    def end(self, tick: int) -> None:
        """Hear that the run goes no further than a tick: what was recorded beyond is not so."""
        beyond = [each for each, _ in self._hashes if tick < each < self.until]
        if self.differs_at is None and beyond:
            self.differs_at = min(beyond)

    def compare(self, simulation: Stepped) -> None:
        """See whether a state is as recorded, if it was."""
        if self.differs_at is not None and self.differs_at <= simulation.tick:
            return
        recorded = self._hashes.get((simulation.tick, len(simulation.changes)))
        is_beside = recorded is not None and simulation.tick < self.until
        if is_beside and recorded != f"{simulation.hash:016x}":
            self.differs_at = simulation.tick


def parting(one: Sequence[Change], other: Sequence[Change]) -> float:
    """Return the tick from which on runs differ that have these changes."""
    for pair in zip_longest(one, other):
        if pair[0] != pair[1]:
            return min(each.tick for each in pair if each is not None)
    return math.inf

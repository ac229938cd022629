"""The snapshots of a run that can be returned to: few enough to fit into memory."""

from bisect import bisect_right

from agent_economy.runs.stepped import Change, Snapshot, Stepped

MEMORY_BYTES = 200_000_000
"""Maximum size of all snapshots together, unless there are only `MIN_SNAPSHOTS` of them."""

MIN_SNAPSHOTS = 3
MAX_SNAPSHOTS = 128
FIRST_INTERVAL = 50
"""Initial steps between snapshots; doubled whenever there are too many of them."""


class Snapshots:
    """Snapshots in the order of their ticks; the first is of the beginning of the run."""

    def __init__(self, simulation: Stepped) -> None:
        """Begin with a snapshot of the current moment."""
        self._interval = FIRST_INTERVAL
        self._ticks: list[int] = []
        self._kept: list[Snapshot] = []
        self.add(simulation, simulation.snapshot())

    @property
    def last_tick(self) -> int:
        """The tick of the latest snapshot."""
        return self._ticks[-1]

    @property
    def next_tick(self) -> int:
        """The tick at which the next snapshot is due."""
        return self._ticks[-1] + self._interval

    def before(self, tick: int) -> Snapshot:
        """Return the latest snapshot that is not after a tick."""
        return self._kept[bisect_right(self._ticks, tick) - 1]

    def add(self, simulation: Stepped, snapshot: Snapshot) -> None:
        """Add a snapshot of the current tick; drop every second one while they take too much."""
        self._ticks.append(simulation.tick)
        self._kept.append(snapshot)
        while self._are_too_many():
            self._interval *= 2
            # The first, and every second one counted from the newest.
            self._ticks = self._ticks[:1] + self._ticks[:0:-2][::-1]
            self._kept = self._kept[:1] + self._kept[:0:-2][::-1]

    def _are_too_many(self) -> bool:
        count = len(self._kept)
        is_over_budget = sum(snapshot.bytes for snapshot in self._kept) > MEMORY_BYTES
        return count > MAX_SNAPSHOTS or (is_over_budget and count > MIN_SNAPSHOTS)

    def discard_after(self, tick: int, log: tuple[Change, ...]) -> None:
        """Drop the snapshots after a tick and those with other changes, but never the first."""
        kept = [
            (at_tick, each)
            for at_tick, each in zip(self._ticks, self._kept, strict=True)
            if each is self._kept[0]
            or (at_tick <= tick and each.changes == log[: len(each.changes)])
        ]
        self._ticks, self._kept = [each for each, _ in kept], [snapshot for _, snapshot in kept]

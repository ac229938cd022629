"""The versions of a run that changes have made: a tree through which undo and redo move."""

from dataclasses import dataclass, field
from itertools import count

from agent_economy.runs.stepped import Change
from agent_economy.scenario import validation
from agent_economy.server.runs.outcome_series import OutcomeSeries
from agent_economy.server.runs.run_events import RunEvents

MAX_VERSIONS = 200
"""Maximum number of versions: with more, the oldest one that is no parent is forgotten."""


@dataclass
class Version:
    """A run with some changes, as far as it was simulated with them.

    Attributes:
        number: Its number.
        parent: The version in which its last change was made; None for the first.
        log: Its changes, in order.
        latest_tick: The last tick that was reached or recorded.
        series: The outcome over time, up to the last tick that was reached.
        events: What has happened up to there.
    """

    number: int
    parent: "Version | None"
    log: tuple[Change, ...]
    latest_tick: int
    series: OutcomeSeries = field(default_factory=OutcomeSeries)
    events: RunEvents = field(default_factory=RunEvents)

    @property
    def change(self) -> Change | None:
        """The change that made it; None of the first."""
        return None if self.parent is None else self.log[-1]

    def reached(self, tick: int) -> None:
        """Note that it was simulated up to a tick."""
        self.latest_tick = max(self.latest_tick, tick)
        self.series.until = max(self.series.until, tick)


class Versions:
    """The versions of a run.

    Attributes:
        current: The version that is displayed.
        all: All versions, by their numbers.
    """

    current: Version
    all: dict[int, Version]

    def __init__(self, log: tuple[Change, ...], latest_tick: int) -> None:
        """Begin with one version for each change of a log, and one without changes.

        Args:
            log: The changes of the current version.
            latest_tick: Its latest tick; that of the others is the one of the next change.
        """
        self._numbers = count()
        self.all = {}
        # The version to which redo returns, by the number of its parent.
        self._next: dict[int, Version] = {}
        ends = [*(change.tick for change in log), latest_tick]
        self.current = self._add(None, (), ends[0])
        for made, end in enumerate(ends[1:], 1):
            self.current = self._add(self.current, log[:made], end)

    def begin(self, log: tuple[Change, ...], tick: int) -> None:
        """Add a version that continues the current one from a tick with another change."""
        parent = self.current
        self.current = self._add(parent, log, tick)
        self.current.series, self.current.events = parent.series.copy(), parent.events.copy()
        self._forget_oldest()

    def forget_current(self) -> None:
        """Return to the version in which the last change was made, and forget the current one."""
        forgotten = self.current
        self.undo()
        self._forget(forgotten)

    def cut(self, changes: int) -> None:
        """Return to the version with only the first changes: the next one is not allowed."""
        while len(self.current.log) > changes:
            self.forget_current()

    def undo(self) -> None:
        """Return to the version in which the last change was made.

        Raises:
            InputError: If there is no change.
        """
        parent = self.current.parent
        validation.check(parent is not None, "undo", None, "after a change")
        assert parent is not None  # noqa: S101  (checked above)
        self.current = parent

    def redo(self) -> None:
        """Return to the version that was left by `undo`.

        Raises:
            InputError: If there is none.
        """
        following = self._next.get(self.current.number)
        validation.check(following is not None, "redo", None, "after an undo")
        assert following is not None  # noqa: S101  (checked above)
        self.current = following

    def choose(self, number: int) -> None:
        """Display a version; undo and redo then lead through it.

        Raises:
            InputError: If there is none with this number.
        """
        validation.check(
            number in self.all, "version", number, "the number of a version of the run"
        )
        self.current = self.all[number]
        for version in ancestors(self.current):
            self._lead_to(version)

    @property
    def can_redo(self) -> bool:
        """Whether there is a version to return to."""
        return self.current.number in self._next

    def _add(self, parent: Version | None, log: tuple[Change, ...], latest_tick: int) -> Version:
        version = Version(next(self._numbers), parent, log, latest_tick)
        self.all[version.number] = version
        self._lead_to(version)
        return version

    def _lead_to(self, version: Version) -> None:
        if version.parent is not None:
            self._next[version.parent.number] = version

    def _forget_oldest(self) -> None:
        """Forget the oldest version that is no parent of another one, if there are too many."""
        parents = {each.parent.number for each in self.all.values() if each.parent is not None}
        leaves = [number for number in self.all if number not in parents]
        if len(self.all) <= MAX_VERSIONS or leaves == [self.current.number]:
            return
        self._forget(self.all[min(number for number in leaves if number != self.current.number)])

    def _forget(self, version: Version) -> None:
        del self.all[version.number]
        following = self._next.items()
        self._next = {number: each for number, each in following if each is not version}


def ancestors(version: Version) -> list[Version]:
    """Return a version and those from which it was made, the last one first."""
    found = [version]
    while (parent := found[-1].parent) is not None:
        found.append(parent)
    return found

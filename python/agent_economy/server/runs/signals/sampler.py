"""Samples signals of a run, which is simulated again for that from its beginning."""

import math
import time
from collections.abc import Iterator, Sequence

from agent_economy.recording.replayer import replay_steps
from agent_economy.runs import factory
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.server.runs.recorded_run import first_difference
from agent_economy.server.runs.run import FOREVER, Run
from agent_economy.server.runs.signals.sources import Sources
from agent_economy.types.page import Signals

MAX_SAMPLES = 2000
"""Maximum number of samples; when there are more, every second one is dropped."""


class Sampler:
    """Samples of some signals at evenly spaced steps of a run.

    The samples are those of the run itself: the same whatever a page has displayed of it. After a
    change, those before it stay.

    Attributes:
        signals: The ids of the signals.
    """

    signals: tuple[str, ...]

    def __init__(self, run: Run, signals: Sequence[str]) -> None:
        """Begin without samples."""
        self.signals, self._run = tuple(signals), run
        self._log: list[Change] = []
        self._rows: list[tuple[int, list[float | None]]] = []
        self._every, self._until = 1, -1
        # What has to be sent: rows from here on.
        self._unsent = 0
        self._begin()

    @property
    def is_behind(self) -> bool:
        """Whether the run has steps that have not been sampled."""
        return self._replica.tick < self._run.latest_tick and not self._is_ended

    def advance(self, budget_s: float) -> None:
        """Sample for about `budget_s` of wall-clock time.

        Raises:
            InputError: If the run cannot continue.
        """
        end_s = time.monotonic() + budget_s
        self._follow(self._run.log)
        while self.is_behind and time.monotonic() < end_s:
            self._is_ended = next(self._steps, None) is None
            self._note()

    def take(self) -> Signals | None:
        """Return the samples since the last call; None if there are none."""
        rows = [row for row in self._rows if row[0] >= self._unsent]
        if not rows:
            return None
        since, self._unsent = self._unsent, self._rows[-1][0] + 1
        return {
            "type": "signals",
            "signals": self.signals,
            "since": since,
            "until": self._until,
            "every": self._every,
            "rows": [{"tick": tick, "values": values} for tick, values in rows],
        }

    def _begin(self) -> None:
        history = self._run.history
        begun = history.scenario, history.seed, history.run
        self._log = list(history.log)
        self._replica: Stepped = factory.create(*begun, history.external)
        self._sources = Sources(self._replica, self.signals)
        # The list is passed on: changes that are appended to it are made.
        self._steps: Iterator[int] = replay_steps(
            self._replica, self._replica.step, self._log, history.inputs, FOREVER
        )
        self._is_ended, self._has_inputs = False, bool(history.inputs)
        self._note()

    def _follow(self, log: Sequence[Change]) -> None:
        """Continue with other changes; if they are in the past of the replica, begin again."""
        fork = first_difference(self._log, log)
        if fork == math.inf:
            return
        # Of a recording, the inputs end with the first change.
        if self._replica.tick <= fork and not self._has_inputs:
            self._log[:] = log
            return
        self._rows = [row for row in self._rows if row[0] <= fork]
        self._until = min(self._until, int(fork))
        self._unsent = min(self._unsent, int(fork) + 1)
        self._begin()

    def _note(self) -> None:
        tick = self._replica.tick
        self._sources.step()
        if tick <= self._until:
            return
        self._until = tick
        if tick % self._every == 0:
            self._rows.append((tick, self._sources.values()))
        if len(self._rows) > MAX_SAMPLES:
            self._every *= 2
            self._rows = [row for row in self._rows if row[0] % self._every == 0]
            self._unsent = 0

"""What has happened in a run, in bounded memory."""

from bisect import bisect_left
from collections import Counter
from operator import attrgetter
from typing import Any, Protocol

import numpy as np

from agent_economy import _core
from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.events import Event, in_words
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped

MAX_EVENTS = 4000
"""Maximum number of events of a kind; when there are more, every second one is dropped."""


class EventReader(Protocol):
    """Reads what happens in a run."""

    def read(self, since: int) -> list[Event]:
        """Return the events since the last call, of steps from a tick on."""


class MetricReader:
    """Reads what happens in a run of the metric engine from now on."""

    def __init__(self, simulation: Simulation) -> None:
        """Begin with the next step."""
        self._reader = _core.EventReader(simulation._run)  # noqa: SLF001  (ours)

    def read(self, since: int) -> list[Event]:
        """Return the events since the last call, of steps from a tick on."""
        return [in_words(*each) for each in self._reader.drain() if each[0] >= since]


class ClassicReader:
    """Reads which items are found in a run of the classic engine."""

    def __init__(self, simulation: ClassicSimulation) -> None:
        """Begin with the present."""
        self._simulation = simulation
        self._found: set[int] = set()
        self.read(0)

    def read(self, since: int) -> list[Event]:
        """Return the finds since the last call, of steps from a tick on.

        The run may have gone back since that call.
        """
        found_s = np.array(self._simulation._run.found_s, np.float64)  # noqa: SLF001  (ours)
        found = set(np.flatnonzero(np.isfinite(found_s)).tolist())
        new, self._found = sorted(found - self._found), found
        ticks = np.round(found_s / self._simulation.step_s)
        # An item is found at the end of a step.
        events = [Event(int(ticks[item]) - 1, "found", f"item/{item}", "found", "") for item in new]
        return [event for event in events if event.tick >= since]


def reader_of(simulation: Stepped) -> EventReader:
    """Return a reader of what happens in a run from now on."""
    if isinstance(simulation, ClassicSimulation):
        return ClassicReader(simulation)
    run: Any = simulation
    return MetricReader(run)


class RunEvents:
    """The events of a run, in order.

    Of a kind with very many events, only every second one is kept, every fourth, and so on.

    Attributes:
        until: The number of steps whose events are known.
        revision: Incremented when events are removed.
    """

    until: int
    revision: int

    def __init__(self) -> None:
        """Begin without events."""
        self.until = self.revision = 0
        self._events: list[Event] = []
        self._has_ended = False
        # Of each kind: the number of events so far, and the distance of those that are kept.
        self._counts: Counter[str] = Counter()
        self._strides: dict[str, int] = {}

    def copy(self) -> "RunEvents":
        """Return a copy."""
        copy = RunEvents()
        copy.until, copy._events = self.until, list(self._events)
        copy._has_ended = self._has_ended
        copy._counts, copy._strides = Counter(self._counts), dict(self._strides)
        return copy

    @property
    def strides(self) -> dict[str, int]:
        """By kind: of how many events one is kept, if not each."""
        return {kind: stride for kind, stride in self._strides.items() if stride > 1}

    def note(self, events: list[Event], simulation: Stepped) -> None:
        """Keep events of steps that were not known, which are those from `until` on."""
        until = simulation.tick
        if until <= self.until:
            return
        for event in sorted(events, key=attrgetter("tick")):
            self._keep(event)
        self.until = until
        if simulation.is_over and not self._has_ended:
            self._has_ended = True
            self._keep(Event(until - 1, "ended", "run", str(simulation.outcome().status), ""))

    def discard_from(self, tick: int) -> None:
        """Forget all events of steps from a tick on: the run will be another one."""
        self.revision += 1
        self._events = [
            event for event in self._events if event.tick < tick and event.kind != "ended"
        ]
        self.until, self._has_ended = min(self.until, tick), False
        kept = Counter(event.kind for event in self._events)
        self._counts = Counter({kind: kept[kind] * self._strides.get(kind, 1) for kind in kept})

    def since(self, tick: int) -> list[Event]:
        """Return the events of steps from a tick on."""
        return self._events[bisect_left(self._events, tick, key=attrgetter("tick")) :]

    def _keep(self, event: Event) -> None:
        kind, stride = event.kind, self._strides.setdefault(event.kind, 1)
        if self._counts[kind] % stride == 0:
            self._events.append(event)
        self._counts[kind] += 1
        if self._counts[kind] > MAX_EVENTS * stride:
            self._strides[kind] = 2 * stride
            self._thin(kind)

    def _thin(self, kind: str) -> None:
        """Drop every second event of a kind."""
        self.revision += 1
        places = [place for place, event in enumerate(self._events) if event.kind == kind]
        dropped = set(places[1::2])
        self._events = [event for place, event in enumerate(self._events) if place not in dropped]

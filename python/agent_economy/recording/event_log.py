"""The events of a run of the metric engine in the log of its recording."""

from collections import deque
from typing import Any

from foxglove_schemas_protobuf.Log_pb2 import Log

from agent_economy import _core
from agent_economy.recording.clock import Clock
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import log
from agent_economy.recording.item_scene import Items
from agent_economy.recording.logged import Logged
from agent_economy.runs.events import BROKEN, FAILED_ACT, Event, in_words
from agent_economy.runs.simulation import Simulation

WARNINGS = ("unserved", "lost", "failed")
"""Events that `EconomyTopic` logs too, if they were before the first step of a recording."""


class EventLog:
    """Writes the events of a run to the log."""

    def __init__(
        self, file: File, simulation: Simulation, clock: Clock, items: Items, logged: Logged
    ) -> None:
        """Begin with the events of the next step; `logged` is in the log."""
        self._file, self._clock, self._items, self._logged = file, clock, items, logged.warnings
        self._reader: _core.EventReader | None = _core.EventReader(simulation._run)  # noqa: SLF001  (ours)
        self._waiting: deque[tuple[int, str, str, Any]] = deque()

    def write(self, *, until: int | None = None) -> None:
        """Write the events since the last call, each at the time of its step.

        Args:
            until: Only those of steps before this one; the others wait for the next call.
        """
        if self._reader is not None:
            self._waiting += self._reader.drain()
        while self._waiting and (until is None or self._waiting[0][0] < until):
            self._write(*self._waiting.popleft())

    def close(self) -> None:
        """Collect no more events: a run keeps those of its readers until they are read."""
        self._reader = None

    def _write(self, tick: int, kind: str, of: str, value: Any) -> None:
        # A step is recorded when it has been taken.
        event, time_ns = in_words(tick, kind, of, value), self._clock.time_ns(tick + 1)
        if event.kind == "found":
            self._items.log_find(of, value[0], time_ns)
        elif kind not in WARNINGS or self._is_new(f"{of}: {event.text}"):
            line = log(time_ns, level_of(kind, event), of, event.text)
            self._file.write("/log", line, time_ns)

    def _is_new(self, warning: str) -> bool:
        is_new = warning not in self._logged
        self._logged.add(warning)
        return is_new


def level_of(kind: str, event: Event) -> "Log.Level.ValueType":
    """Return the level of an event in the log."""
    if kind == "sent":
        return Log.DEBUG
    if kind == "destroyed" or event.text == BROKEN:
        return Log.ERROR
    if event.kind in ("collided", "stopped", "failed") or event.text.endswith(FAILED_ACT):
        return Log.WARNING
    return Log.INFO

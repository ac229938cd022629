"""The events of a run of the metric engine in the log of its recording."""

from collections import deque
from typing import Any

from foxglove_schemas_protobuf.Log_pb2 import Log

from agent_economy import _core
from agent_economy.recording.clock import Clock
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import log
from agent_economy.recording.item_scene import Items
from agent_economy.runs.simulation import STATUSES, Simulation

LEVELS = {"empty": Log.WARNING, "broken": Log.ERROR}


class EventLog:
    """Writes finds, services, acts, losses, collisions and changes of status to the log."""

    def __init__(self, file: File, simulation: Simulation, clock: Clock, items: Items) -> None:
        """Begin with the events of the next step."""
        self._file, self._clock, self._items = file, clock, items
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

    def _write(self, tick: int, kind: str, name: str, value: Any) -> None:
        # A step is recorded when it has been taken.
        time_ns = self._clock.time_ns(tick + 1)
        if kind == "detected":
            self._items.log_find(name, value, time_ns)
            return
        level, message = in_words(kind, value)
        self._file.write("/log", log(time_ns, level, name, message), time_ns)


def in_words(kind: str, value: Any) -> tuple["Log.Level.ValueType", str]:
    """Return the level and the message of an event."""
    if kind == "served":
        return Log.INFO, f"served by {value}"
    if kind == "acted":
        return act_in_words(value)
    if kind == "destroyed":
        return Log.ERROR, f"destroyed by {value}"
    if kind == "passed":
        return Log.INFO, "passed the lane"
    if kind == "collided":
        return Log.WARNING, f"collision, {value} in total"
    status = str(STATUSES[value])
    return LEVELS.get(status, Log.INFO), status


def act_in_words(
    value: tuple[str, str | None, tuple[float, float], bool],
) -> tuple["Log.Level.ValueType", str]:
    """Return the level and the message of an act on an item or a place."""
    act, item, at, is_success = value
    result = "" if is_success else ", failed"
    place = f"at ({at[0]:.1f}, {at[1]:.1f})"
    return Log.INFO if is_success else Log.WARNING, f"{act} {item or 'nothing'} {place}{result}"

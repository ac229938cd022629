"""When the robots of a drive were stopped, and why."""

import json
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, NamedTuple

from agent_economy.recording.live_topics import EVENTS, TICKS
from agent_economy.runs.events import Event

MOVES = "move"
"""The action of a robot that may move."""


class Stop(NamedTuple):
    """A change of whether a robot may move.

    Attributes:
        tick: The number of steps before it.
        robot: The name of the robot.
        action: "move", "stop" or "latched_stop".
        reasons: What stops it, and why it has to be armed; empty if it may move.
    """

    tick: int
    robot: str
    action: str
    reasons: tuple[str, ...]


class StopReader:
    """Finds the stops among the events of the warden, which are read in their order."""

    def __init__(self) -> None:
        """Begin without events."""
        self._last: dict[str, tuple[str, tuple[str, ...]]] = {}

    def read(self, tick: int, event: Mapping[str, Any]) -> Stop | None:
        """Return the stop of an event at a tick; None if it is no change."""
        robot, action = str(event["robot"]), str(event["action"])
        names = [str(name) for key in ("faults", "latched") for name in event[key]]
        now = action, () if action == MOVES else tuple(dict.fromkeys(names))
        # A robot that has not moved yet was not stopped.
        last, self._last[robot] = self._last.get(robot, now), now
        return None if last == now else Stop(tick, robot, *now)


class Stops:
    """Collects the stops of a recording, whose messages are added in their order.

    Attributes:
        all: The changes so far.
    """

    all: list[Stop]

    def __init__(self) -> None:
        """Begin without messages."""
        self.all = []
        self._tick = 0
        self._reader = StopReader()

    def add(self, topic: str, data: bytes) -> None:
        """Add a message of `TICKS` or `EVENTS`; others, and what cannot be read, change nothing.

        Replays do not need them, so that a damaged one does not end what can be read.
        """
        if topic not in (TICKS, EVENTS):
            return
        with suppress(ValueError, KeyError, TypeError, AttributeError, RecursionError):
            message = json.loads(data)
            if topic == TICKS:
                self._tick = int(message["tick"]) + 1
            else:
                stop = self._reader.read(self._tick, message)
                self.all += [] if stop is None else [stop]


def event_of(stop: Stop) -> Event:
    """Return the event that a robot was stopped, or may move again."""
    reasons = f": {', '.join(stop.reasons)}" if stop.reasons else ""
    text = "may move again" if stop.action == MOVES else f"stopped{reasons}"
    return Event(stop.tick, "stopped", stop.robot, text, stop.robot)

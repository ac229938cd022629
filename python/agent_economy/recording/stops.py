"""When the robots of a recorded drive were stopped, and why."""

import json
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, NamedTuple

from agent_economy.recording.live_topics import EVENTS, TICKS

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
        self._last: dict[str, tuple[str, tuple[str, ...]]] = {}

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
                self._add_event(message)

    def _add_event(self, event: Mapping[str, Any]) -> None:
        robot, action = str(event["robot"]), str(event["action"])
        names = [str(name) for key in ("faults", "latched") for name in event[key]]
        now = action, () if action == MOVES else tuple(dict.fromkeys(names))
        # A robot that has not moved yet was not stopped.
        if self._last.get(robot, now) != now:
            self.all.append(Stop(self._tick, robot, *now))
        self._last[robot] = now

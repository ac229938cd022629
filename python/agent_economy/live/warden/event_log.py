"""The newest events of a drive, with numbers and levels, for pages."""

from collections import deque
from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy.live.clock import now_s
from agent_economy.live.warden.sentences import sentence
from agent_economy.types.warden import Level, WardenEvent

MAX_EVENTS = 1000

HARMLESS = {"not_armed", "mode_changed", "held"}
"""Reasons for a stop that are requests of an operator, or the start of the drive."""


class EventLog:
    """The last events, numbered from 1, with times since its start."""

    def __init__(self) -> None:
        """Start without events."""
        self._began_s = now_s()
        self._events: deque[WardenEvent] = deque(maxlen=MAX_EVENTS)
        self._number = 0

    @property
    def time_s(self) -> float:
        """The time since its start."""
        return now_s() - self._began_s

    def add(self, level: Level, robot: str | None, text: str) -> None:
        """Add an event; of more than the maximum, the oldest is dropped."""
        self._number += 1
        number, time_s = self._number, self.time_s
        self._events.append(
            {"number": number, "time_s": time_s, "level": level, "robot": robot, "text": text}
        )

    def report(self, event: Mapping[str, Any]) -> None:
        """Add an event of the drive, in words; but the address of the page contains a secret."""
        text = "" if event["type"] == "page" else sentence(event)
        if text:
            self.add(_level(event), event.get("robot"), text)

    def since(self, number: int) -> Iterator[WardenEvent]:
        """Yield the events with larger numbers."""
        return (event for event in self._events if event["number"] > number)


def _level(event: Mapping[str, Any]) -> Level:
    match event["type"]:
        case "event":
            return _level_of_robot(event)
        case "goal":
            return "warning" if event["verdict"] == "impossible" else "info"
        case "radio":
            return "warning" if event["is_silent"] else "info"
        case "recording_error" | "invalid":
            return "error"
        case "message":
            return "warning"
    return "info"


def _level_of_robot(event: Mapping[str, Any]) -> Level:
    if set(event["latched"]) - HARMLESS:
        return "error"
    return "warning" if set(event["faults"]) - HARMLESS or event["warnings"] else "info"

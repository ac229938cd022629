"""Readings made again of recorded lines, by the driver and the geodesy of the warden."""

from collections.abc import Mapping
from typing import Any

from agent_economy.live.drivers import DRIVERS
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import FleetPlan


class LineReadings:
    """The readings that the lines of a drive give, and whether the recorded ones are these."""

    def __init__(self, plan: FleetPlan) -> None:
        """Create it for a fleet."""
        self._robots = {robot.name: robot for robot in plan.robots}
        self._frame = frame_of(plan.origin)
        self._due: dict[tuple[str, str], dict[str, Any]] = {}

    def of(self, line: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the message of the reading of a line; None if the line is malformed."""
        name, port, data = line["robot"], line["port"], line["line"].encode("latin-1")
        robot = self._robots[name]
        reading = DRIVERS[robot.driver].parse(port, data, robot.settings, self._frame)
        return None if reading is None else reading.message(name, port, line["t"])

    def agree(self, message: Mapping[str, Any]) -> bool:
        """Take the next recorded line or reading; return whether it agrees with those before.

        The reading of a line is the next message of its port. A step may come between them, and a
        warden that is lost may send a line without its reading as its last message.
        """
        key = (message["robot"], message["port"])
        due = self._due.pop(key, None)
        if message["type"] != "line":
            return message == due
        reading = self.of(message)
        if reading is not None:
            self._due[key] = reading
        return due is None

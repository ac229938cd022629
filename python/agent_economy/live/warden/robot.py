"""One robot of the fleet: its connections, its newest samples and its motor lines."""

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from agent_economy._core import LocalFrame
from agent_economy.live.channel import Message
from agent_economy.live.drivers import DRIVERS, PortLine
from agent_economy.live.locks import AddressLocks
from agent_economy.live.plan import RobotPlan
from agent_economy.live.readings import Motion, Reading
from agent_economy.live.rules import Link, RobotInputs, Sample, Setpoint
from agent_economy.live.warden.connection import Connection, Share
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.live.warden.name_lookup import NameLookup
from agent_economy.live.warden.port_link import PortLink


class Report(Protocol):
    """Takes the messages of a line: that it was written, or that it was read, and its reading."""

    def __call__(self, *messages: Message) -> object:
        """Take all of them, or none."""


@dataclass(frozen=True)
class DriveContext:
    """What all robots of a drive have in common.

    Attributes:
        frame: The conversions of the world's geographic origin.
        stamp_s: Returns the time stamp of a line that is read now.
        report: Is called with the messages of each line.
        share: What is taken of one port in one turn.
    """

    frame: LocalFrame
    stamp_s: Callable[[], float]
    report: Report
    share: Share = field(default_factory=Share)


class Robot:
    """One robot, as the warden knows it.

    Attributes:
        plan: Its entry in the fleet file.
        driver: Its driver.
        links: The link of each port.
        setpoint: The newest setpoint of the loop.
        manual: The newest setpoint of the operator.
        readings: The newest reading of each port, and its time.
        written: The newest motor lines, and when they were written; None before.
        standing_s: Time for which stop was commanded, since the start.
        driving_s: Time for which it was not.
    """

    setpoint: Setpoint | None
    manual: Setpoint | None
    readings: dict[str, tuple[Reading, float]]
    written: tuple[str, float] | None

    def __init__(
        self, plan: RobotPlan, context: DriveContext, locks: AddressLocks | None = None
    ) -> None:
        """Create it without connecting.

        Args:
            plan: Its entry in the fleet file.
            context: What it has in common with the others.
            locks: Its locks, which have to be held while its motor port is connected; they are
                closed by the caller. By default, new ones.
        """
        self.plan, self.setpoint, self.manual = plan, None, None
        self.readings, self.written = {}, None
        self.standing_s = self.driving_s = 0.0
        self._commanded_s: float | None = None
        self._frame, self._stamp_s = context.frame, context.stamp_s
        self._report = context.report
        self.driver = DRIVERS[plan.driver]
        self._has_moved = False
        self._arrived: dict[str, deque[tuple[bytes, float]]] = {
            port: deque(maxlen=context.share.lines) for port in plan.ports
        }
        self._motors = MotorLines(self.driver, plan.settings, context.frame, plan.repeat_s)
        lookup, locks = NameLookup(plan.host), locks or AddressLocks()
        self.links = {
            port: PortLink(
                (plan.host, number),
                lookup,
                partial(Connection, partial(self._received, port), context.share),
                partial(self._connected, port),
                locks if port == self.driver.motor_port else None,
            )
            for port, number in plan.ports.items()
        }

    def start(self, tasks: asyncio.TaskGroup) -> None:
        """Start to connect all ports."""
        for link in self.links.values():
            tasks.create_task(link.run())

    def inputs(self, now_s: float) -> RobotInputs:
        """Return what the rules have to know, after the lines that have arrived; then read on."""
        for port, link in self.links.items():
            self._take_lines(port)
            link.connection.resume()
        links = {port: self._link(port, now_s) for port in self.links}
        samples = {
            port: Sample(at_s, reading.values) for port, (reading, at_s) in self.readings.items()
        }
        return RobotInputs(links, samples, self.setpoint, self.manual)

    def command(self, motion: Motion, now_s: float) -> None:
        """Write the motor lines that are due."""
        self._has_moved |= not motion.is_stop
        self._count(motion, now_s)
        lines = self._motors.due(motion, now_s, is_empty=self._is_empty())
        for line in lines:
            self._write(line, now_s)
        text = " ".join(
            line.data.decode("latin-1").strip()
            for line in lines
            if line.port == self.driver.motor_port
        )
        if text and self._motor_link.connection.is_up:
            self.written = (text, now_s)

    def write_again(self) -> None:
        """Write the next motor line at once, also if it is the same as the last one."""
        self._motors.forget()

    def is_acknowledged(self) -> bool:
        """Whether the robot's machine is known to have acknowledged its newest motor line."""
        return self._motor_link.connection.is_acknowledged()

    def is_quiet(self) -> bool:
        """Whether everything written has been acknowledged, or its port is down."""
        return all(link.connection.is_empty() for link in self.links.values())

    def has_stop(self) -> bool:
        """Whether stop can have reached it: it is connected, or has never moved."""
        return not self._has_moved or self.peer() is not None

    def peer(self) -> tuple[str, int] | None:
        """Return the numeric address of the connected motor port."""
        return self._motor_link.connection.peer()

    @property
    def _motor_link(self) -> PortLink:
        return self.links[self.driver.motor_port]

    def _count(self, motion: Motion, now_s: float) -> None:
        elapsed_s = 0.0 if self._commanded_s is None else now_s - self._commanded_s
        self._commanded_s = now_s
        if motion.is_stop:
            self.standing_s += elapsed_s
        else:
            self.driving_s += elapsed_s

    async def end(self) -> None:
        """Write stop behind everything, also behind a turn of the coprocessor; then close."""
        self._motors.forget()
        self.command(Motion(), self._stamp_s())
        await asyncio.gather(*(link.end() for link in self.links.values()))

    def _is_empty(self) -> bool:
        return self._motor_link.connection.is_empty()

    def _write(self, line: PortLine, now_s: float) -> None:
        connection = self.links[line.port].connection
        if connection.is_up:
            connection.write(line.data, now_s)
            self._report(self._message("written", line.port, line.data, now_s))

    def _link(self, port: str, now_s: float) -> Link:
        link = self.links[port]
        waiting_s = link.unacknowledged_s(now_s)
        return Link(link.connection.is_up, waiting_s, link.connection.reason)

    def _connected(self, port: str) -> None:
        self._arrived[port].clear()
        self.readings.pop(port, None)
        if port == self.driver.motor_port:
            self._motors.forget()
            self.command(Motion(), self._stamp_s())

    def _received(self, port: str, line: bytes) -> None:
        self._arrived[port].append((line, self._stamp_s()))

    def _take_lines(self, port: str) -> None:
        """Take the lines that have arrived, in order."""
        while self._arrived[port]:
            line, at_s = self._arrived[port].popleft()
            message = self._message("line", port, line, at_s)
            reading = self.driver.parse(port, line, self.plan.settings, self._frame)
            if reading is None:
                self._report(message)
            else:
                self.readings[port] = (reading, at_s)
                self._report(message, reading.message(self.plan.name, port, at_s))

    def _message(self, kind: str, port: str, line: bytes, at_s: float) -> Message:
        text = line.decode("latin-1")
        return {"type": kind, "robot": self.plan.name, "port": port, "t": at_s, "line": text}

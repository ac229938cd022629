"""One robot of the fleet: its connections, its newest samples and its motor lines."""

import asyncio
from collections import deque
from collections.abc import Callable
from functools import partial

from agent_economy.live.drivers import DRIVERS, PortLine
from agent_economy.live.plan import Origin, RobotPlan
from agent_economy.live.readings import Motion, Quantity, Reading
from agent_economy.live.rules import Link, RobotInputs, Sample, Setpoint
from agent_economy.live.warden.connection import MAX_LINES
from agent_economy.live.warden.geometry import world_of
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.live.warden.name_lookup import NameLookup
from agent_economy.live.warden.port_link import PortLink

ABORT_S = 2.0
"""Time without an acknowledgement after which a connection is opened again."""

LineReport = Callable[[str, str, bytes, float, bool], None]
"""Takes the robot, the port, a line, its time, and whether it was written."""


class Robot:
    """One robot, as the warden knows it.

    Attributes:
        plan: Its entry in the fleet file.
        setpoint: The newest setpoint of the loop.
    """

    def __init__(
        self, plan: RobotPlan, origin: Origin, stamp_s: Callable[[], float], report: LineReport
    ) -> None:
        """Create it without connecting.

        Args:
            plan: Its entry in the fleet file.
            origin: The geographic origin of the world.
            stamp_s: Returns the time stamp of a line that is read now.
            report: Is called with each line.
        """
        self.plan, self.setpoint = plan, None
        self._origin, self._stamp_s, self._report = origin, stamp_s, report
        self._driver = DRIVERS[plan.driver]
        self._has_moved = False
        self._samples: dict[str, Sample] = {}
        self._arrived: dict[str, deque[tuple[bytes, float]]] = {
            port: deque(maxlen=MAX_LINES) for port in plan.ports
        }
        self._motors = MotorLines(self._driver, plan.settings, origin, plan.repeat_s)
        lookup = NameLookup(plan.host)
        self._links = {
            port: PortLink(
                (plan.host, number),
                lookup,
                partial(self._received, port),
                partial(self._connected, port),
            )
            for port, number in plan.ports.items()
        }

    setpoint: Setpoint | None

    def start(self, tasks: asyncio.TaskGroup) -> None:
        """Start to connect all ports."""
        for link in self._links.values():
            tasks.create_task(link.run())

    def inputs(self, now_s: float) -> RobotInputs:
        """Return what the rules have to know, after the lines that have arrived."""
        for port in self._arrived:
            self._take_lines(port)
        links = {port: self._link(port, now_s) for port in self._links}
        return RobotInputs(links=links, samples=dict(self._samples), setpoint=self.setpoint)

    def command(self, motion: Motion, now_s: float) -> None:
        """Write the motor lines that are due."""
        self._has_moved |= not motion.is_stop
        lines = self._motors.due(motion, now_s, is_empty=self._is_empty())
        for line in lines:
            self._write(line, now_s)

    def is_quiet(self) -> bool:
        """Whether everything written has been acknowledged, or its port is down."""
        return all(link.connection.is_empty() for link in self._links.values())

    def has_stop(self) -> bool:
        """Whether stop can have reached it: it is connected, or has never moved."""
        return not self._has_moved or self.peer() is not None

    def peer(self) -> tuple[str, int] | None:
        """Return the numeric address of the connected motor port."""
        return self._links[self._driver.motor_port].connection.peer()

    async def end(self) -> None:
        """Write stop behind everything, also behind a turn of the coprocessor; then close."""
        self._motors.connected()
        self.command(Motion(), self._stamp_s())
        await asyncio.gather(*(link.end() for link in self._links.values()))

    def _is_empty(self) -> bool:
        return self._links[self._driver.motor_port].connection.is_empty()

    def _write(self, line: PortLine, now_s: float) -> None:
        connection = self._links[line.port].connection
        if connection.is_up:
            connection.write(line.data, now_s)
            self._report(self.plan.name, line.port, line.data, now_s, True)  # noqa: FBT003

    def _link(self, port: str, now_s: float) -> Link:
        connection = self._links[port].connection
        waiting_s = connection.unacknowledged_s(now_s)
        if waiting_s > ABORT_S:
            connection.abort()
        return Link(connection.is_up, waiting_s, connection.reason)

    def _connected(self, port: str) -> None:
        self._arrived[port].clear()
        self._samples.pop(port, None)
        if port == self._driver.motor_port:
            self._motors.connected()
            self.command(Motion(), self._stamp_s())

    def _received(self, port: str, line: bytes) -> None:
        self._arrived[port].append((line, self._stamp_s()))

    def _take_lines(self, port: str) -> None:
        """Take the lines that have arrived, in order."""
        while self._arrived[port]:
            line, at_s = self._arrived[port].popleft()
            self._report(self.plan.name, port, line, at_s, False)  # noqa: FBT003
            reading = self._driver.parse(port, line, self.plan.settings)
            if reading is not None:
                self._samples[port] = Sample(at_s, self._values(reading))

    def _values(self, reading: Reading) -> tuple[float | None, ...]:
        if reading.quantity is not Quantity.POSITION:
            return reading.values
        latitude, longitude = reading.values
        if latitude is None or longitude is None:
            return reading.values
        return world_of(self._origin, latitude, longitude)

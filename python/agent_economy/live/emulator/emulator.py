"""The emulator: robots in one world, paced by the wall clock, behind their TCP ports."""

import asyncio
import math
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, suppress
from dataclasses import asdict
from types import TracebackType
from typing import Any, Self

import numpy as np

from agent_economy.live.clock import now_s
from agent_economy.live.emulator import packet_loss
from agent_economy.live.emulator.control_port import ControlPort
from agent_economy.live.emulator.faults import PORTS, SENDING
from agent_economy.live.emulator.lines import LINE_ENDS
from agent_economy.live.emulator.log import Log
from agent_economy.live.emulator.ports import Port
from agent_economy.live.emulator.robot import Robot
from agent_economy.live.emulator.settings import Settings
from agent_economy.live.emulator.setup import Setup
from agent_economy.live.emulator.transport import pieces
from agent_economy.live.emulator.world import STEP_S, World
from agent_economy.scenario import Scenario, validation

MAX_BURST = 3
"""Maximum number of steps without a pause; what is behind that is skipped and logged."""


class Emulator:
    """Emulates one or more Benders: `async with Emulator(settings) as emulator`.

    Attributes:
        settings: The current settings.
        setup: What is fixed.
        log: Every line that was received or sent.
        robots: The robots.
    """

    def __init__(self, settings: Settings | None = None, setup: Setup | None = None) -> None:
        """Create the world; nothing listens yet.

        Raises:
            InputError: If the setup or the scenario has errors, or the log cannot be written.
        """
        self.settings, self.setup = settings or Settings(), setup or Setup()
        self.setup.check()
        scenario = self.setup.scenario
        scenario = scenario if isinstance(scenario, Scenario) else Scenario.load(scenario)
        self._world = World(scenario, self.setup.robots, self.setup.seed, self.settings)
        self._random = np.random.default_rng(self.setup.seed)
        parts = self._world.frame, self._world.max_range_m, self.settings
        self.robots = [Robot(name, *parts) for name in self._world.robots]
        self._ports = [
            {name: self._port(index, name) for name in PORTS} for index in range(len(self.robots))
        ]
        self._control = ControlPort(self)
        # The first lines are due at once.
        self._next_s = {
            (index, port): 0.0 for index, _ in enumerate(self.robots) for port in SENDING
        }
        self._open = ExitStack()
        self._running: asyncio.Task[None] | None = None
        self.log = Log(self.setup.log)

    def _port(self, robot: int, name: str) -> Port:
        def receive(line: bytes) -> None:
            self._receive(robot, name, line)

        def report(event: str) -> None:
            self.log.add(event, robot, name)

        return Port(self.setup.host, receive, report)

    async def __aenter__(self) -> Self:
        """Listen on all ports and start the world.

        Raises:
            InputError: If an address cannot be used.
        """
        with ExitStack() as stack:
            stack.callback(self.log.close)
            for robot, ports in enumerate(self._ports):
                for name, number in self.setup.numbers(robot).items():
                    stack.callback(ports[name].close)
                    await ports[name].listen(number)
            stack.callback(self._control.close)
            await self._control.listen(self.setup.host, self.setup.control)
            self._open = stack.pop_all()
        self._limit_motor_clients()
        self._sense()
        self._running = asyncio.create_task(self._run())
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop the world and close all connections."""
        with self._open:
            if self._running:
                self._running.cancel()
                with suppress(asyncio.CancelledError):
                    await self._running

    async def finished(self) -> None:
        """Wait until the world stops, which it does by an error only, and raise that."""
        if self._running:
            await self._running

    def ports(self, robot: int) -> dict[str, int]:
        """Return the port numbers of a robot, by name."""
        return {name: port.number for name, port in self._ports[robot].items()}

    @property
    def control_port(self) -> int:
        """Number of the control port."""
        return self._control.number

    def addresses(self) -> dict[str, Any]:
        """Return the host, the ports of each robot and the control port."""
        robots = [{"name": each.name} | self.ports(index) for index, each in enumerate(self.robots)]
        return {"host": self.setup.host, "robots": robots, "control": self.control_port}

    async def fault(
        self, robot: int, port: str, name: str, value: Any = None, *, on: bool = True
    ) -> None:
        """Switch a fault of a port on or off.

        Args:
            robot: Number of the robot.
            port: Name of the port.
            name: Name of the fault.
            value: Its value; None for the default.
            on: Whether to switch it on.

        Raises:
            InputError: If the port cannot have it, or an argument is not allowed.
        """
        validation.whole("robot", robot, 0, len(self.robots) - 1)
        validation.check(port in PORTS, "port", port, f"one of {', '.join(PORTS)}")
        is_possible = name != "cut" or not on or packet_loss.IS_SUPPORTED
        validation.check(is_possible, "fault", name, "another one: this one needs Linux")
        faults, server = self.robots[robot].faults[port], self._ports[robot][port]
        faults.switch(port, name, value, on=on)
        self.log.add("fault", robot, port, fault=name, on=on, value=faults.get(name))
        match name:
            case "close":
                server.close_clients()
                faults.pop(name, None)
            case "refuse":
                await server.refuse(on=on)
            case "stall":
                server.stall(on=on)
            case "cut":
                server.cut(on=on)

    def set(self, values: Mapping[str, Any]) -> None:
        """Change settings, by name.

        Raises:
            InputError: If a name is unknown or a value is not allowed. It lists all errors, and
                nothing is changed.
        """
        settings = self.settings.changed(values)
        self._world.set_errors(settings)
        self.settings = settings
        for robot in self.robots:
            robot.settings = settings
        self._limit_motor_clients()
        # A line that was due in an hour would still be.
        self._next_s = dict.fromkeys(self._next_s, 0.0)
        self.log.add("set", None, None, values=dict(values))

    def _limit_motor_clients(self) -> None:
        for ports in self._ports:
            ports["motors"].max_clients = 1 if self.settings.motor_connections == "one" else None

    def settings_as_dict(self) -> dict[str, Any]:
        """Return all settings, by name, as values of JSON, which has no infinite numbers."""
        settings = asdict(self.settings)
        return {name: "inf" if value == math.inf else value for name, value in settings.items()}

    def state(self) -> dict[str, Any]:
        """Return the times and the state of each robot: pose, motors, lines, faults, clients."""
        robots = [self._robot_state(index) for index in range(len(self.robots))]
        return {"t_s": now_s(), "simulated_s": self._world.time_s, "robots": robots}

    def _robot_state(self, index: int) -> dict[str, Any]:
        robot, ports = self.robots[index], self._ports[index]
        return {
            "name": robot.name,
            "pose": asdict(self._world.pose(robot.name)),
            **robot.state(),
            "connections": {name: port.connections for name, port in ports.items()},
        }

    def _receive(self, robot: int, port: str, line: bytes) -> None:
        parts = pieces(line, b"", self.robots[robot].faults[port], self._random)
        if not parts:
            self._log_line("lost", robot, port, line)
        for delay_s, part in parts:
            if delay_s > 0:
                asyncio.get_running_loop().call_later(delay_s, self._obey, robot, port, part)
            else:
                self._obey(robot, port, part)

    def _obey(self, robot: int, port: str, line: bytes) -> None:
        result = self.robots[robot].obey(port, line, now_s())
        self._log_line("received", robot, port, line, result=result)

    def _log_line(self, event: str, robot: int, port: str, line: bytes, **facts: Any) -> None:
        self.log.add(event, robot, port, line=line.decode("ascii", "backslashreplace"), **facts)

    async def _run(self) -> None:
        """Step the world at the pace of the clock: never ahead of it, never many steps at once."""
        begin_s, done = now_s(), 0
        while True:
            behind = int((now_s() - begin_s) / STEP_S) - done
            if behind > MAX_BURST:
                skipped = behind - MAX_BURST
                self.log.add("behind", None, None, skipped_s=round(skipped * STEP_S, 3))
                begin_s += skipped * STEP_S
            for _ in range(min(behind, MAX_BURST)):
                self._step()
                done += 1
            await asyncio.sleep(max(0.0, begin_s + (done + 1) * STEP_S - now_s()))

    def _step(self) -> None:
        for index, robot in enumerate(self.robots):
            if robot.stops_unattended(now_s()):
                self.log.add("deadman", index, "motors")
        self._world.step({robot.name: robot.motion() for robot in self.robots})
        self._sense()
        for index, port in self._due():
            self._send(index, port)

    def _sense(self) -> None:
        for robot in self.robots:
            robot.senses = self._world.senses(robot.name, robot.senses)

    def _due(self) -> Iterator[tuple[int, str]]:
        """Yield the ports whose next line is due, and set when the one after it is."""
        # Half a step early, so that rounding does not add a step.
        time_s = self._world.time_s + STEP_S / 2
        for key, next_s in self._next_s.items():
            rate_hz = getattr(self.settings, f"{key[1]}_hz")
            if rate_hz > 0 and time_s >= next_s:
                self._next_s[key] = max(next_s, time_s - STEP_S) + 1 / rate_hz
                yield key

    def _send(self, index: int, port: str) -> None:
        robot = self.robots[index]
        line = robot.line(port)
        if line is None:
            return
        end = LINE_ENDS[self.settings.line_end]
        parts = pieces(line, end, robot.faults[port], self._random)
        if self._ports[index][port].send(parts):
            self._log_line("sent" if parts else "lost", index, port, line)

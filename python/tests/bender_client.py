"""A program that drives an emulated Bender over its ports, for tests."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from agent_economy.live.emulator import Emulator, Settings, Setup
from agent_economy.scenario import Override, Scenario

EXACT = {
    "gps_noise_m": 0,
    "gps_drift_m": 0,
    "compass_noise_deg": 0,
    "lag_s": 0,
    "delay_s": 0,
    "gain_left_right": 1,
}
"""Settings of an ideal robot: its sensors and its drive have no errors."""

FAST = {"compass_hz": 20, "gps_hz": 20, "sonar_hz": 20}
"""Settings with lines in every step."""


def placed(at_m: list[list[float]], heading_deg: list[float]) -> Scenario:
    """Return the bundled scenario with other start poses, and exact sonars."""
    values: dict[str, Any] = {
        "robots.bender.start": {"kind": "fixed", "at_m": at_m, "heading_deg": heading_deg}
    }
    values |= {f"robots.bender.sensors.sonar_{index}.noise_m": 0.0 for index in range(6)}
    overrides = (Override.at(path, value, "test") for path, value in values.items())
    return Scenario.load("bender").changed(tuple(overrides))


class Client:
    """A connection to one port."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Keep the streams of a connection."""
        self.reader, self.writer = reader, writer

    @classmethod
    async def to(cls, number: int) -> "Client":
        """Connect to a port."""
        return cls(*await asyncio.open_connection("127.0.0.1", number))

    def write(self, text: str) -> None:
        """Write at once."""
        self.writer.write(text.encode())

    async def data(self, seconds: float) -> bytes:
        """Return all that is received in some time, or until the connection is closed."""
        received = bytearray()
        try:
            async with asyncio.timeout(seconds):
                while part := await self.reader.read(4096):
                    received += part
        except TimeoutError:
            pass
        return bytes(received)

    async def lines(self, seconds: float) -> list[str]:
        """Return the complete lines that are received in some time."""
        return (await self.data(seconds)).decode("latin1").split("\n")[:-1]

    async def line(self) -> str:
        """Return the next line."""
        async with asyncio.timeout(3):
            return (await self.reader.readline()).decode("latin1").rstrip("\r\n")

    async def is_closed(self) -> bool:
        """Return whether the other side closes the connection within a moment."""
        async with asyncio.timeout(3):
            try:
                while await self.reader.read(4096):
                    pass
            except ConnectionError:
                pass
        return True


def emulate(
    story: Callable[[Emulator], Awaitable[None]],
    settings: dict[str, Any] | None = None,
    **setup: Any,
) -> None:
    """Run a test with an emulator on free ports."""

    async def run() -> None:
        given = Settings().changed(EXACT | (settings or {}))
        async with Emulator(given, Setup(**setup)) as emulator:
            await story(emulator)

    asyncio.run(run())


def stepped(settings: dict[str, Any] | None = None, **setup: Any) -> Emulator:
    """Return an emulator that the test steps by hand, without sockets or waiting."""
    emulator = Emulator(Settings().changed(EXACT | (settings or {})), Setup(**setup))
    emulator._sense()
    return emulator


def step(emulator: Emulator, seconds: float) -> None:
    """Step by some simulated time."""
    for _ in range(round(seconds * 20)):
        emulator._step()

"""What a kind of robot has to define. A driver is one file in this package.

The functions of a driver are pure: bytes, settings and the frame of the world in, readings and
lines out. Sockets, clocks and rules are the warden's.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy._core import LocalFrame
from agent_economy.live.drivers.lines import MAX_LINE_BYTES
from agent_economy.live.readings import Motion, Quantity, Reading

Settings = Mapping[str, Any]
"""The settings of one robot, complete and checked: `Driver.settings` filled with its defaults."""


@dataclass(frozen=True)
class Setting:
    """One setting of a driver.

    Attributes:
        default: The value without the key; None if there is none.
        description: What it is, in a sentence.
        schema: The JSON Schema of its values.
        is_guess: Whether the default is a guess that has to be measured on the robot.
    """

    default: Any
    description: str
    schema: Mapping[str, Any]
    is_guess: bool = False


@dataclass(frozen=True)
class Port:
    """One TCP port of a robot.

    Attributes:
        name: Its name in fleet files and recordings.
        number: Its usual number.
        quantity: What its lines measure; None if the robot sends nothing on it.
        max_age_s: The usual age at which its newest line is stale; None without a quantity.
        values: The number of values of a reading; 0 without a quantity.
    """

    name: str
    number: int
    quantity: Quantity | None
    max_age_s: float | None
    values: int = 0


@dataclass(frozen=True)
class PortLine:
    """A line to write, with the port that it goes to; it includes its end."""

    port: str
    data: bytes


class Driver(ABC):
    """A kind of robot that can be driven."""

    name: str
    """Its name in fleet files."""
    ports: tuple[Port, ...]
    """Its ports, in the order in which they are connected."""
    motor_port: str
    """The port that takes motor lines."""
    settings: Mapping[str, Setting]
    """Its settings, by key."""

    def parse(
        self, port: str, line: bytes, settings: Settings, frame: LocalFrame
    ) -> Reading | None:
        """Return the reading of a line without its end, or None if the line is malformed.

        A line that is longer than `MAX_LINE_BYTES` is malformed, whatever it contains: the warden
        has a bounded time for a line.
        """
        if len(line) > MAX_LINE_BYTES:
            return None
        return self.reading(port, line, settings, frame)

    @abstractmethod
    def reading(
        self, port: str, line: bytes, settings: Settings, frame: LocalFrame
    ) -> Reading | None:
        """Return the reading of a line of bounded length, or None if the line is malformed.

        It is in SI units and in the frame of the world: the functions of `agent_economy.live.frame`
        convert places and bearings, whatever their values are. Nothing may be raised, and the time
        must be linear in the length of the line.
        """

    @abstractmethod
    def stop(self, settings: Settings) -> tuple[PortLine, ...]:
        """Return the lines that stop the robot; the last one alone must stop it."""

    @abstractmethod
    def move(self, motion: Motion, settings: Settings) -> tuple[PortLine, ...]:
        """Return the lines of a motion. The robot repeats it until the next line."""

    @abstractmethod
    def turn_to(self, magnetic_bearing_deg: float, settings: Settings) -> tuple[PortLine, ...]:
        """Return the lines that let the robot turn to a heading by itself; none if it cannot."""

    @abstractmethod
    def tracks(self, left: int, right: int, settings: Settings) -> Motion:
        """Return the motion that two motor values request, with those values.

        Raises:
            ValueError: If the robot takes no such values.
        """

    @abstractmethod
    def used_charge(self, standing_s: float, driving_s: float, settings: Settings) -> float | None:
        """Return an estimate of the share of a full charge that was used, at most 1.

        None if the robot reports its charge, or nothing is known of it.
        """

    @abstractmethod
    def motion(self, motion: Motion, settings: Settings) -> Motion:
        """Return the motion that the lines of `move` cause, as far as the settings describe it."""

    def contradictions(
        self,
        settings: Settings,  # noqa: ARG002  (of drivers that have some)
        latitude_deg: float,  # noqa: ARG002
        longitude_deg: float,  # noqa: ARG002
    ) -> Iterable[tuple[str, str]]:
        """Return settings that contradict the place of the world, each with its effect and a fix.

        Args:
            settings: The settings of a robot.
            latitude_deg: Latitude of the origin of the world.
            longitude_deg: Longitude of the origin, positive to the east.
        """
        return ()

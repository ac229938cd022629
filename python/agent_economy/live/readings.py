"""What a driver reads from the lines of a robot, and what it may be commanded."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Quantity(StrEnum):
    """What an input of a robot measures, and the unit of its values."""

    RANGES = "ranges"
    """Metres, one value per sonar; infinite where nothing is seen, None where no value came."""
    HEADING = "heading"
    """Radians anticlockwise from the x axis of the world."""
    POSITION = "position"
    """x and y in metres of the world."""
    BATTERY = "battery"
    """The remaining share of the charge, 0 to 1."""


COUNTS = {Quantity.HEADING: 1, Quantity.POSITION: 2, Quantity.BATTERY: 1}
"""The number of values; that of ranges depends on the robot."""

NOT_FINITE: Mapping[str, float] = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}
"""The names, in messages and recordings, of numbers that JSON does not have."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The values of one valid line, in SI units and in the frame of the world.

    Attributes:
        quantity: What they measure.
        values: The values, in the unit of the quantity. They may be impossible (NaN, out of
            range): rules judge that.
    """

    quantity: Quantity
    values: tuple[float | None, ...]

    def message(self, robot: str, port: str, at_s: float) -> dict[str, Any]:
        """Return it as a message for the loop and the recording: plain values for JSON."""
        values = [_plain(value) for value in self.values]
        return {
            "type": "reading",
            "robot": robot,
            "port": port,
            "t": at_s,
            "quantity": self.quantity.value,
            "values": values,
        }


def reading_of(message: Mapping[str, Any]) -> Reading:
    """Return the reading that `Reading.message` described."""
    values = tuple(
        NOT_FINITE[value] if isinstance(value, str) else value for value in message["values"]
    )
    return Reading(Quantity(message["quantity"]), values)


def _plain(value: float | None) -> float | str | None:
    return value if value is None or math.isfinite(value) else repr(value)


@dataclass(frozen=True, slots=True)
class Motion:
    """A motion that a robot is commanded to make.

    Attributes:
        speed_m_s: Forward speed; negative is reverse.
        turn_rate_rad_s: Anticlockwise.
        heading_rad: The heading to turn to, for robots that turn by themselves; None to turn at
            the rate.
        tracks: The motor values of the left and the right track that an operator requested, of
            which speed and turn rate are the effect; None if the driver selects them.
    """

    speed_m_s: float = 0.0
    turn_rate_rad_s: float = 0.0
    heading_rad: float | None = None
    tracks: tuple[int, int] | None = None

    @property
    def is_stop(self) -> bool:
        """Whether it is a stop."""
        return self.speed_m_s == 0.0 and self.turn_rate_rad_s == 0.0 and self.heading_rad is None


STOP = Motion()

"""The text lines of the robot: what it sends, and the commands that it reads."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

LINE_ENDS = {"lf": b"\n", "crlf": b"\r\n", "cr": b"\r"}

MAX_LINE_BYTES = 4096
"""What is received without a line end is dropped beyond this."""

FULL_TURN_DEG = 360.0
MAX_VALUE = 255

LEFT, RIGHT, BOTH, STOP = range(4)
"""Channels of a motor line."""

_MOTOR = re.compile(rb"x,([012]),(\d{1,3}),|x,3,(?:\d{1,3},)?")
_HEADING = re.compile(rb"\s*[+-]?(\d+(?:\.\d*)?|\.\d+)([eE][+-]?\d{1,2})?\s*")


@dataclass(frozen=True)
class MotorCommand:
    """A motor line: a channel and its value; a stop has none."""

    channel: int
    value: int | None = None


class LineReader:
    """Collects received bytes and returns complete lines, ended by LF, CR or CR LF."""

    def __init__(self) -> None:
        """Start without any bytes."""
        self._rest = b""

    def feed(self, data: bytes) -> list[bytes]:
        """Return the non-empty lines that are complete now, without their ends."""
        *lines, self._rest = (self._rest + data).replace(b"\r", b"\n").split(b"\n")
        self._rest = self._rest[-MAX_LINE_BYTES:]
        return [line for line in lines if line]


def motor_command(line: bytes) -> MotorCommand | None:
    """Return the command of a motor line without its end; None if it is malformed.

    Any line of channel 3 is a stop, with or without a value.
    """
    match = _MOTOR.fullmatch(line)
    if match is None:
        return None
    if match[1] is None:
        return MotorCommand(STOP)
    value = int(match[2])
    return MotorCommand(int(match[1]), value) if value <= MAX_VALUE else None


def desired_heading_deg(line: bytes) -> float | None:
    """Return the heading of a line to the compass port, 0 to 360; None if it is malformed."""
    if len(line) < 2 or _HEADING.fullmatch(line) is None:  # noqa: PLR2004  (as in 2002: no data)
        return None
    heading_deg = float(line)
    return heading_deg if 0 <= heading_deg <= FULL_TURN_DEG else None


def compass_fields(heading_deg: float) -> list[str]:
    """Return the field of a compass line, 0.0 to 359.9."""
    return [f"{round(heading_deg, 1) % FULL_TURN_DEG:.1f}"]


def gps_fields(
    latitude_deg: float, longitude_deg: float, digits: int, *, has_longitude_letter: bool = True
) -> list[str]:
    """Return the fields of a GPS line: degrees, decimal minutes and hemisphere, twice.

    Args:
        latitude_deg: Positive to the north.
        longitude_deg: Positive to the east, any number of turns.
        digits: Decimal places of the minutes.
        has_longitude_letter: Whether the last field is there.
    """
    half = FULL_TURN_DEG / 2
    longitude_deg = (longitude_deg + half) % FULL_TURN_DEG - half
    latitude = [*_degrees_minutes(latitude_deg, digits), "S" if latitude_deg < 0 else "N"]
    letter = ["W" if longitude_deg < 0 else "E"] if has_longitude_letter else []
    return [*latitude, *_degrees_minutes(longitude_deg, digits), *letter]


def _degrees_minutes(angle_deg: float, digits: int) -> list[str]:
    # In whole units of the last digit, so that 59.99999' becomes a degree instead of 60'.
    scale = 10**digits
    degrees, rest = divmod(round(abs(angle_deg) * 60 * scale), 60 * scale)
    return [str(degrees), f"{rest / scale:.{digits}f}"]


def sonar_fields(ranges: Sequence[float]) -> list[str]:
    """Return the fields of a sonar line, in the unit of the ranges."""
    return [f"{each:.2f}" for each in ranges]


def faulty(fields: list[str], faults: Mapping[str, Any]) -> list[str]:
    """Return the fields of a line under the faults of its port that concern its values."""
    if "nan" in faults:
        fields = [each if each.isalpha() and each != "inf" else "NaN" for each in fields]
    if "one_digit" in faults:
        fields = [str(faults["one_digit"])]
    if "seven" in faults:
        fields = [*fields, fields[-1]]
    return fields[: faults["short"]] if "short" in faults else fields

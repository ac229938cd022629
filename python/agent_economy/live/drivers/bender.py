"""Bender, the tracked robot of 2003 (Williams 2003, chapter III.A and appendix B).

The robot is a server on four TCP ports. On three of them it sends text lines at its own rate;
nothing is acknowledged, numbered or time-stamped. A motor command holds until the next one.

Units that the source leaves open are settings. Their defaults are guesses.
"""

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy._core import LocalFrame
from agent_economy.live.drivers.driver import Driver, Port, PortLine, Setting, Settings
from agent_economy.live.frame import heading_rad, position_m
from agent_economy.live.readings import Motion, Quantity, Reading

NEUTRAL = 150
"""The motor value at which a track is stationary."""

FORWARD, REVERSE = 175, 75
"""The motor values that the 2002 program used for full speed forward and in reverse."""

SLIDER_VALUES = (100, 200)
"""The motor values that the sliders of the 2002 program had, and that an operator may request."""

SECONDS_PER_HOUR = 3600.0
SONARS = 6
POSITION_FIELDS = 5
FULL_TURN_DEG, HALF_TURN_DEG = 360.0, 180.0
EARTH_RADIUS_M = 6_371_000.0
MINUTES_PER_DEG = 60.0

_LEFT, _RIGHT, _BOTH = 0, 1, 2
_STOP = b"x,3,\n"
_NUMBER = re.compile(rb"(?i:[+-]?((\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?|nan|infinity|inf))")
"""No two adjacent parts take the same characters: a mismatch is found in linear time."""

MAX_NUMBER_LENGTH = 40
"""Longer numbers are malformed: no receiver writes that."""

COMPASS_DEG = (-360.0, 720.0)
"""What a compass can send: a turn around either end of its scale."""

_SIGNS = {b"N": 1.0, b"S": -1.0, b"E": 1.0, b"W": -1.0}


INFINITY = "inf"
"""The name of infinity in fleet files: no JSON Schema allows the number itself."""


def _number(low: float, high: float) -> dict[str, Any]:
    return {"type": "number", "minimum": low, "maximum": high}


def _whole(low: int, high: int) -> dict[str, Any]:
    return {"type": "integer", "minimum": low, "maximum": high}


def _names(*names: str) -> dict[str, Any]:
    return {"enum": list(names)}


class Bender(Driver):
    """The driver of Bender."""

    name = "bender"
    ports = (
        Port("motors", 2000, None, None),
        Port("compass", 2001, Quantity.HEADING, 1.0, 1),
        Port("gps", 2002, Quantity.POSITION, 3.0, 2),
        Port("sonar", 2003, Quantity.RANGES, 0.5, SONARS),
    )
    motor_port = "motors"
    settings: Mapping[str, Setting] = {
        "compass_offset_deg": Setting(
            10.0,
            "Degrees that are subtracted from each heading: the mounting error of the compass.",
            _number(-180, 180),
        ),
        "range_unit_m": Setting(
            0.3048, "Metres per unit of the sonars: feet.", _number(0.001, 10), is_guess=True
        ),
        "no_echo": Setting(
            None,
            "The value of a sonar that sees nothing, in its own units.",
            {"anyOf": [_number(-1e6, 1e6), {"const": INFINITY}]},
            is_guess=True,
        ),
        "hemisphere": Setting(
            "W", "Hemisphere of longitudes that the robot sends without a letter.", _names("E", "W")
        ),
        "forward_m_s_per_unit": Setting(
            0.02,
            "Speed of a track per unit of the motor value above 150, in m/s.",
            _number(1e-4, 1),
            is_guess=True,
        ),
        "reverse_m_s_per_unit": Setting(
            0.02,
            "Speed of a track per unit of the motor value below 150, in m/s.",
            _number(1e-4, 1),
            is_guess=True,
        ),
        "track_width_m": Setting(
            0.5, "Distance between the tracks, in metres.", _number(0.05, 5), is_guess=True
        ),
        "max_forward_value": Setting(
            200, "The largest motor value that is sent.", _whole(151, 255), is_guess=True
        ),
        "min_reverse_value": Setting(
            75, "The smallest motor value that is sent.", _whole(0, 149), is_guess=True
        ),
        "battery_standing_h": Setting(
            8.0,
            "Hours for which a full battery is assumed to last while the robot stands. It reports "
            "no charge: this is for the estimate that is displayed.",
            _number(0.01, 1000),
        ),
        "battery_driving_h": Setting(
            2.0,
            "Hours for which a full battery is assumed to last while the robot drives.",
            _number(0.01, 1000),
        ),
        "turn": Setting(
            "motors",
            "What turns the robot to a heading: its motors, commanded by the brain, or the "
            "coprocessor of the robot by itself.",
            _names("motors", "coprocessor"),
        ),
        "heading_frame": Setting(
            "corrected",
            "Frame of the headings that are sent to the coprocessor: that of its raw compass, or "
            "the one without the mounting error, as the program of 2002 sent them.",
            _names("raw", "corrected"),
            is_guess=True,
        ),
    }

    def reading(
        self, port: str, line: bytes, settings: Settings, frame: LocalFrame
    ) -> Reading | None:
        """Return the reading of a line, or None if the line is malformed.

        A heading of one digit is a reading; the 2002 program ignored lines of one character. A
        line with fewer than six ranges has none for the others; one with more is malformed.
        """
        try:
            match port:
                case "compass":
                    return self._heading(line, settings, frame)
                case "gps":
                    return self._position(line, settings, frame)
                case "sonar":
                    return self._ranges(line, settings)
        except ValueError:
            return None
        return None

    def stop(self, settings: Settings) -> tuple[PortLine, ...]:  # noqa: ARG002  (one line for all)
        """Return the line that stops the robot. It also cancels a turn of the coprocessor."""
        return (PortLine(self.motor_port, _STOP),)

    def move(self, motion: Motion, settings: Settings) -> tuple[PortLine, ...]:
        """Return the lines of a motion: one if both tracks move alike, otherwise two."""
        left, right = motion.tracks or self._values(motion, settings)
        left, right = (self._allowed(value, settings) for value in (left, right))
        if left == right == NEUTRAL:
            return self.stop(settings)
        if left == right:
            return (self._track(_BOTH, left),)
        return (self._track(_LEFT, left), self._track(_RIGHT, right))

    def turn_to(self, magnetic_bearing_deg: float, settings: Settings) -> tuple[PortLine, ...]:
        """Return the lines that let the coprocessor turn the robot, after a stop.

        The program of 2002 sent the bearing without the mounting offset of the compass.
        """
        if settings["turn"] != "coprocessor":
            return ()
        is_raw = settings["heading_frame"] == "raw"
        sent_deg = magnetic_bearing_deg + (settings["compass_offset_deg"] if is_raw else 0.0)
        # Rounded first, so that 359.999 is 0.00.
        line = f"{round(sent_deg, 2) % FULL_TURN_DEG:.2f}\n"
        return (*self.stop(settings), PortLine("compass", line.encode()))

    def tracks(self, left: int, right: int, settings: Settings) -> Motion:
        """Return the motion that two values of the sliders of 2002 request.

        Raises:
            ValueError: If one is not a whole number from 100 to 200.
        """
        low, high = SLIDER_VALUES
        for value in (left, right):
            if not low <= value <= high:
                message = f"left and right must be whole numbers from {low} to {high}"
                raise ValueError(message)
        allowed = (self._allowed(value, settings) for value in (left, right))
        left_m_s, right_m_s = (self._speed(value, settings) for value in allowed)
        turn_rate = (right_m_s - left_m_s) / settings["track_width_m"]
        return Motion((left_m_s + right_m_s) / 2, turn_rate, tracks=(left, right))

    def used_charge(self, standing_s: float, driving_s: float, settings: Settings) -> float | None:
        """Return an estimate: the robot reports no charge."""
        standing_h, driving_h = standing_s / SECONDS_PER_HOUR, driving_s / SECONDS_PER_HOUR
        used = (
            standing_h / settings["battery_standing_h"] + driving_h / settings["battery_driving_h"]
        )
        return float(min(1.0, used))

    def motion(self, motion: Motion, settings: Settings) -> Motion:
        """Return the motion that the lines of `move` cause, as far as the settings describe it."""
        left, right = (self._speed(value, settings) for value in self._values(motion, settings))
        width_m = settings["track_width_m"]
        return Motion((left + right) / 2, (right - left) / width_m)

    def contradictions(
        self, settings: Settings, latitude_deg: float, longitude_deg: float
    ) -> Iterator[tuple[str, str]]:
        """Yield the hemisphere if the origin of the world is in the other one."""
        east_deg = (longitude_deg + HALF_TURN_DEG) % FULL_TURN_DEG - HALF_TURN_DEG
        given = settings["hemisphere"]
        letter = "W" if east_deg < 0 else "E"
        if letter != given and east_deg % HALF_TURN_DEG != 0:
            distance = _distance(_mirrored_m(latitude_deg, east_deg))
            effect = (
                f"the origin of the scenario is at {abs(east_deg):.4g} {letter}: a receiver that "
                f"sends no letter is taken to be at {abs(east_deg):.4g} {given}, {distance} from "
                f'the origin; set hemisphere = "{letter}"'
            )
            yield "hemisphere", effect

    def _values(self, motion: Motion, settings: Settings) -> tuple[int, int]:
        half_m_s = motion.turn_rate_rad_s * settings["track_width_m"] / 2
        speeds = (motion.speed_m_s - half_m_s, motion.speed_m_s + half_m_s)
        left, right = (self._value(speed, settings) for speed in speeds)
        return left, right

    def _value(self, speed_m_s: float, settings: Settings) -> int:
        if not math.isfinite(speed_m_s):
            return NEUTRAL
        key = "forward_m_s_per_unit" if speed_m_s >= 0 else "reverse_m_s_per_unit"
        return self._allowed(NEUTRAL + round(speed_m_s / settings[key]), settings)

    def _allowed(self, value: int, settings: Settings) -> int:
        return int(max(settings["min_reverse_value"], min(settings["max_forward_value"], value)))

    def _speed(self, value: int, settings: Settings) -> float:
        key = "forward_m_s_per_unit" if value >= NEUTRAL else "reverse_m_s_per_unit"
        return float((value - NEUTRAL) * settings[key])

    def _track(self, channel: int, value: int) -> PortLine:
        return PortLine(self.motor_port, f"x,{channel},{value},\n".encode())

    def _heading(self, line: bytes, settings: Settings, frame: LocalFrame) -> Reading:
        low, high = COMPASS_DEG
        raw = number(line)
        # A value far outside the scale is no heading: taken modulo, it would look possible.
        degrees = raw - settings["compass_offset_deg"] if low <= raw <= high else math.nan
        return Reading(Quantity.HEADING, (heading_rad(frame, degrees % FULL_TURN_DEG),))

    def _position(self, line: bytes, settings: Settings, frame: LocalFrame) -> Reading | None:
        fields = [field.strip().upper() for field in line.split(b",")]
        if len(fields) < POSITION_FIELDS:
            return None
        is_east_given = len(fields) > POSITION_FIELDS and fields[POSITION_FIELDS] in (b"E", b"W")
        east = fields[POSITION_FIELDS] if is_east_given else settings["hemisphere"].encode()
        north = fields[2]
        if north not in (b"N", b"S"):
            return None
        latitude = _SIGNS[north] * _angle_deg(fields[0], fields[1])
        longitude = _SIGNS[east] * _angle_deg(fields[3], fields[4])
        return Reading(Quantity.POSITION, position_m(frame, latitude, longitude))

    def _ranges(self, line: bytes, settings: Settings) -> Reading | None:
        # The program of 2002 ignored a comma at the end.
        fields = line.strip().removesuffix(b",").split(b",")
        if len(fields) > SONARS:
            return None
        ranges = [self._range(number(field), settings) for field in fields]
        return Reading(Quantity.RANGES, (*ranges, *[None] * (SONARS - len(ranges))))

    def _range(self, value: float, settings: Settings) -> float:
        no_echo = settings["no_echo"]
        if no_echo is not None and value == float(no_echo):
            return math.inf
        range_m = value * settings["range_unit_m"]
        # Infinity is a range only where a setting states that it means nothing seen.
        return range_m if math.isfinite(range_m) else math.nan


def _mirrored_m(latitude_deg: float, east_deg: float) -> float:
    """Return the distance of a place from the one at the opposite longitude."""
    half = math.cos(math.radians(latitude_deg)) * math.sin(math.radians(east_deg))
    return 2 * EARTH_RADIUS_M * math.asin(min(1.0, abs(half)))


def _distance(distance_m: float) -> str:
    whole_km = round(distance_m / 1000)
    return f"{whole_km:,} km" if whole_km > 0 else f"{distance_m:.0f} m"


def _angle_deg(degrees: bytes, minutes: bytes) -> float:
    whole, part = number(degrees), number(minutes)
    # A sign would apply to the degrees only, and give a wrong place that looks possible.
    if whole < 0 or part < 0 or part >= MINUTES_PER_DEG:
        raise ValueError
    return whole + part / MINUTES_PER_DEG


def number(text: bytes) -> float:
    """Return a decimal number, as the 2002 program read them: also NaN and Infinity.

    Raises:
        ValueError: If it is none.
    """
    text = text.strip()
    if len(text) > MAX_NUMBER_LENGTH or _NUMBER.fullmatch(text) is None:
        raise ValueError
    return float(text)

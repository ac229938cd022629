"""The geodesy of a drive: places and bearings of the earth in the world, and back.

A `LocalFrame` raises an error outside its ranges. What a robot sends and what a program requests
may be anything: the functions here return NaN or None for what has no place in the world.
"""

import math

from agent_economy._core import InputError, LocalFrame
from agent_economy.live.plan import Origin, Point

MAX_LATITUDE_DEG, MAX_LONGITUDE_DEG = 90.0, 360.0
FULL_TURN_DEG, HALF_TURN_DEG = 360.0, 180.0

NOWHERE = (math.nan, math.nan)
"""The position of what is no place on the earth."""


def frame_of(origin: Origin) -> LocalFrame:
    """Return the conversions of a geographic origin."""
    return LocalFrame(
        origin.latitude_deg, origin.longitude_deg, origin.rotation_deg, origin.declination_deg
    )


def position_m(frame: LocalFrame, latitude_deg: float, longitude_deg: float) -> Point:
    """Return the position of a place in the world; `NOWHERE` if there is no such place."""
    if not (abs(latitude_deg) <= MAX_LATITUDE_DEG and abs(longitude_deg) <= MAX_LONGITUDE_DEG):
        return NOWHERE
    if abs(longitude_deg) > HALF_TURN_DEG:
        longitude_deg -= math.copysign(FULL_TURN_DEG, longitude_deg)
    return frame.to_local(latitude_deg, longitude_deg)


def heading_rad(frame: LocalFrame, magnetic_bearing_deg: float) -> float:
    """Return the heading of a bearing in the world; NaN beyond a full turn."""
    if not abs(magnetic_bearing_deg) <= FULL_TURN_DEG:
        return math.nan
    return frame.heading_rad(magnetic_bearing_deg)


def place_deg(frame: LocalFrame, x_m: float, y_m: float) -> tuple[float, float] | None:
    """Return latitude and longitude of a position; None if it is too far away, or not a number."""
    try:
        return frame.to_geographic(x_m, y_m)
    except InputError:
        return None


def bearing_deg(frame: LocalFrame, heading_rad: float) -> float:
    """Return the magnetic bearing of a heading, 0 to 360, clockwise; it must be finite."""
    return frame.magnetic_bearing_deg(math.remainder(heading_rad, math.tau))

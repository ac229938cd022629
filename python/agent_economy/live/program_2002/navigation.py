"""How the program of 2002 computed a bearing (Williams 2003, appendix B, class GPS).

All of it is in single precision, as there: one step of the east coordinate is one metre.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

MINUTES_PER_DEG = 60
M_PER_MINUTE = np.float32(1852)
LATITUDE_COSINE = np.float32(math.cos(0.628))
"""The cosine of 35.98 degrees, at every latitude."""

NOT_ZERO = np.float32(0.001)
"""What a difference of zero was replaced by."""


@dataclass(frozen=True)
class Waypoint:
    """A place in degrees and minutes, always north and west.

    The defaults are the waypoint that was built into the program.
    """

    latitude_deg: float = 36
    latitude_min: float = 35.716
    longitude_deg: float = 121
    longitude_min: float = 52.5002

    def set(
        self,
        latitude_deg: float,
        latitude_min: float,
        longitude_deg: float,  # noqa: ARG002  (the fault)
        longitude_min: float,
    ) -> "Waypoint":
        """Return the waypoint after the program's `setWaypoint`.

        It stored the minutes of the longitude as its degrees, and kept the old minutes. Nothing
        called it.
        """
        return replace(
            self,
            latitude_deg=latitude_deg,
            latitude_min=latitude_min,
            longitude_deg=longitude_min,
        )

    @property
    def position_deg(self) -> tuple[float, float]:
        """Its latitude and longitude, north and east positive."""
        latitude_deg = self.latitude_deg + self.latitude_min / MINUTES_PER_DEG
        longitude_deg = self.longitude_deg + self.longitude_min / MINUTES_PER_DEG
        return latitude_deg, -longitude_deg


def as_typed(latitude_deg: float, longitude_deg: float) -> Waypoint:
    """Return a place as an operator of 2002 typed it: in degrees and minutes without a sign."""
    latitude, longitude = (divmod(abs(each), 1) for each in (latitude_deg, longitude_deg))
    return Waypoint(
        latitude[0],
        latitude[1] * MINUTES_PER_DEG,
        longitude[0],
        longitude[1] * MINUTES_PER_DEG,
    )


def bearing_deg(own: Waypoint, waypoint: Waypoint) -> float:
    """Return the bearing of a waypoint from a place; south-west of it the result is wrong.

    There it returned 180 + atan(north / east), which is 450 degrees less the bearing.
    """
    north = _north_m(waypoint) - _north_m(own) or NOT_ZERO
    east = _east_m(waypoint) - _east_m(own) or NOT_ZERO
    if east >= 0 and north >= 0:
        return math.degrees(math.atan(east / north))
    if east >= 0:
        return 90 - math.degrees(math.atan(north / east))
    if north >= 0:
        return 360 + math.degrees(math.atan(east / north))
    return 180 + math.degrees(math.atan(north / east))


def _north_m(at: Waypoint) -> np.float32:
    minutes = np.float32(at.latitude_deg) * np.float32(MINUTES_PER_DEG) + np.float32(
        at.latitude_min
    )
    return np.float32(minutes * M_PER_MINUTE)


def _east_m(at: Waypoint) -> np.float32:
    minutes = np.float32(at.longitude_deg) * np.float32(MINUTES_PER_DEG) + np.float32(
        at.longitude_min
    )
    return np.float32(-minutes * M_PER_MINUTE * LATITUDE_COSINE)

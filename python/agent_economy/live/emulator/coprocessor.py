"""The coprocessor's own turn to a desired heading."""

import math

from agent_economy.live.emulator.lines import FULL_TURN_DEG
from agent_economy.live.emulator.settings import Settings

GAIN_PER_S = 2.0
"""Turn rate per angle that is left."""


class Coprocessor:
    """Turns the robot on the spot until its compass shows the desired heading, and then stops."""

    def __init__(self) -> None:
        """Start without a desired heading."""
        self.desired_deg: float | None = None

    def cancel(self) -> None:
        """End a turn."""
        self.desired_deg = None

    def turn_rate_rad_s(self, raw_deg: float | None, settings: Settings) -> float:
        """Return the turn rate for a compass reading, with its offset; it ends the turn there.

        Without a reading it is 0.
        """
        if self.desired_deg is None or raw_deg is None:
            return 0.0
        is_raw = settings.heading_frame == "raw"
        heading_deg = raw_deg if is_raw else raw_deg - settings.compass_offset_deg
        clockwise_deg = wrapped_deg(self.desired_deg - heading_deg)
        if abs(clockwise_deg) <= settings.turn_tolerance_deg:
            self.cancel()
            return 0.0
        limit = settings.turn_rate_deg_s
        return -math.radians(min(limit, max(-limit, GAIN_PER_S * clockwise_deg)))


def wrapped_deg(angle_deg: float) -> float:
    """Return the same angle from -180 to 180."""
    half = FULL_TURN_DEG / 2
    return (angle_deg + half) % FULL_TURN_DEG - half

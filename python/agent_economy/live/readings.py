"""What a driver reads from the lines of a robot, and what it may be commanded."""

from dataclasses import dataclass
from enum import StrEnum


class Quantity(StrEnum):
    """What an input of a robot measures, and the unit of its values."""

    RANGES = "ranges"
    """Metres, one value per sonar; infinite where nothing is seen, None where no value came."""
    HEADING = "heading"
    """Degrees clockwise from magnetic north, without the mounting offset."""
    POSITION = "position"
    """Latitude and longitude in degrees, north and east positive."""
    BATTERY = "battery"
    """The remaining share of the charge, 0 to 1."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The values of one valid line.

    Attributes:
        quantity: What they measure.
        values: The values, in the unit of the quantity. They may be impossible (NaN, infinite, out
            of range): rules judge that.
    """

    quantity: Quantity
    values: tuple[float | None, ...]


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

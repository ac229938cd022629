"""How the program of 2002 read lines (Williams 2003, appendix B, classes Compass, GPS, Sensors)."""

from dataclasses import dataclass, field

from agent_economy.live.program_2002.navigation import Waypoint

COMPASS_OFFSET_DEG = 10.0
FULL_TURN_DEG = 360.0
POSITION_FIELDS = 5
SONARS = 6


class UncaughtError(Exception):
    """An exception that nothing caught: it ended the control thread, and the robot drove on."""


@dataclass
class Readings:
    """The newest values. Lines of less than two characters left them as they were.

    Attributes:
        heading_deg: Without the mounting error of the compass; up to 365 for a line of 375.
        position: Latitude and longitude, always taken as north and west.
        ranges: In the units of the sonars, feet probably. 0 before the first line.
    """

    heading_deg: float = 0.0
    position: Waypoint = field(default_factory=lambda: Waypoint(0, 0, 0, 0))
    ranges: list[float] = field(default_factory=lambda: [0.0] * SONARS)

    def take(self, port: str, line: str) -> None:
        """Read a line of a port.

        Raises:
            UncaughtError: If the program did not survive it.
        """
        if len(line) <= 1:
            return
        try:
            {"compass": self._compass, "gps": self._gps, "sonar": self._sonar}[port](line)
        except (ValueError, IndexError) as error:
            message = f"the {port} line {line!r} ended the control thread"
            raise UncaughtError(message) from error

    def _compass(self, line: str) -> None:
        try:
            heading_deg = float(line) - COMPASS_OFFSET_DEG
        except ValueError:
            return
        self.heading_deg = heading_deg + FULL_TURN_DEG if heading_deg < 0 else heading_deg

    def _gps(self, line: str) -> None:
        fields = tokens(line)
        values = [float(fields[place]) for place in (0, 1, 3, POSITION_FIELDS - 1)]
        self.position = Waypoint(*values)

    def _sonar(self, line: str) -> None:
        for sonar, value in enumerate(tokens(line)):
            self.ranges[sonar] = float(value)


def tokens(line: str) -> list[str]:
    """Return the fields of a line without the empty ones, as Java's StringTokenizer does."""
    return [part for part in line.split(",") if part]

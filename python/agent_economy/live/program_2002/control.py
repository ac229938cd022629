"""The control loop of 2002 (Williams 2003, appendix B, class Bender), one decision after another.

Every read waited for the next line of a port, for as long as it took. Here the loop is a generator:
it yields the port that it reads, and is sent the line.
"""

from collections.abc import Generator
from enum import Enum

from agent_economy.live.program_2002.inputs import Readings
from agent_economy.live.program_2002.navigation import Waypoint, bearing_deg

NEAR = 3.0
"""A front sonar with less than this is in the way; in the units of the sonars."""

COURSE_ERROR_DEG = 6.3

STOP, FORWARD = "x,3,", "x,2,175,"
LEFT, RIGHT = ("x,0,75,", "x,1,175,"), ("x,1,75,", "x,0,175,")


class Behaviour(Enum):
    """What decided last."""

    CRUISE = "cruise"
    WAYPOINT = "waypoint"
    AVOID = "avoid"


class Motors(Enum):
    """What the program believed of the motors."""

    STOPPED = 0
    FORWARD = 1
    TURNING = 2


Reads = Generator[str, str, None]


class Control:
    """The control thread after its start.

    Attributes:
        readings: What it has read.
        behaviour: The behaviour that decided last.
        bearing_deg: The bearing of its waypoint, as it computed it; None before the first pass.
        difference_deg: The difference of heading and bearing, not wrapped at 360.
        written: The lines that it has written since they were taken, each with its port.
    """

    def __init__(self, waypoint: Waypoint, *, steers: bool = False) -> None:
        """Create it. `steers` is whether it turns to its waypoint: as printed, it never does."""
        self.readings = Readings()
        self.behaviour = Behaviour.CRUISE
        self.bearing_deg: float | None = None
        self.difference_deg = 0.0
        self.written: list[tuple[str, str]] = []
        self._waypoint, self._steers = waypoint, steers
        self._motors = Motors.STOPPED

    def run(self) -> Reads:
        """Yield the ports that it reads, and take their lines.

        Raises:
            UncaughtError: If a line ends the thread.
        """
        yield from self._read("compass")
        while True:
            yield from self._pass()

    def _pass(self) -> Reads:
        yield from self._read("gps")
        yield from self._read("sonar")
        is_near = any(each < NEAR for each in self.readings.ranges[:2])
        yield from self._read("compass")
        yield from self._compute_bearing()
        if is_near:
            yield from self._avoid()
        elif self._steers and self.difference_deg > COURSE_ERROR_DEG:
            yield from self._turn()
        else:
            self._cruise()

    def _compute_bearing(self) -> Generator[str, str, float]:
        """Read a fix and return the bearing from it: in 2002 one function did both."""
        yield from self._read("gps")
        self.bearing_deg = bearing = bearing_deg(self.readings.position, self._waypoint)
        self.difference_deg = abs(self.readings.heading_deg - bearing)
        return bearing

    def _cruise(self) -> None:
        self.behaviour = Behaviour.CRUISE
        if self._motors is not Motors.FORWARD:
            self._write(FORWARD)
            self._motors = Motors.FORWARD

    def _turn(self) -> Reads:
        """Let the coprocessor turn the robot; the line that called this was commented out.

        The heading is that of another fix, not of the one that called for the turn.
        """
        self.behaviour = Behaviour.WAYPOINT
        self._write(STOP)
        desired_deg = yield from self._compute_bearing()
        self.written.append(("compass", f"{desired_deg:.2f}"))
        while self.difference_deg > COURSE_ERROR_DEG:
            yield from self._read("compass")
            self.difference_deg = abs(self.readings.heading_deg - desired_deg)
        self._write(STOP)
        self._motors = Motors.STOPPED

    def _avoid(self) -> Reads:
        """Turn until one of the front sonars is clear: one is enough.

        The side is chosen from another line, not from the one that called for the avoidance.
        """
        self.behaviour = Behaviour.AVOID
        self._write(STOP)
        self._motors = Motors.STOPPED
        yield from self._read("sonar")
        while True:
            ranges = self.readings.ranges
            if self._motors is not Motors.TURNING:
                is_left = ranges[1] < ranges[0] or ranges[4] < ranges[5]
                self._write(*(LEFT if is_left else RIGHT))
                self._motors = Motors.TURNING
            yield from self._read("sonar")
            if any(each > NEAR for each in ranges[:2]):
                return

    def _read(self, port: str) -> Reads:
        line = yield port
        self.readings.take(port, line)

    def _write(self, *lines: str) -> None:
        self.written += [("motors", line) for line in lines]

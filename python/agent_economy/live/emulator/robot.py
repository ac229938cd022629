"""One robot: it obeys lines, moves, and measures what its lines contain."""

from typing import Any

from agent_economy._core import LocalFrame
from agent_economy.live.emulator.coprocessor import Coprocessor
from agent_economy.live.emulator.faults import PORTS, ActiveFaults
from agent_economy.live.emulator.lines import (
    FULL_TURN_DEG,
    STOP,
    compass_fields,
    desired_heading_deg,
    faulty,
    gps_fields,
    motor_command,
    sonar_fields,
)
from agent_economy.live.emulator.settings import Settings
from agent_economy.live.emulator.tracks import Motion, Tracks
from agent_economy.live.emulator.world import Senses

METRES_PER_DEGREE = 60 * 1852.0
"""Length of a degree of latitude: a nautical mile per minute."""


class Robot:
    """The state of one robot besides its body.

    Attributes:
        name: Its name in the world.
        faults: Its active faults, by port.
        tracks: Its tracks.
        senses: What it measured last.
        settings: The settings of the emulator.
    """

    def __init__(
        self, name: str, frame: LocalFrame, max_range_m: tuple[float, ...], settings: Settings
    ) -> None:
        """Create a robot at rest."""
        self.name = name
        self.settings = settings
        self.tracks = Tracks()
        self.coprocessor = Coprocessor()
        self.senses = Senses()
        self.faults = {port: ActiveFaults() for port in PORTS}
        self._frame, self._max_range_m = frame, max_range_m
        self._obeyed_s = 0.0
        self._sent: dict[str, bytes] = {}

    def obey(self, port: str, line: bytes, now_s: float) -> str:
        """Obey a line that a port received, and return the result for the log."""
        if "obey_nothing" in self.faults.get(port, {}):
            return "ignored"
        match port:
            case "motors":
                return self._obey_motor_line(line, now_s)
            case "compass":
                return self._obey_heading(line)
        return "ignored"

    def _obey_motor_line(self, line: bytes, now_s: float) -> str:
        command = motor_command(line)
        if command is None:
            return "malformed"
        if command.channel == STOP and "ignore_stop" in self.faults["motors"]:
            return "ignored"
        self._obeyed_s = now_s
        self.coprocessor.cancel()
        self.tracks.obey(command)
        return "obeyed"

    def _obey_heading(self, line: bytes) -> str:
        heading_deg = desired_heading_deg(line)
        if heading_deg is None:
            return "malformed"
        self.tracks.stop()
        self.coprocessor.desired_deg = heading_deg
        return "obeyed"

    def stops_unattended(self, now_s: float) -> bool:
        """Stop the tracks if no motor line has come for too long; return whether that is so now."""
        limit_s = self.settings.deadman_s
        if limit_s <= 0 or self.tracks.is_neutral or now_s - self._obeyed_s <= limit_s:
            return False
        self.tracks.stop()
        return True

    def motion(self) -> Motion:
        """Return the motion of the next step, before the limits and the errors of the drive."""
        turn_rate = self.coprocessor.turn_rate_rad_s(self.raw_compass_deg(), self.settings)
        if turn_rate != 0:
            return 0.0, turn_rate
        speed, turn_rate = self.tracks.motion(self.settings)
        is_runaway = "runaway" in self.faults["motors"] and self.tracks.is_neutral
        return (self.faults["motors"]["runaway"], 0.0) if is_runaway else (speed, turn_rate)

    def raw_compass_deg(self) -> float | None:
        """Return the heading that the compass shows, with its mounting offset."""
        if self.senses.heading_rad is None:
            return None
        bearing_deg = self._frame.magnetic_bearing_deg(self.senses.heading_rad)
        return (bearing_deg + self.settings.compass_offset_deg) % FULL_TURN_DEG

    def line(self, port: str) -> bytes | None:
        """Return the next line of a port without its end; None if nothing was measured."""
        faults = self.faults[port]
        if "freeze" in faults and port in self._sent:
            return self._sent[port]
        fields = self._fields(port, faults.get("jump", 0.0))
        if fields is None:
            return None
        self._sent[port] = ",".join(faulty(fields, faults)).encode()
        return self._sent[port]

    def _fields(self, port: str, jump: float) -> list[str] | None:
        match port:
            case "compass":
                heading_deg = self.raw_compass_deg()
                return None if heading_deg is None else compass_fields(heading_deg + jump)
            case "gps":
                return self._fix(jump)
            case _:
                return sonar_fields(self._ranges(jump))

    def _fix(self, north_m: float) -> list[str] | None:
        if self.senses.at_m is None:
            return None
        latitude_deg, longitude_deg = self._frame.to_geographic(*self.senses.at_m)
        return gps_fields(
            latitude_deg + north_m / METRES_PER_DEGREE,
            longitude_deg,
            self.settings.gps_digits,
            has_longitude_letter=self.settings.gps_longitude_letter == "sent",
        )

    def _ranges(self, jump_m: float) -> list[float]:
        unit_m, no_echo = self.settings.range_unit_m, self.settings.no_echo
        farthest = [max_range_m / unit_m for max_range_m in self._max_range_m]
        without_echo = farthest if no_echo == "range" else [float(no_echo)] * len(farthest)
        return [
            empty if range_m is None else (range_m + jump_m) / unit_m
            for range_m, empty in zip(self.senses.ranges_m, without_echo, strict=True)
        ]

    def state(self) -> dict[str, Any]:
        """Return its tracks, its desired heading, its latest lines and its active faults."""
        return {
            "motors": {"left": self.tracks.left, "right": self.tracks.right},
            "desired_heading_deg": self.coprocessor.desired_deg,
            "lines": {port: line.decode("ascii") for port, line in self._sent.items()},
            "faults": {port: dict(faults) for port, faults in self.faults.items() if faults},
        }

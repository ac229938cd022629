"""Faults of single robots on the wire: what breaks each, what is reported, and when it stops."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from live_bench import STOP_LINE, Bench, changed_scenario

from agent_economy.live.replay import read_drive

LANE_M = 8.0
"""Distance between two robots: farther than their sonars reach."""


@dataclass(frozen=True)
class WireFault:
    """A fault of one robot.

    Attributes:
        port: The port that is broken.
        fault: The fault of the emulator.
        expected: The fault that the rules report.
        value: The value of the emulator's fault.
        limit_s: The age limit: the stop is timed from there.
        cause: What the limit counts from: the last line sent "before" the fault, the first one
            "after" it, the first motor line "written" after it, or the fault itself, "at once".
        is_link: Whether the stop is timed where the warden writes it, not where the robot reads it.
        is_sensing: Whether it has to be detected from a movement, which takes seconds.
    """

    port: str
    fault: str
    expected: str
    value: Any = None
    limit_s: float = 0.0
    cause: str = "after"
    is_link: bool = False
    is_sensing: bool = False

    @property
    def name(self) -> str:
        """Its name in tables."""
        return f"{self.port} {self.fault}"


def silent(port: str, fault: str, limit_s: float, value: Any = None) -> WireFault:
    """Return a fault after which no more lines arrive, or none that is well formed."""
    return WireFault(port, fault, "stale_input", value, limit_s, cause="before")


FAULTS = (
    silent("sonar", "stall", 0.5),
    silent("compass", "stall", 1.0),
    silent("gps", "stall", 3.0),
    silent("sonar", "drop", 0.5, 1.0),
    silent("compass", "half", 1.0),
    silent("gps", "delay", 3.0, 60.0),
    silent("sonar", "garble", 0.5, 1.0),
    silent("sonar", "seven", 0.5),
    silent("gps", "short", 3.0, 3),
    WireFault("sonar", "close", "lost_link", cause="at once"),
    WireFault("compass", "close", "lost_link", cause="at once"),
    WireFault("gps", "close", "lost_link", cause="at once"),
    WireFault("motors", "close", "lost_link", cause="at once"),
    WireFault("motors", "cut", "lost_link", limit_s=0.3, cause="written", is_link=True),
    WireFault("compass", "nan", "impossible_value"),
    WireFault("gps", "nan", "impossible_value"),
    WireFault("compass", "jump", "jump", 90.0),
    WireFault("gps", "jump", "jump", 50.0),
    WireFault("gps", "freeze", "frozen", cause="at once", is_sensing=True),
)
"""One per robot."""


def lanes(folder: Path, robots: int) -> Path:
    """Write a scenario in which robots drive straight on, each in a lane of its own."""
    starts = [[5, 5 + LANE_M * robot] for robot in range(robots)]
    changes = {
        "size_m": f"size_m = [1000, {10 + LANE_M * robots:g}]",
        "obstacles": "",
        "count": f"count = {robots}",
        "start": f'start = {{ kind = "fixed", at_m = {starts}, heading_deg = {[0] * robots} }}',
        '{ kind = "correct"': "",
        '{ kind = "avoid"': "",
    }
    return changed_scenario(folder / "lanes.toml", changes)


def inject(bench: Bench, faults: Sequence[WireFault]) -> None:
    """Break each robot in its way."""
    for robot, fault in enumerate(faults):
        bench.fault(robot, fault.port, fault.fault, fault.value)


@dataclass(frozen=True)
class Evidence:
    """What was sent, received and written in a drive that has ended.

    Attributes:
        rows: The log of the emulator.
        written: The time and text of each motor line that the warden wrote, by robot.
    """

    rows: Sequence[dict[str, Any]]
    written: dict[str, list[tuple[float, str]]]

    @classmethod
    def of(cls, bench: Bench, record: Path) -> "Evidence":
        """Read the log of an emulator and the recording of a drive."""
        drive = read_drive(record)
        assert drive is not None
        written: dict[str, list[tuple[float, str]]] = {}
        for topic, message in drive.messages:
            if topic.endswith("/motors") and message["type"] == "written":
                line = (message["t"], message["line"].strip())
                written.setdefault(message["robot"], []).append(line)
        return cls(bench.rows(), written)

    def limit_s(self, robot: int, fault: WireFault) -> float:
        """Return the time from which on a fault can be detected."""
        return self._cause_s(robot, fault) + fault.limit_s

    def stop_delay_s(self, robot: int, fault: WireFault) -> float:
        """Return the time from there to the stop after the last motion line."""
        lines = self._motor_lines(robot, fault)
        moved_s = max(time_s for time_s, line in lines if line != STOP_LINE)
        stops = [time_s for time_s, line in lines if line == STOP_LINE and time_s >= moved_s]
        assert stops, f"{fault.name}: no stop"
        return stops[0] - self.limit_s(robot, fault)

    def _cause_s(self, robot: int, fault: WireFault) -> float:
        at_s = self._times_s(robot, fault, "fault")[0]
        sent = self._times_s(robot, fault, "sent")
        match fault.cause:
            case "before":
                return max(time_s for time_s in sent if time_s < at_s)
            case "after":
                return min(time_s for time_s in sent if time_s >= at_s)
            case "written":
                lines = self.written[f"bender/{robot}"]
                return min(time_s for time_s, _ in lines if time_s >= at_s)
        return at_s

    def _times_s(self, robot: int, fault: WireFault, event: str) -> list[float]:
        return [
            row["t_s"]
            for row in self.rows
            if (row["robot"], row["port"], row["event"]) == (robot, fault.port, event)
        ]

    def _motor_lines(self, robot: int, fault: WireFault) -> list[tuple[float, str]]:
        if fault.is_link:
            return self.written[f"bender/{robot}"]
        return [
            (row["t_s"], row["line"])
            for row in self.rows
            if (row["robot"], row["port"], row["event"]) == (robot, "motors", "received")
        ]

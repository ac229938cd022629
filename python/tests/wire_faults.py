"""Some faults of single robots on the wire, and when each stops: a short form of the campaign."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from campaign_table import ROWS, Finding, State, WireRow
from live_bench import STOP_LINE, Bench, changed_scenario

from agent_economy.live.replay import read_drive

LANE_M = 8.0
"""Distance between two robots: farther than their sonars reach."""


CHOSEN = (
    "sonar stall",
    "compass stall",
    "gps stall",
    "sonar drop 1",
    "compass half",
    "gps delay 60",
    "sonar garble",
    "sonar seven",
    "gps short 3",
    "sonar close",
    "compass close",
    "gps close",
    "motors close",
    "motors cut",
    "compass nan",
    "gps nan",
    "compass jump 90",
    "gps jump 50",
    "gps freeze",
)

FAULTS = tuple(each for each in ROWS if f"{each.port} {each.name}" in CHOSEN)
"""Faults of the campaign that stop a robot that drives straight on: one per robot."""


def finding_of(fault: WireRow) -> Finding:
    """Return what has to be found."""
    finding = fault.finding(State.STRAIGHT)
    assert finding is not None
    return finding


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


def inject(bench: Bench, faults: Sequence[WireRow]) -> None:
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

    def limit_s(self, robot: int, fault: WireRow) -> float:
        """Return the time from which on a fault can be detected."""
        return self._cause_s(robot, fault) + finding_of(fault).detect_s

    def stop_delay_s(self, robot: int, fault: WireRow) -> float:
        """Return the time from there to the stop after the last motion line."""
        lines = self._motor_lines(robot, fault)
        moved_s = max(time_s for time_s, line in lines if line != STOP_LINE)
        stops = [time_s for time_s, line in lines if line == STOP_LINE and time_s >= moved_s]
        assert stops, f"{fault.name}: no stop"
        return stops[0] - self.limit_s(robot, fault)

    def _cause_s(self, robot: int, fault: WireRow) -> float:
        at_s = self._times_s(robot, fault, "fault")[0]
        sent = self._times_s(robot, fault, "sent")
        match finding_of(fault).cause:
            case "before":
                return max(time_s for time_s in sent if time_s < at_s)
            case "after":
                return min(time_s for time_s in sent if time_s >= at_s)
            case "written":
                lines = self.written[f"bender/{robot}"]
                return min(time_s for time_s, _ in lines if time_s >= at_s)
        return at_s

    def _times_s(self, robot: int, fault: WireRow, event: str) -> list[float]:
        return [
            row["t_s"]
            for row in self.rows
            if (row["robot"], row["port"], row["event"]) == (robot, fault.port, event)
        ]

    def _motor_lines(self, robot: int, fault: WireRow) -> list[tuple[float, str]]:
        if fault.is_link:
            return self.written[f"bender/{robot}"]
        return [
            (row["t_s"], row["line"])
            for row in self.rows
            if (row["robot"], row["port"], row["event"]) == (robot, "motors", "received")
        ]

"""Emulated robots that are driven, in one of the states of the campaign."""

import json
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Any

from campaign_table import State
from hands import Hands
from live_bench import STOP_LINE, Bench, Drive, changed_scenario, driving, emulated, fleet_text
from priority import STARTING, raise_priority

from agent_economy.live.clock import now_s

LANE_M = 8.0
"""Distance between two robots: farther than their sonars reach."""

CELL_M = 4.0
"""The length of a cell in which a robot finds no free way."""

SETTLED_S = 3.0
"""Time in a state before the faults: robots drive steadily, or have settled after their stop."""

START_S = 40.0
"""The longest time until a state is reached."""

FULL_VALUE, SLOW_VALUE = 175, 160
"""Values of the tracks: driving by hand, and the highest one at the limit of the speed."""

SLOW_M_S = 0.2
PROGRAM = (sys.executable, str(Path(__file__).with_name("drive_without_page.py")))


def name_of(robot: int) -> str:
    """Return the name of a robot."""
    return f"bender/{robot}"


def lanes(folder: Path, robots: int, *, is_turning: bool) -> Path:
    """Write a scenario of robots, each in a lane of its own or turning in a cell."""
    middles = [5 + LANE_M * robot for robot in range(robots)]
    if is_turning:
        walls = [wall for y_m in middles for wall in cell(5.0, y_m)]
        avoid = '{ kind = "avoid", near_m = 3, clearance_hysteresis_m = 1, sector_deg = 360 },'
    else:
        edges = [middles[0] - LANE_M / 2, *(y_m + LANE_M / 2 for y_m in middles)]
        walls = [box(0.1, y_m - 0.1, 999.9, y_m + 0.1) for y_m in edges]
        avoid = ""
    starts = [[5, y_m] for y_m in middles]
    changes = {
        "size_m": f"size_m = [1000, {10 + LANE_M * robots:g}]",
        "obstacles": f"obstacles = [{', '.join(walls)}]",
        "count": f"count = {robots}",
        "start": f'start = {{ kind = "fixed", at_m = {starts}, heading_deg = {[0] * robots} }}',
        '{ kind = "correct"': "",
        '{ kind = "avoid"': avoid,
    }
    return changed_scenario(folder / "campaign.toml", changes)


def box(left_m: float, low_m: float, right_m: float, high_m: float) -> str:
    """Return an obstacle."""
    corners = [[left_m, low_m], [right_m, low_m], [right_m, high_m], [left_m, high_m]]
    return f"{{ polygon_m = {corners} }}"


def cell(x_m: float, y_m: float) -> Iterator[str]:
    """Yield the walls of a cell."""
    reach_m = CELL_M / 2
    for side in (-1, 1):
        yield box(
            x_m - reach_m, y_m + side * reach_m - 0.1, x_m + reach_m, y_m + side * reach_m + 0.1
        )
        low_m, high_m = y_m - reach_m + 0.2, y_m + reach_m - 0.2
        yield box(x_m + side * reach_m - 0.1, low_m, x_m + side * reach_m + 0.1, high_m)


@dataclass
class Scene:
    """Robots in a state.

    Attributes:
        state: The state; the last robots may be in automatic mode all the same.
        robots: The number of robots.
        by_hand: The robots that are driven by hand.
        bench: The emulated robots.
        drive: The drive.
        hands: Drives them by hand.
        loop_pid: The process of the loop.
    """

    state: State
    robots: int
    by_hand: Sequence[int]
    bench: Bench
    drive: Drive
    hands: Hands
    loop_pid: int = 0
    _rows: list[dict[str, Any]] = field(default_factory=list)

    def reach(self) -> None:
        """Bring the robots into the state."""
        self._until(self._is_ready)
        self.loop_pid = self.drive.loop_pid()
        for pid in (self.bench.process.pid, self.drive.process.pid, self.loop_pid):
            raise_priority(pid)
        if self.by_hand:
            self.hands.take([name_of(robot) for robot in self.by_hand])
        self._until(self._can_be_armed)
        if self.state is State.UNARMED:
            time.sleep(SETTLED_S)
            return
        self._until(self._arms)
        if self.by_hand:
            self._until(self._is_armed)
            self.hands.drive(FULL_VALUE)
        self._until(self._moves)
        if self.state is State.HELD:
            self.ask("/hold")
        elif self.state is State.STOPPED:
            self.ask("/stop")
        time.sleep(SETTLED_S)

    def ask(self, path: str, **body: Any) -> dict[str, Any]:
        """Send a request that must be accepted; return the answer."""
        status, answer = self.drive.ask(path, client=self.hands.client, **body)
        assert status == HTTPStatus.OK, (path, answer)
        return answer

    def refuses_to_arm(self, robot: int) -> bool:
        """Return whether a robot cannot be armed now."""
        body = {"client": self.hands.client, "robots": [name_of(robot)]}
        return self.drive.ask("/arm", **body)[0] != 200

    def events(self, robot: int, after_s: float) -> list[dict[str, Any]]:
        """Return what the rules have reported of a robot after a time."""
        return [
            each
            for each in list(self.drive.events)
            if each["type"] == "event" and each["robot"] == name_of(robot) and each["t"] >= after_s
        ]

    def found_s(self, robot: int, names: Sequence[str], after_s: float) -> float | None:
        """Return when the rules reported one of some faults after a time; None if not."""
        for event in self.events(robot, after_s):
            if set(names) & {*event["faults"], *event["warnings"]}:
                return float(event["t"])
        return None

    def end(self) -> None:
        """End all processes, and read the log of the emulator."""
        self.hands.close()
        for pid in (self.loop_pid, self.drive.process.pid):
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.drive.process.wait(timeout=10)
        self._rows = self.bench.rows()

    def wire(self, robot: int, port: str, event: str, **facts: str) -> list[tuple[float, str]]:
        """Return the times and lines of an event of a port in the log; after the end."""
        key = {"robot": robot, "port": port, "event": event, **facts}
        rows = (row for row in self._rows if key.items() <= row.items())
        return [(row["t_s"], row.get("line", "")) for row in rows]

    def behind_s(self, begin_s: float, end_s: float) -> float:
        """Return by how much the emulator was late in a time; after the end."""
        rows = (row for row in self._rows if row["event"] == "behind")
        return sum(float(row["skipped_s"]) for row in rows if begin_s <= row["t_s"] <= end_s)

    def moves(self, robot: int, after_s: float) -> list[float]:
        """Return the times of motion lines that a robot received after a time."""
        lines = self.wire(robot, "motors", "received", result="obeyed")
        return [at_s for at_s, line in lines if at_s >= after_s and line != STOP_LINE]

    def stops(self, robot: int, after_s: float) -> list[float]:
        """Return the times of stop lines that a robot received after a time."""
        lines = self.wire(robot, "motors", "received", result="obeyed")
        return [at_s for at_s, line in lines if at_s >= after_s and line == STOP_LINE]

    def _robots(self) -> list[dict[str, Any]]:
        answer = self.ask("/state")
        return list(answer["robots"])

    def _is_ready(self) -> bool:
        if self.drive.process.poll() is not None:
            message = f"the drive has ended: {self.drive.events[-3:]}"
            raise AssertionError(message)
        with suppress(StopIteration, OSError, json.JSONDecodeError):
            return len(self._robots()) == self.robots
        return False

    def _can_be_armed(self) -> bool:
        return not any(each["blockers"] or each["warnings"] for each in self._robots())

    def _arms(self) -> bool:
        return self.drive.ask("/arm", client=self.hands.client)[0] == HTTPStatus.OK

    def _is_armed(self) -> bool:
        return all(each["is_armed"] for each in self._robots())

    def _moves(self) -> bool:
        return all(each["action"] == "move" for each in self._robots())

    def _until(self, holds: Callable[[], bool]) -> None:
        deadline_s = now_s() + START_S
        while not holds():
            assert now_s() < deadline_s, f"{holds.__name__}: {self._blockers()}"
            time.sleep(0.2)

    def _blockers(self) -> list[Any]:
        with suppress(AssertionError, StopIteration, OSError):
            return [each["blockers"] or each["latched"] for each in self._robots()]
        return []


@contextmanager
def scene(folder: Path, state: State, robots: int, by_hand: Sequence[int] = ()) -> Iterator[Scene]:
    """Run emulated robots and their drive in a state."""
    scenario = lanes(folder, robots, is_turning=state is State.TURNING)
    fleet = folder / "fleet.toml"
    with emulated(folder, robots, arguments=("--scenario", str(scenario))) as bench:
        keys = {name_of(robot): f"manual_speed_m_s = {SLOW_M_S}" for robot in range(robots)}
        text = fleet_text(bench, scenario=str(scenario), keys=keys)
        fleet.write_text(text, encoding="utf-8")
        with driving(fleet, headless=False, program=PROGRAM) as drive:
            for process in (bench.process, drive.process):
                raise_priority(process.pid, STARTING)
            made = Scene(state, robots, by_hand, bench, drive, Hands(drive))
            try:
                made.reach()
                yield made
            finally:
                made.hands.close()

"""A flooding robot as a process, beside an emulated one: how soon both stop in a flood."""

import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from flooding_robot import flood
from live_bench import PORTS, SETTINGS, STOP_LINE, Bench, driving, emulated, fleet_text
from wire_faults import lanes

from agent_economy.live.clock import now_s


class Flooding:
    """A flooding robot, as a process.

    Attributes:
        ports: The number of each of its ports.
        rows: The motor lines that it has received.
    """

    def __init__(self, process: subprocess.Popen[str]) -> None:
        """Read what it prints."""
        assert process.stdout is not None
        self._process, self._stream = process, process.stdout
        self.ports: dict[str, int] = json.loads(self._stream.readline())
        self.rows: list[dict[str, Any]] = []
        threading.Thread(target=self._read, daemon=True).start()

    def send(self, name: str) -> None:
        """Let it send a flood."""
        assert self._process.stdin is not None
        self._process.stdin.write(name + "\n")
        self._process.stdin.flush()

    def stops_after(self, time_s: float) -> list[float]:
        """Return the times of stop lines after a time."""
        rows = list(self.rows)
        return [row["t_s"] for row in rows if row["t_s"] >= time_s and row["line"] == STOP_LINE]

    def _read(self) -> None:
        for line in self._stream:
            self.rows.append(json.loads(line))


@contextmanager
def flooding() -> Iterator[Flooding]:
    """Run a flooding robot."""
    command = [sys.executable, str(Path(__file__).with_name("flooding_robot.py"))]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        yield Flooding(process)
    finally:
        process.kill()
        process.wait(timeout=10)


def fleet_with(bench: Bench, robot: Flooding, scenario: Path) -> str:
    """Return a fleet of an emulated robot and a flooding one."""
    ports = ", ".join(f"{port} = {robot.ports[port]}" for port in PORTS)
    settings = "\n".join(f"{key} = {value}" for key, value in SETTINGS.items())
    return (
        fleet_text(bench, scenario=str(scenario))
        + f'[robots."bender/1"]\ndriver = "bender"\nhost = "127.0.0.1"\nports = {{ {ports} }}\n'
        + f'[robots."bender/1".settings]\n{settings}\n'
    )


def first_after(stops: Callable[[], list[float]]) -> float:
    """Return the time of the first stop; waits for it."""
    deadline_s = now_s() + 5
    while not (found := stops()):
        assert now_s() < deadline_s
        time.sleep(0.01)
    return found[0]


def stops_in_a_flood(name: str, folder: Path) -> list[float]:
    """Return how long the stop of a healthy and of a flooding robot takes in a flood."""
    assert flood(name, "gps")
    scenario, fleet = lanes(folder, 2), folder / "fleet.toml"
    arguments = ("--scenario", str(scenario))
    with flooding() as robot, emulated(folder, 1, arguments=arguments) as bench:
        fleet.write_text(fleet_with(bench, robot, scenario), encoding="utf-8")
        with driving(fleet) as drive:
            drive.wait_until_moving("bender/0")
            bench.wait_for_motion(1)
            robot.send(name)
            time.sleep(2.0)
            assert bench.moves_after(0, now_s() - 1), "the healthy robot has to drive on"
            before_s = now_s()
            drive.post("/stop")
            stops = (lambda: bench.stops_after(0, before_s), lambda: robot.stops_after(before_s))
            return [first_after(each) - before_s for each in stops]

"""An emulated fleet and a drive, as processes: for tests that need the wire."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

from command_line import COMMAND

from agent_economy.live.clock import now_s
from agent_economy.live.discovery.running_drive import RunningDrive

STOP_LINE = "x,3,"
PORTS = ("motors", "compass", "gps", "sonar")
SETTINGS = {"range_unit_m": 1.0, "no_echo": 99.0}
"""Settings of the emulator; fleet files get the same."""

IDEAL: dict[str, Any] = {"lag_s": 0, "delay_s": 0, "gain_left_right": 1, "gps_drift_m": 0}
"""Settings of an emulated robot without errors: these tests judge the warden and the loop."""

INEXACT: dict[str, Any] = {
    "lag_s": 0.25,
    "delay_s": 0.05,
    "gain_left_right": 1.03,
    "gps_drift_m": 0.2,
}
"""The errors that an emulated robot has by default: these tests judge the brain, too."""

BENDER = Path(__file__).resolve().parents[2] / "scenarios" / "bender.toml"


def changed_scenario(path: Path, changes: Mapping[str, str], bundled: Path = BENDER) -> Path:
    """Write a scenario, by default bender, with other lines, by what the lines begin with."""
    lines = [
        next((text for key, text in changes.items() if line.strip().startswith(key)), line)
        for line in bundled.read_text(encoding="utf-8").splitlines()
    ]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@dataclass
class Bench:
    """Emulated robots, by their ports and their log.

    Attributes:
        robots: The ports of each robot.
        control: The control port.
        log: The log of the emulator.
    """

    robots: list[dict[str, Any]]
    control: int
    log: Path
    process: subprocess.Popen[str]

    def request(self, **request: Any) -> dict[str, Any]:
        """Send a request to the control port."""
        with socket.create_connection(("127.0.0.1", self.control), timeout=10) as link:
            link.sendall(json.dumps(request).encode() + b"\n")
            reply = json.loads(link.makefile().readline())
        assert reply["ok"], reply
        return dict(reply)

    def fault(
        self, robot: int, port: str, name: str, value: Any = None, *, on: bool = True
    ) -> float:
        """Switch a fault on or off; return the time just before."""
        before_s = now_s()
        self.request(robot=robot, port=port, fault=name, value=value, on=on)
        return before_s

    def rows(self) -> list[dict[str, Any]]:
        """Return the entries of the log."""
        lines = self.log.read_text(encoding="utf-8").splitlines(keepends=True)
        return [json.loads(line) for line in lines if line.endswith("\n")]

    def lines(self, robot: int, port: str = "motors") -> list[dict[str, Any]]:
        """Return the entries of the log that are lines received on a port."""
        return [
            row
            for row in self.rows()
            if (row["robot"], row["port"], row["event"]) == (robot, port, "received")
        ]

    def wait_for_motion(self, robots: int) -> None:
        """Wait until each robot has received a motion line."""
        deadline_s = time.monotonic() + 10
        while not all(self.moves_after(robot, 0.0) for robot in range(robots)):
            assert time.monotonic() < deadline_s
            time.sleep(0.1)

    def stops_after(self, robot: int, time_s: float) -> list[float]:
        """Return the times of stop lines received after a time."""
        lines = self.lines(robot)
        return [row["t_s"] for row in lines if row["t_s"] >= time_s and row["line"] == STOP_LINE]

    def moves_after(self, robot: int, time_s: float) -> list[float]:
        """Return the times of other motor lines received after a time."""
        lines = self.lines(robot)
        return [row["t_s"] for row in lines if row["t_s"] >= time_s and row["line"] != STOP_LINE]


@contextmanager
def emulated(
    folder: Path, robots: int = 1, *, arguments: tuple[str, ...] = (), **settings: Any
) -> Iterator[Bench]:
    """Run the emulator, on free ports; its robots are ideal but for the settings."""
    log = folder / "emulator.log"
    command = [sys.executable, "-m", "agent_economy", "bender-emulator", "--ports", "0,0,0,0"]
    command += ["--robots", str(robots), "--log", str(log), *arguments]
    for name, value in {**SETTINGS, **IDEAL, **settings}.items():
        command += ["--set", f"{name}={value}"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        ready = json.loads(process.stdout.readline())
        yield Bench(ready["robots"], ready["control"], log, process)
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(timeout=10)


def fleet_text(
    bench: Bench,
    *,
    scenario: str = "bender",
    keys: Mapping[str, str] | None = None,
    robots: Collection[int] | None = None,
    **settings: Any,
) -> str:
    """Return a fleet file for emulated robots: all, or some; `keys` has further lines, by robot."""
    keys = keys or {}
    parts = [f'scenario = "{scenario}"']
    for number, robot in enumerate(bench.robots):
        if robots is not None and number not in robots:
            continue
        ports = ", ".join(f"{port} = {robot[port]}" for port in PORTS)
        parts.append(f'[robots."{robot["name"]}"]\ndriver = "bender"\nhost = "127.0.0.1"')
        parts.append(f"ports = {{ {ports} }}\n{keys.get(robot['name'], '')}")
        parts.append(f'[robots."{robot["name"]}".settings]')
        parts += [f"{key} = {json.dumps(each)}" for key, each in {**SETTINGS, **settings}.items()]
    return "\n".join(parts) + "\n"


@dataclass
class Drive:
    """A running drive.

    Attributes:
        process: The warden.
        record: The recording.
        environment: Its environment, with the folder in which drives are listed.
        events: What it has printed so far.
    """

    process: subprocess.Popen[str]
    record: Path
    environment: Mapping[str, str]
    events: list[dict[str, Any]] = field(default_factory=list)
    _changed: threading.Condition = field(default_factory=threading.Condition)

    def read(self) -> None:
        """Collect the events, in a thread of its own."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._changed:
                self.events.append(json.loads(line))
                self._changed.notify_all()

    def wait_for(
        self, holds: Callable[[dict[str, Any]], bool], timeout_s: float = 30
    ) -> dict[str, Any]:
        """Return the first event for which something holds; waits for it."""
        deadline_s = time.monotonic() + timeout_s
        seen = 0
        with self._changed:
            while True:
                for event in self.events[seen:]:
                    if holds(event):
                        return event
                seen = len(self.events)
                left_s = deadline_s - time.monotonic()
                has_ended = self.process.poll() is not None and not self._changed.wait(1)
                assert not has_ended, f"the drive has ended; events: {self.events[-5:]}"
                assert left_s > 0, f"not within {timeout_s} s; events: {self.events[-5:]}"
                self._changed.wait(min(left_s, 0.5))

    def wait_until_moving(self, robot: str = "bender/0") -> None:
        """Wait until the rules let a robot move."""
        self.wait_for(lambda each: each.get("action") == "move" and each["robot"] == robot)

    def wait_for_fault(self, robot: str, fault: str) -> dict[str, Any]:
        """Return the first event with a fault of a robot; waits for it."""
        return self.wait_for(
            lambda each: each.get("robot") == robot and fault in each.get("faults", ())
        )

    def wait_until_latched(self, robots: Collection[str]) -> None:
        """Wait until robots have to be armed again."""
        moved, latched = set(), set()

        def is_last(event: dict[str, Any]) -> bool:
            if event.get("action") == "move":
                moved.add(event["robot"])
            if event.get("action") == "latched_stop":
                latched.update({event["robot"]} & moved)
            return latched >= set(robots)

        self.wait_for(is_last)

    def post(self, path: str) -> None:
        """Send a request to the endpoint of the drive."""
        accepted, answer = self.running().request(path)
        assert accepted, answer

    def running(self) -> RunningDrive:
        """Return its entry in the list of drives."""
        file = next(Path(self.environment["XDG_RUNTIME_DIR"]).rglob(f"{self.process.pid}.json"))
        return RunningDrive(**json.loads(file.read_text()))

    def ask(self, path: str, **body: Any) -> tuple[int, dict[str, Any]]:
        """Send a request with a body to its endpoint; return the status and the answer."""
        entry = self.running()
        link = HTTPConnection(entry.host, entry.port, timeout=5)
        link.request("POST", path, json.dumps({"token": entry.token, **body}))
        response = link.getresponse()
        answer = json.loads(response.read())
        link.close()
        return response.status, answer

    def stop(self) -> float:
        """Stop its robots by the command; return the time just before.

        Only its own: without the process, the command stops every drive of the user.
        """
        before_s = now_s()
        command = [*COMMAND, "stop", "--process", str(self.process.pid)]
        subprocess.run(command, check=True, env=self.environment, stdout=subprocess.DEVNULL)
        return before_s

    def wait(self, timeout_s: float = 60) -> int:
        """Return the exit code."""
        return self.process.wait(timeout=timeout_s)

    def loop_pid(self) -> int:
        """Return the process of the loop."""
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")
        return int(children.read_text().split()[0])


@contextmanager
def driving(
    fleet: Path, *arguments: str, headless: bool = True, program: Sequence[str] = COMMAND
) -> Iterator[Drive]:
    """Run a drive, and end it if it still runs; its recording has a name that is free."""
    names = (fleet.with_name(f"{fleet.stem}{suffix}.mcap") for suffix in ("", *range(2, 100)))
    record = next(name for name in names if not name.exists())
    command = [*program, "drive", str(fleet), "--json"]
    command += ["--record", str(record), *(("--headless", "--arm") if headless else ()), *arguments]
    environment = os.environ | {"XDG_RUNTIME_DIR": str(fleet.parent)}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    drive = Drive(process, record, environment)
    reader = threading.Thread(target=drive.read, daemon=True)
    reader.start()
    try:
        yield drive
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGCONT)
            end(process)
        process.wait(timeout=10)
        reader.join(timeout=10)


def end(process: subprocess.Popen[str]) -> None:
    """End a drive soon, as two Ctrl-C do; killed, its loop would hold the locks for seconds."""
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.1)
    try:
        process.wait(timeout=8)
    except subprocess.TimeoutExpired:
        process.kill()

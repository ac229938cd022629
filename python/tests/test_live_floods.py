"""Whatever robots send, the work of the warden is bounded, and no robot delays another's stop."""

import asyncio
import itertools
import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from flooding_robot import FLOODS, flood
from live_bench import PORTS, SETTINGS, STOP_LINE, Bench, driving, emulated, fleet_text
from wire_faults import lanes

from agent_economy.live.clock import now_s
from agent_economy.live.drivers import DRIVERS, Driver, LineSplitter
from agent_economy.live.drivers.lines import MAX_LINE_BYTES
from agent_economy.live.warden.connection import MAX_BYTES, MAX_TURN_LINES, Connection, Share

MAX_DELAY_S = 0.1
"""A robot is stopped within this time of the request."""

PATTERNS = (b"1", b"1.", b"1e", b" ", b"-", b"1,", b",", b"36,35.7,N,121,52.5,W,", b"\xff", b".1")
ENDS = (b"", b"x", b"\0", b"e", b",x")


def seconds_per_line(driver: Driver, port: str, line: bytes) -> float:
    """Return the time of one line: the fastest of some, which is what the machine needs."""
    settings = {key: each.default for key, each in driver.settings.items()}
    times = []
    for _ in range(15):
        began_s = time.process_time_ns()
        for _ in range(4):
            driver.reading(port, line, settings)
        times.append((time.process_time_ns() - began_s) / 4e9)
    return min(times)


@pytest.mark.parametrize("driver", DRIVERS.values(), ids=list(DRIVERS))
@pytest.mark.parametrize("pattern", PATTERNS)
def test_the_time_of_a_line_is_linear_in_its_length(driver: Driver, pattern: bytes) -> None:
    for port in (each.name for each in driver.ports if each.quantity is not None):
        for end in ENDS:
            short, long = (pattern * (size // len(pattern)) + end for size in (100, 10_000))
            shortest_s = max(seconds_per_line(driver, port, short), 1e-6)
            assert seconds_per_line(driver, port, long) < 300 * shortest_s, (port, pattern, end)


@pytest.mark.parametrize("driver", DRIVERS.values(), ids=list(DRIVERS))
def test_a_line_that_is_too_long_is_malformed_for_every_driver(driver: Driver) -> None:
    settings = {key: each.default for key, each in driver.settings.items()}
    for port in (each.name for each in driver.ports if each.quantity is not None):
        good = {"gps": b"36,35.7,N,121,52.5,W,", "sonar": b"1,2,3,4,5,6"}.get(port, b"12.5")
        assert driver.parse(port, good, settings) is not None
        assert driver.parse(port, good + b" " * MAX_LINE_BYTES, settings) is None
        assert driver.parse(port, b"0" * 41, settings) is None


def test_of_a_flood_of_lines_only_the_newest_are_taken() -> None:
    splitter = LineSplitter(max_lines=5)
    assert splitter.feed(b"".join(b"%d\n" % number for number in range(100_000))) == [
        b"%d" % number for number in range(99_995, 100_000)
    ]


@pytest.mark.parametrize(
    ("ports", "read", "lines"), [(4, 16_384, 20), (20, 13_107, 10), (40, 6553, 5), (400, 1024, 1)]
)
def test_the_ports_of_all_robots_share_the_lines_of_a_turn(
    ports: int, read: int, lines: int
) -> None:
    assert Share.of(ports) == Share(read, lines)
    assert ports * lines <= max(MAX_TURN_LINES, ports)


def test_a_port_is_read_once_per_turn_and_gives_no_line_while_others_wait_behind_it() -> None:
    async def receive() -> tuple[list[bytes], list[int]]:
        lines: list[bytes] = []
        counts: list[int] = []

        async def serve(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            writer.write(b"old\n" * MAX_BYTES + b"newer\nnewest\n")
            await writer.drain()

        server = await asyncio.start_server(serve, "127.0.0.1", 0)
        host, port = server.sockets[0].getsockname()[:2]
        connection = Connection(lines.append, Share())
        await asyncio.get_running_loop().create_connection(lambda: connection, host, port)
        deadline_s = now_s() + 10
        while b"newest" not in lines and now_s() < deadline_s:
            await asyncio.sleep(0.02)
            counts.append(len(lines))
            connection.resume()
        connection.abort()
        server.close()
        return lines, counts

    lines, counts = asyncio.run(receive())
    assert lines[-1] == b"newest"
    assert len(lines) <= 20
    assert len(counts) >= 4


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


@pytest.mark.parametrize("name", FLOODS)
def test_a_flood_on_all_ports_of_a_robot_delays_no_stop(name: str, tmp_path: Path) -> None:
    delays_s = repeated_if_late(stops_in_a_flood)(name, tmp_path)
    assert max(delays_s) < MAX_DELAY_S, delays_s


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


FLOOD_OF_REQUESTS = """
import socket, sys, threading
port, body = int(sys.argv[1]), b"[" + b"1," * 6000 + b"1]"
head = b"POST /arm HTTP/1.1\\r\\nContent-Length: %d\\r\\n\\r\\n" % len(body)
def flood():
    while True:
        try:
            with socket.create_connection(("127.0.0.1", port)) as link:
                while True:
                    link.sendall((head + body) * 20)
                    link.settimeout(0.05)
                    try:
                        link.recv(65536)
                    except TimeoutError:
                        pass
        except OSError:
            pass
for _ in range(40):
    threading.Thread(target=flood, daemon=True).start()
threading.Event().wait()
"""


@repeated_if_late
def test_a_flood_of_requests_without_a_token_delays_no_turn_of_the_warden(tmp_path: Path) -> None:
    scenario, fleet = lanes(tmp_path, 1), tmp_path / "fleet.toml"
    with emulated(tmp_path, 1, arguments=("--scenario", str(scenario))) as bench:
        fleet.write_text(fleet_text(bench, scenario=str(scenario)), encoding="utf-8")
        with driving(fleet) as drive:
            drive.wait_until_moving("bender/0")
            command = [sys.executable, "-c", FLOOD_OF_REQUESTS, str(drive.running().port)]
            flooding_program = subprocess.Popen(command)
            try:
                time.sleep(3.0)
                flooded_s = now_s()
            finally:
                flooding_program.kill()
                flooding_program.wait(timeout=10)
            # Whether it moves or stands, a motor line is due every 0.2 s.
            times = [row["t_s"] for row in bench.lines(0) if flooded_s - 2 < row["t_s"] < flooded_s]
            assert max(after - before for before, after in itertools.pairwise(times)) < 0.5
            drive.post("/stop")
            assert not any("event_loop_gap" in each.get("faults", ()) for each in drive.events)

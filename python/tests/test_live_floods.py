"""Whatever robots send, the work of the warden is bounded, and no robot delays another's stop."""

import asyncio
import itertools
import subprocess
import sys
import time
from pathlib import Path

import pytest
from bare_timer import repeated_if_late
from flooding_robot import FLOODS
from floods import stops_in_a_flood
from live_bench import driving, emulated, fleet_text
from wire_faults import lanes

from agent_economy.live.clock import now_s
from agent_economy.live.drivers import DRIVERS, Driver, LineSplitter
from agent_economy.live.drivers.lines import MAX_LINE_BYTES
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin
from agent_economy.live.warden.connection import MAX_BYTES, MAX_TURN_LINES, Connection, Share

FRAME = frame_of(Origin(36.6, -121.9))

LIMIT_S = 0.1
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
            driver.reading(port, line, settings, FRAME)
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
        assert driver.parse(port, good, settings, FRAME) is not None
        assert driver.parse(port, good + b" " * MAX_LINE_BYTES, settings, FRAME) is None
        assert driver.parse(port, b"0" * 41, settings, FRAME) is None


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


@pytest.mark.parametrize("name", FLOODS)
def test_a_flood_on_all_ports_of_a_robot_delays_no_stop(name: str, tmp_path: Path) -> None:
    delays_s = repeated_if_late(stops_in_a_flood)(name, tmp_path)
    assert max(delays_s) < LIMIT_S, delays_s


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

"""Ctrl-C and SIGTERM of the servers: they end soon, with one more line, whatever clients do."""

import base64
import json
import os
import re
import resource
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple
from urllib.request import Request, urlopen

import pytest
from command_line import COMMAND
from live_bench import driving, emulated, fleet_text

SIGNALS = (signal.SIGINT, signal.SIGTERM)
SOON_S = 4.0
"""The servers end in less than half of it, on a machine with nothing else to do."""

UNREAD_BYTES = 200_000_000
"""More than the buffers of a connection take."""

Clients = Callable[[ExitStack, Any], object]


def connected(stack: ExitStack, port: int, data: bytes) -> socket.socket:
    """Return a client that has sent something, and stays connected."""
    client = stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=10))
    client.sendall(data)
    return client


def head(port: int, first: str, *fields: str) -> bytes:
    return "\r\n".join([f"{first} HTTP/1.1", f"Host: 127.0.0.1:{port}", *fields, "", ""]).encode()


def web_socket(stack: ExitStack, port: int, path: str) -> socket.socket:
    """Return an open WebSocket."""
    key = base64.b64encode(os.urandom(16)).decode()
    fields = ("Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13")
    request = head(port, f"GET {path}", *fields, f"Sec-WebSocket-Key: {key}")
    client = connected(stack, port, request)
    assert b" 101 " in client.recv(4096).split(b"\r\n")[0]
    return client


def send(client: socket.socket, **message: Any) -> None:
    """Send a short message of a page; its mask is zero."""
    data = json.dumps(message).encode()
    assert len(data) < 126
    client.sendall(bytes([0x81, 0x80 | len(data)]) + bytes(4) + data)


def of_pages(stack: ExitStack, port: int, query: str = "") -> None:
    """Connect pages that wait, play a run, stop in the middle of a request, and read nothing."""
    for _ in range(3):
        web_socket(stack, port, f"/ws?{query}")
        playing = web_socket(stack, port, f"/ws?{query}")
        send(playing, type="open", scenario="search-beliefs", seed="7", run="0")
        send(playing, type="play", speed=None)
        connected(stack, port, b"")
        connected(stack, port, b"GET /api/scen")
        connected(stack, port, b"no request at all\r\n\r\n")
        connected(stack, port, head(port, f"POST /api/check?{query}", "Content-Length: 99") + b"x")
        connected(stack, port, head(port, f"GET /api/recordings/file?id=large.mcap&{query}"))
        connected(stack, port, head(port, f"GET /api/pictures?scenario=search&{query}"))


def of_a_study(stack: ExitStack, port: int) -> None:
    """Start a study, and connect pages that follow it."""
    keys = ("text", "design", "confidence", "guarantee", "merit", "runs", "max_runs")
    wanted = {"scenario": "search", "delta": 0.002, "vary": {}, "seed": "0"} | dict.fromkeys(keys)
    address = f"http://127.0.0.1:{port}/api/studies"
    fields = {"content-type": "application/json"}
    urlopen(Request(address, json.dumps(wanted).encode(), fields), timeout=30).close()
    for _ in range(3):
        web_socket(stack, port, "/ws?study=studies/search")


def of_robots(stack: ExitStack, addresses: Mapping[str, Any]) -> None:
    """Connect clients of all ports of emulated robots, some in the middle of a line."""
    for robot in addresses["robots"]:
        for name in ("motors", "compass", "gps", "sonar"):
            connected(stack, robot[name], b"")
            connected(stack, robot[name], b"x,2")
    for data in (b"", b'{"get": "sta', b'{"get": "state"}\n' * 1000):
        connected(stack, addresses["control"], data)


def port_of(line: str) -> int:
    found = re.search(r":(\d+)/", line)
    assert found, line
    return int(found[1])


def started(words: list[str], folder: Path) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    program = UI_PROGRAM if words[0] == "ui" else COMMAND
    return subprocess.Popen([*program, *words], stdout=pipe, stderr=pipe, text=True, cwd=folder)


DESCRIPTORS = 96
"""The limit of a server: without a maximum of connections, it would run out of them."""


@contextmanager
def few_descriptors() -> Iterator[None]:
    """Let programs that are started inside have a low limit of descriptors."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


def flood(stack: ExitStack, port: int, data: bytes = b"") -> None:
    """Connect many clients that have no token, or send no complete request, and stay."""
    for _ in range(3 * DESCRIPTORS):
        with suppress(ConnectionError):  # it may be closed at once
            connected(stack, port, data)


UI = ["ui", "--no-browser", "--port", "0"]
UI_PROGRAM = [sys.executable, str(Path(__file__).with_name("ui_without_page.py"))]
EMULATOR = ["bender-emulator", "--ports", "0,0,0,0", "--robots", "2"]


class Served(NamedTuple):
    """A server: its command, its clients, and its exit code after a signal."""

    words: list[str]
    address: Callable[[str], Any]
    clients: Clients
    code: int


SERVERS = {
    "ui": Served(UI, port_of, of_pages, 0),
    "ui with a study": Served(UI, port_of, of_a_study, 0),
    "bender-emulator": Served(EMULATOR, json.loads, of_robots, 130),
}


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("name", SERVERS)
def test_a_server_with_clients_ends_soon_after_a_signal_with_one_more_line(
    tmp_path: Path, name: str, number: signal.Signals
) -> None:
    words, address, clients, code = SERVERS[name]
    with (tmp_path / "large.mcap").open("wb") as file:
        file.truncate(UNREAD_BYTES)
    process = started(words, tmp_path)
    try:
        assert process.stdout
        with ExitStack() as stack:
            clients(stack, address(process.stdout.readline()))
            time.sleep(0.5)
            before_s = time.monotonic()
            process.send_signal(number)
            assert process.wait(20) == code
            assert time.monotonic() - before_s < SOON_S
        assert process.communicate(timeout=20) == ("", "Stopped.\n")
    finally:
        process.kill()


@pytest.mark.parametrize("data", [b"", b"GET / HTTP/1.1\r\nHost: x", b"GET / HTTP/1.1\r\n\r\n"])
def test_idle_connections_neither_keep_others_out_nor_make_the_server_print(
    tmp_path: Path, data: bytes
) -> None:
    with few_descriptors():
        process = started(UI, tmp_path)
    try:
        assert process.stdout
        with ExitStack() as stack:
            port = port_of(process.stdout.readline())
            page = web_socket(stack, port, "/ws")
            send(page, type="open", scenario="search-beliefs", seed="7", run="0")
            assert page.recv(1)
            for _ in range(3):
                flood(stack, port, data)
                urlopen(f"http://127.0.0.1:{port}/api/scenarios", timeout=5).close()
            send(page, type="play", speed=None)
            assert len(page.recv(4096)) > 1
            process.send_signal(signal.SIGINT)
            assert process.wait(20) == 0
        assert process.communicate(timeout=20) == ("", "Stopped.\n")
    finally:
        process.kill()


BLOCKED = """
import asyncio, os, time
from starlette.applications import Starlette
from starlette.routing import Route
from agent_economy.listening import listening_socket
from agent_economy.server.serving import http_server

async def respond(request):
    await asyncio.to_thread(time.sleep, 60)

def overdue():
    print("overdue", flush=True)
    os._exit(7)

listening = listening_socket("127.0.0.1", 0)
print(listening.getsockname()[1], flush=True)
http_server(Starlette(routes=[Route("/", respond)]), overdue).run(sockets=[listening])
"""


def test_a_server_does_not_wait_for_a_calculation_that_takes_long() -> None:
    command, pipe = [sys.executable, "-c", BLOCKED], subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as process:
        try:
            assert process.stdout
            with ExitStack() as stack:
                port = int(process.stdout.readline())
                connected(stack, port, head(port, "GET /"))
                time.sleep(0.5)
                before_s = time.monotonic()
                process.send_signal(signal.SIGINT)
                assert process.wait(20) == 7
                assert time.monotonic() - before_s < SOON_S
            assert process.communicate(timeout=20) == ("overdue\n", "")
        finally:
            process.kill()


def lines_of(drive: Any, kind: str) -> Iterator[dict[str, Any]]:
    return (each for each in drive.events if each["type"] == kind)


def test_the_server_of_the_page_of_a_drive_prints_nothing_whatever_its_clients_do(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with emulated(tmp_path) as bench, ExitStack() as stack:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        with driving(fleet, headless=False) as drive:
            url = drive.wait_for(lambda each: each["type"] == "page")["url"]
            token = re.search(r"token=[\w-]+", url)
            assert token
            of_pages(stack, port_of(url), token[0])
            time.sleep(1.0)
            drive.process.send_signal(signal.SIGINT)
            assert drive.wait() == 130
        assert len(list(lines_of(drive, "page"))) == 1
    assert capfd.readouterr().err.replace("Stopped.\n", "") == ""

"""Limits of the connections of a server, and which of them is closed when there are too many."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect
from test_ctrl_c import connected, head, web_socket

from agent_economy.listening import listening_socket
from agent_economy.server import limits
from agent_economy.server.guard import Guard
from agent_economy.server.serving import http_server

TOKEN = "token=secret"  # noqa: S105
MAXIMUM = 8


async def respond(request: Request) -> PlainTextResponse:
    await request.body()
    return PlainTextResponse("here")


async def slow(_: Request) -> PlainTextResponse:
    await asyncio.sleep(2.0)
    return PlainTextResponse("late")


async def connect(page: WebSocket) -> None:
    await page.accept()
    while True:
        try:
            await page.send_text(await page.receive_text())
        except WebSocketDisconnect:
            return


@contextmanager
def serving() -> Iterator[int]:
    """Serve a guarded application in a thread; yield its port."""
    routes = [
        Route("/", respond, methods=["GET", "POST"]),
        Route("/slow", slow),
        WebSocketRoute("/ws", connect),
    ]
    listening = listening_socket("127.0.0.1", 0)
    server = http_server(Guard(Starlette(routes=routes), "127.0.0.1", "secret"), lambda: None)
    thread = threading.Thread(target=server.run, args=([listening],))
    port = listening.getsockname()[1]
    thread.start()
    try:
        yield port
    finally:
        server.should_exit = True
        thread.join(10)


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Serve with low limits."""
    monkeypatch.setattr(limits, "MAX_CONNECTIONS", MAXIMUM)
    monkeypatch.setattr(limits, "REQUEST_S", 1.0)
    with serving() as port:
        yield port


def is_closed(client: socket.socket, within_s: float) -> bool:
    """Return whether a connection ends in time, whatever it sends before."""
    client.settimeout(within_s)
    try:
        while client.recv(4096):
            pass
    except TimeoutError:
        return False
    except ConnectionError:
        return True
    return True


def answer(client: socket.socket, port: int, path: str = f"/?{TOKEN}") -> bytes:
    """Return the whole answer to a request."""
    client.settimeout(5)
    client.sendall(head(port, f"GET {path}"))
    data = b""
    while not data.endswith((b"here", b"started.")):
        part = client.recv(4096)
        assert part, data
        data += part
    return data


@pytest.mark.parametrize(
    "data", [b"", b"GET / HT", b"POST / HTTP/1.1\r\nContent-Length: 9\r\n\r\nx"]
)
def test_a_connection_without_a_complete_request_is_closed_in_time(port: int, data: bytes) -> None:
    with ExitStack() as stack:
        client = connected(stack, port, data)
        assert is_closed(client, 2.0)


def test_a_second_request_that_is_never_complete_is_closed_in_time(port: int) -> None:
    with ExitStack() as stack:
        client = connected(stack, port, b"")
        assert b"200 OK" in answer(client, port)
        client.sendall(b"GET / HT")
        assert is_closed(client, 2.0)


def test_a_body_that_stops_in_the_middle_is_closed_in_time(port: int) -> None:
    with ExitStack() as stack:
        request = head(port, f"POST /?{TOKEN}", "Content-Length: 99") + b"x"
        client = connected(stack, port, request)
        time.sleep(0.7)
        client.sendall(b"x")
        assert not is_closed(client, 0.7)
        assert is_closed(client, 2.0)


def test_open_web_socket_and_slow_answers_have_no_time_limit(port: int) -> None:
    with ExitStack() as stack:
        page = web_socket(stack, port, f"/ws?{TOKEN}")
        slow = connected(stack, port, head(port, f"GET /slow?{TOKEN}"))
        assert not is_closed(page, 1.8)
        slow.settimeout(5)
        assert b"200 OK" in slow.recv(4096)
        page.sendall(bytes([0x81, 0x81, 0, 0, 0, 0]) + b"x")
        assert page.recv(10) == b"\x81\x01x"


def test_strangers_are_closed_before_those_with_the_token_and_never_the_newest(
    monkeypatch: pytest.MonkeyPatch, port: int
) -> None:
    monkeypatch.setattr(limits, "REQUEST_S", 60.0)
    with ExitStack() as stack:
        page = web_socket(stack, port, f"/ws?{TOKEN}")
        known = connected(stack, port, b"")
        assert b"200 OK" in answer(known, port)
        for _ in range(20):
            for number in range(MAXIMUM):
                stranger = connected(stack, port, b"")
                if number % 2:
                    assert b"403" in answer(stranger, port, "/")
            with ExitStack() as new:
                assert b"200 OK" in answer(connected(new, port, b""), port)
        assert not is_closed(page, 0.1)
        assert b"200 OK" in answer(known, port)


def test_connections_with_the_token_do_not_keep_a_new_one_out(
    monkeypatch: pytest.MonkeyPatch, port: int
) -> None:
    monkeypatch.setattr(limits, "REQUEST_S", 60.0)
    with ExitStack() as stack:
        page = web_socket(stack, port, f"/ws?{TOKEN}")
        for _ in range(3 * MAXIMUM):
            assert b"200 OK" in answer(connected(stack, port, b""), port)
        assert not is_closed(page, 0.1)

"""The server of the page: a child process that is given the run, and that may die at any time.

It is `python -m agent_economy.server.live`. On its standard input it reads JSON, one object a line:

* `{"type": "start", "fleet", "scenario": {"file", "text", "files"}, "seed", "external", "origin",
  "fences_m", "scans", "warden": {"port", "token"}, "token", "listening"}`, once. `files` are those
  that the scenario refers to, in base 64. `external` are bodies as of
  `agent_economy.runs.external.ExternalBody`, and `scans` the sonars of each range sensor. `token`
  is what requests of the page have to contain; it is not an argument, because every user of the
  machine sees those. `listening` is the descriptor of the socket to serve the page at. All servers
  of a drive inherit the same one: between two of them, another program cannot take the address, of
  which the origin keeps the token in browsers.
* `{"type": "input", "tick", "inputs", "stops"}` for each step, from the first one on: the inputs
  of the run as arguments of `agent_economy.Simulation.step`, and the stops of robots before it
  (`agent_economy.recording.stops.Stop`).

The end of its input is the end of the drive. On its standard output it writes one line when it
serves: `{"type": "ready", "url": "http://127.0.0.1:8765/?token=...#/robots"}`.
"""

import asyncio
import os
import secrets
import socket
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

from agent_economy.live.channel import Decoder, Message, encode
from agent_economy.live.clock import now_s
from agent_economy.live.warden.endpoint import Endpoint
from agent_economy.live.warden.history import BLOCK_BYTES, History

COMMAND = (sys.executable, "-m", "agent_economy.server.live")

HOST, PORT = "127.0.0.1", 8765
"""The usual address of the page; another port if that one is used."""

STUCK_S = 30.0
"""A server that has read nothing for this time, although there is something, is replaced."""

LOOK_S = 0.2
FIRST_PAUSE_S, MAX_PAUSE_S = 0.2, 10.0
"""Pauses before a server that has ended is replaced; they grow until one serves."""

MAX_FAILURES = 5
"""After this number of servers that ended before they served, none is started any more."""

END_S = 1.0


class PageProcess:
    """Keeps a server of the page running, and never waits for it.

    Attributes:
        url: Where the page is; empty until a server serves it.
    """

    def __init__(
        self,
        start: Mapping[str, Any],
        ready: Callable[[str], None],
        failed: Callable[[], None],
        command: Sequence[str],
    ) -> None:
        """Create it without starting.

        Args:
            start: The first message, without `listening`.
            ready: Is called with the address of the page, each time that a server serves it.
            failed: Is called when no server is started any more.
            command: The server.
        """
        self.url = ""
        self._start, self._ready, self._failed = dict(start), ready, failed
        self._command = command
        self._history = History(self._loaded)
        self._listening: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._decoder = Decoder()
        self._number = self._offset = 0
        self._block: tuple[int, bytes] | None = None
        self._first = b""
        self._read_s = now_s()
        self._is_waiting = self._has_served = False
        self._task: asyncio.Task[None] | None = None
        self._loop: asyncio.AbstractEventLoop | None = None

    @property
    def pid(self) -> int | None:
        """The process id of the current server."""
        return None if self._process is None else self._process.pid

    def start(self) -> None:
        """Start to keep a server running, until `end`.

        Raises:
            OSError: If there is no address to serve the page at.
        """
        self._listening = _listening_socket()
        self._loop = asyncio.get_running_loop()
        self._task = asyncio.create_task(self._keep_running())

    def add(self, message: Message) -> None:
        """Pass on the inputs of a step."""
        if self._is_caught_up():
            self._read_s = now_s()
        self._history.add(encode(message))
        if not self._is_waiting:
            self._write()

    async def end(self) -> None:
        """Let the server end, or end it."""
        if self._task is not None:
            self._task.cancel()
        process = self._process
        self._close()
        self._history.close()
        if self._listening is not None:
            self._listening.close()
        began_s = now_s()
        while process is not None and process.poll() is None:
            if now_s() - began_s > END_S:
                process.kill()
            await asyncio.sleep(0.02)

    async def _keep_running(self) -> None:
        failures, pause_s = 0, FIRST_PAUSE_S
        while failures < MAX_FAILURES:
            self._launch()
            while self._process is not None and self._process.poll() is None:
                await asyncio.sleep(LOOK_S)
                if not self._is_caught_up() and now_s() - self._read_s > STUCK_S:
                    self._process.kill()
            self._close()
            failures = 0 if self._has_served else failures + 1
            pause_s = FIRST_PAUSE_S if self._has_served else min(2 * pause_s, MAX_PAUSE_S)
            await asyncio.sleep(pause_s)
        self._failed()

    def _launch(self) -> None:
        assert self._listening is not None  # noqa: S101  (it has started)
        listening = self._listening.fileno()
        self._first = encode({**self._start, "listening": listening})
        self._number = self._offset = 0
        self._block, self._decoder = None, Decoder()
        self._read_s, self._has_served = now_s(), False
        with suppress(OSError):
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL if sys.stderr is None else None,
                start_new_session=True,
                pass_fds=(listening,),
            )
            for stream in (self._process.stdin, self._process.stdout):
                assert stream is not None  # noqa: S101  (both are pipes)
                os.set_blocking(stream.fileno(), False)
            asyncio.get_running_loop().add_reader(self._descriptor("stdout"), self._read)
            self._write()

    def _descriptor(self, name: str) -> int:
        return int(getattr(self._process, name).fileno())

    def _read(self) -> None:
        try:
            data = os.read(self._descriptor("stdout"), 2**16)
        except BlockingIOError:
            return
        if not data:
            asyncio.get_running_loop().remove_reader(self._descriptor("stdout"))
            return
        with suppress(ValueError, KeyError, TypeError):  # what it prints may be anything
            for message in self._decoder.feed(data):
                if message["type"] == "ready":
                    self.url, self._has_served = str(message["url"]), True
                    self._ready(self.url)

    def _loaded(self) -> None:
        """Continue to write; called in the thread of the history."""
        with suppress(RuntimeError):  # the drive has ended
            if self._loop is not None:
                self._loop.call_soon_threadsafe(self._write)

    def _is_caught_up(self) -> bool:
        data, is_complete = self._piece()
        return not self._first and not is_complete and self._offset >= len(data)

    def _piece(self) -> tuple[bytes, bool]:
        """Return the block that is being written, and whether there are others after it.

        It is empty, and the last one, while it is read from disk.
        """
        if self._block is not None and self._block[0] == self._number:
            return self._block[1], True
        data, is_complete = self._history.block(self._number) or (b"", False)
        if is_complete:
            self._block = (self._number, data)
        return data, is_complete

    def _write(self) -> None:
        """Write as much as the server reads, and continue when it reads more."""
        if self._process is None:
            return
        try:
            while self._first:
                self._first = self._first[self._written(self._first) :]
            while not self._is_caught_up():
                data, is_complete = self._piece()
                if self._offset < len(data):
                    self._offset += self._written(data[self._offset :])
                elif is_complete:
                    self._number, self._offset = self._number + 1, 0
            self._wait(is_waiting=False)
        except BlockingIOError:
            self._wait(is_waiting=True)
        except OSError:  # it has ended, or will be replaced
            self._wait(is_waiting=False)

    def _written(self, data: bytes) -> int:
        number = os.write(self._descriptor("stdin"), data[:BLOCK_BYTES])
        self._read_s = now_s()
        return number

    def _wait(self, *, is_waiting: bool) -> None:
        loop = asyncio.get_running_loop()
        if is_waiting and not self._is_waiting:
            loop.add_writer(self._descriptor("stdin"), self._write)
        elif self._is_waiting and not is_waiting:
            loop.remove_writer(self._descriptor("stdin"))
        self._is_waiting = is_waiting

    def _close(self) -> None:
        """Forget the server, which ends when its input does."""
        process = self._process
        if process is None:
            return
        self._wait(is_waiting=False)
        asyncio.get_running_loop().remove_reader(self._descriptor("stdout"))
        self._process = None
        for stream in (process.stdin, process.stdout):
            with suppress(OSError):
                if stream is not None:
                    stream.close()


def _listening_socket() -> socket.socket:
    """Return a socket that listens on the usual port, or on any that is free."""
    try:
        return _listening_at(PORT)
    except OSError:
        return _listening_at(0)


def _listening_at(port: int) -> socket.socket:
    listening = socket.socket()
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((HOST, port))
        listening.listen()
    except OSError:
        listening.close()
        raise
    return listening


def origins(url: str) -> tuple[str, str]:
    """Return the origins of the pages at an address: this machine has two names."""
    parts = urlsplit(url)
    first, second = (
        f"{parts.scheme}://{each}:{parts.port}" for each in (parts.hostname, "localhost")
    )
    return first, second


def start_page(
    run: Mapping[str, Any], endpoint: Endpoint, report: Callable[[Mapping[str, Any]], None]
) -> PageProcess | None:
    """Start to serve the page of a drive; its origin may read the answers of the endpoint.

    Without an address to serve it at, that is reported, and there is none.

    Args:
        run: What the loop has reported of the run.
        endpoint: The endpoint, which has started.
        report: Takes the address of the page, as a message.
    """
    warden = {"port": endpoint.address[1], "token": endpoint.token}

    def ready(url: str) -> None:
        for origin in origins(url):
            endpoint.allow(origin)
        report({"type": "page", "url": url, "message": f"The page is at {url}"})

    def failed() -> None:
        text = f"There is no page: its server has ended {MAX_FAILURES} times before it served it"
        report({"type": "message", "message": text})

    # One for all servers: an open page stays valid when its server is replaced.
    token = secrets.token_urlsafe(24)
    start = {"type": "start", **run, "warden": warden, "token": token}
    page = PageProcess(start, ready, failed, COMMAND)
    try:
        page.start()
    except OSError as error:
        text = f"There is no page: no port of {HOST} can be opened: {error.strerror or error}"
        report({"type": "message", "message": text})
        return None
    return page

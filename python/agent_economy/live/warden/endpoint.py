"""The warden's HTTP endpoint on loopback: POST requests of pages and other programs.

The body is JSON of any content type, so that a page can send it as text without a request in
advance; it has the token, which keeps other users and pages in browsers from reaching the robots.
Each connection is served by itself, with limits of size, time and number: none delays the stop of
another, nor the turns of the warden.
"""

import asyncio
import hmac
import json
import random
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from agent_economy.live.warden.admission import Admission

MAX_BYTES = 16_384
"""Bytes of a head, and of a body: a list of a thousand robots."""

READ_TIMEOUT_S = 2.0
"""Time for the rest of a request, from its first byte on."""

IDLE_S = 60.0
"""Time between two requests of one connection."""

MAX_CONNECTIONS = 64
"""With more, one is closed: new ones must always be accepted."""

STOPS = ("/stop", "/hold")
"""Requests of these paths need the token only; others of a page also its origin."""

OTHER_SITES = ("cross-site", "same-site")
"""Values of `Sec-Fetch-Site` of pages of other servers; without an origin they are not known."""

NO_REQUEST = (
    OSError,  # Also a time-out.
    ValueError,
    RecursionError,
    asyncio.IncompleteReadError,
    asyncio.LimitOverrunError,
)
"""What reading a request raises that is none."""

Answer = Mapping[str, Any]
Action = Callable[[dict[str, Any]], Answer]
"""Takes the body of a request and returns an answer; ValueError refuses it with the reason."""


@dataclass(frozen=True)
class Request:
    """A request as it was read.

    Attributes:
        method: Its method.
        path: Its path.
        fields: The fields of its head, in lower case.
        body: Its body.
    """

    method: str
    path: str
    fields: Mapping[str, str]
    body: bytes

    @property
    def origin(self) -> str:
        """The origin of the page that sends it; empty for other programs."""
        return self.fields.get("origin", "").strip()

    @property
    def is_of_unknown_page(self) -> bool:
        """Whether a page of another server sends it, without its origin."""
        return not self.origin and is_of_other_site(self.fields)

    @property
    def is_last(self) -> bool:
        """Whether the connection ends after it."""
        return self.fields.get("connection", "").strip().lower() == "close"


class Endpoint:
    """Serves requests of operators.

    Attributes:
        token: What each request has to contain.
        address: Host and port, once it has started.
    """

    def __init__(self, actions: Mapping[str, Action]) -> None:
        """Create it; `actions` are keyed by path."""
        self.token, self.address = secrets.token_urlsafe(16), ("127.0.0.1", 0)
        self._actions = actions
        self._origins: set[str] = set()
        self._open: dict[asyncio.StreamWriter, bool] = {}
        self._server: asyncio.Server | None = None
        self._admission = Admission()

    async def start(self) -> None:
        """Listen on a free port of the loopback interface."""
        self._server = await asyncio.start_server(self._serve, self.address[0], 0, limit=MAX_BYTES)
        host, port = self._server.sockets[0].getsockname()[:2]
        self.address = (host, port)

    def allow(self, origin: str) -> None:
        """Let pages of an origin, such as `http://127.0.0.1:80`, send requests and read answers."""
        self._origins.add(origin)

    def close(self) -> None:
        """Accept no more requests."""
        if self._server is not None:
            self._server.close()
        for writer in self._open:
            writer.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._open[writer] = False
        if len(self._open) > MAX_CONNECTIONS:
            self._close_one()
        try:
            while await self._serve_one(reader, writer):
                pass
        except (OSError, asyncio.CancelledError):
            # The end of the drive cancels it. asyncio of Python 3.11 would report that as an error.
            pass
        finally:
            self._open.pop(writer, None)
            with suppress(OSError):
                writer.close()

    def _close_one(self) -> None:
        """Close a connection: the oldest that had the token, or one at random of the others.

        At random, because a program that opens many would else close each new one of others.
        """
        strangers = [writer for writer, is_known in self._open.items() if not is_known]
        chosen = random.choice(strangers) if strangers else next(iter(self._open))  # noqa: S311
        self._open.pop(chosen)
        chosen.transport.abort()

    async def _serve_one(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bool:
        """Answer the next request; return whether another one may follow."""
        try:
            async with asyncio.timeout(IDLE_S):
                first = await reader.readexactly(1)
        except (TimeoutError, asyncio.IncompleteReadError):
            return False
        await self._admission.wait()
        request = None
        try:
            async with asyncio.timeout(READ_TIMEOUT_S):
                request = await _read(first, reader)
            status, answer = self._answer(request)
            if writer in self._open and status in (HTTPStatus.OK, HTTPStatus.CONFLICT):
                self._open[writer] = True
        except NO_REQUEST:
            text = "not a request that this endpoint takes"
            status, answer = HTTPStatus.BAD_REQUEST, {"message": text}
        is_last = request is None or request.is_last
        origin = "" if request is None else request.origin
        async with asyncio.timeout(READ_TIMEOUT_S):
            writer.write(self._response(status, answer, origin, is_last=is_last))
            await writer.drain()
        return not is_last

    def _response(self, status: HTTPStatus, answer: Answer, origin: str, *, is_last: bool) -> bytes:
        body = (json.dumps(answer) + "\n").encode()
        lines = [
            f"HTTP/1.1 {status.value} {status.phrase}",
            "Content-Type: application/json",
            f"Content-Length: {len(body)}",
            "Cache-Control: no-store",
            "Vary: Origin",
            f"Connection: {'close' if is_last else 'keep-alive'}",
        ]
        if origin in self._origins:
            lines.append(f"Access-Control-Allow-Origin: {origin}")
        return ("\r\n".join(lines) + "\r\n\r\n").encode() + body

    def _answer(self, request: Request) -> tuple[HTTPStatus, Answer]:
        action = self._actions.get(request.path)
        if action is None:
            text = f"must be one of {', '.join(self._actions)}"
            return HTTPStatus.NOT_FOUND, {"message": text}
        if request.method != "POST":
            return HTTPStatus.METHOD_NOT_ALLOWED, {"message": "must be a POST request"}
        body = json.loads(request.body)
        if not isinstance(body, dict):
            raise ValueError  # noqa: TRY004  (of the request, not of the program)
        if not hmac.compare_digest(str(body.get("token")).encode(), self.token.encode()):
            return HTTPStatus.FORBIDDEN, {"message": "the token is missing or wrong"}
        is_known = request.origin in ("", *self._origins) and not request.is_of_unknown_page
        if not is_known and request.path not in STOPS:
            text = f"pages of {request.origin or 'other sites'} are not allowed"
            return HTTPStatus.FORBIDDEN, {"message": text}
        try:
            return HTTPStatus.OK, action(body)
        except ValueError as error:
            return HTTPStatus.CONFLICT, {"message": str(error)}


def is_of_other_site(fields: Mapping[str, str]) -> bool:
    """Return whether a browser states that a page of another server sends a request."""
    return fields.get("sec-fetch-site", "").strip() in OTHER_SITES


async def _read(first: bytes, reader: asyncio.StreamReader) -> Request:
    head = first + await reader.readuntil(b"\r\n\r\n")
    start, *lines = head.decode("latin-1").split("\r\n")
    method, path, *_ = start.split(" ")
    pairs = (line.split(":", 1) for line in lines if ":" in line)
    fields = {name.lower(): value for name, value in pairs}
    length = int(fields.get("content-length", "0"))
    if not 0 <= length <= MAX_BYTES:
        raise ValueError
    return Request(method, path, fields, await reader.readexactly(length))

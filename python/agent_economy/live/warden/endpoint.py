"""The warden's HTTP endpoint: `POST /stop`, `/arm` and `/release`, on loopback.

The body is JSON: `{"token": ...}`, for `/arm` also `{"robots": [...]}`, without which all robots
are armed. The token keeps other users and pages in browsers from reaching the robots.
"""

import asyncio
import hmac
import json
import secrets
from collections.abc import Callable
from contextlib import suppress
from http import HTTPStatus
from typing import Any

MAX_BYTES = 65_536
READ_TIMEOUT_S = 2.0

NO_REQUEST = (
    OSError,  # Also a time-out.
    ValueError,
    RecursionError,
    asyncio.IncompleteReadError,
    asyncio.LimitOverrunError,
)
"""What reading a request raises that is none."""

Action = Callable[[dict[str, Any]], str]
"""Takes the body of a request and returns an answer in words; ValueError refuses it."""


class Endpoint:
    """Serves requests of operators.

    Attributes:
        token: What each request has to contain.
        address: Host and port, once it has started.
    """

    def __init__(self, actions: dict[str, Action]) -> None:
        """Create it; `actions` are keyed by path."""
        self.token, self.address = secrets.token_urlsafe(16), ("127.0.0.1", 0)
        self._actions = actions
        self._server: asyncio.Server | None = None

    async def start(self) -> None:
        """Listen on a free port of the loopback interface."""
        self._server = await asyncio.start_server(self._serve, self.address[0], 0, limit=MAX_BYTES)
        host, port = self._server.sockets[0].getsockname()[:2]
        self.address = (host, port)

    def close(self) -> None:
        """Accept no more requests."""
        if self._server is not None:
            self._server.close()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            async with asyncio.timeout(READ_TIMEOUT_S):
                status, text = await self._answer(reader)
        except NO_REQUEST:
            status, text = HTTPStatus.BAD_REQUEST, "not a request that this endpoint takes"
        body = (json.dumps({"message": text}) + "\n").encode()
        head = (
            f"HTTP/1.1 {status.value} {status.phrase}\r\nContent-Type: application/json\r\n"
            f"Content-Length: {len(body)}\r\nConnection: close\r\n\r\n"
        )
        with suppress(OSError):
            writer.write(head.encode() + body)
            await writer.drain()
            writer.close()

    async def _answer(self, reader: asyncio.StreamReader) -> tuple[HTTPStatus, str]:
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
        method, path, *_ = head[0].split(" ")
        action = self._actions.get(path)
        if action is None:
            return HTTPStatus.NOT_FOUND, f"must be one of {', '.join(self._actions)}"
        if method != "POST":
            return HTTPStatus.METHOD_NOT_ALLOWED, "must be a POST request"
        body = await self._body(reader, head[1:])
        if not hmac.compare_digest(str(body.get("token")).encode(), self.token.encode()):
            return HTTPStatus.FORBIDDEN, "the token is missing or wrong"
        try:
            return HTTPStatus.OK, action(body)
        except ValueError as error:
            return HTTPStatus.CONFLICT, str(error)

    async def _body(self, reader: asyncio.StreamReader, lines: list[str]) -> dict[str, Any]:
        fields = dict(line.lower().split(":", 1) for line in lines if ":" in line)
        length = int(fields.get("content-length", "0"))
        if not 0 < length <= MAX_BYTES:
            raise ValueError
        body = json.loads(await reader.readexactly(length))
        if not isinstance(body, dict):
            raise ValueError  # noqa: TRY004  (of the request, not of the program)
        return body

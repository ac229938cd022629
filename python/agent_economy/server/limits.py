"""Limits of the connections of a server: none that is idle keeps others out.

With more than the maximum, one that has not had an accepted request is closed, at random: a program
that opens many would else close each new one of others. What waits for a request, the first or
another one, is closed after a time limit. Open WebSockets have none.
"""

import asyncio
import random
import resource
import socket
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from http import HTTPStatus

from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

MAX_CONNECTIONS = 256
"""More than all runs and studies that pages may have open."""

SHARE = 4
"""The connections take one of this number of the descriptors that the process may open."""

REQUEST_S = 5.0
"""Time for the head of each request, from the start of its connection or the answer before, and
for each part of its body."""

REFUSALS = (HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN)

Client = tuple[str, int]


@dataclass
class Peer:
    """A connection.

    Attributes:
        transport: What it is sent and received with.
        waiting_since_s: Since when its next request is not complete; None while one is served.
        is_known: Whether a request of it was accepted, which means that it has the token.
        is_web_socket: Whether it is an open WebSocket.
    """

    transport: asyncio.Transport
    waiting_since_s: float | None = field(default_factory=time.monotonic)
    is_known: bool = False
    is_web_socket: bool = False

    @property
    def is_open(self) -> bool:
        """Whether it has a descriptor; one that is being closed may still have to send."""
        own: socket.socket | None = self.transport.get_extra_info("socket")
        return own is not None and own.fileno() >= 0


class ConnectionLimits:
    """Closes connections when there are too many, and those that wait for too long."""

    def __init__(self, maximum: int | None = None) -> None:
        """Create it; by default the maximum follows from the descriptors of the process."""
        soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        own = MAX_CONNECTIONS if soft == resource.RLIM_INFINITY else soft // SHARE
        self._maximum = maximum or max(1, min(MAX_CONNECTIONS, own))
        self._peers: dict[Client, Peer] = {}

    def open(self, client: Client, transport: asyncio.Transport) -> None:
        """Count a new connection, and close another one if there are too many."""
        self._forget_closed()
        others = list(self._peers)
        self._peers[client] = Peer(transport)
        if len(others) >= self._maximum:
            self._close_one_of(others)

    def close_late(self) -> None:
        """Close the connections of which no request was complete in time."""
        self._forget_closed()
        latest_s = time.monotonic() - REQUEST_S
        for peer in self._peers.values():
            if peer.waiting_since_s is not None and peer.waiting_since_s < latest_s:
                peer.transport.abort()

    def peer(self, scope: Scope) -> Peer | None:
        """Return the connection of a request."""
        client = scope.get("client")
        return None if client is None else self._peers.get(tuple(client))

    def _forget_closed(self) -> None:
        self._peers = {client: peer for client, peer in self._peers.items() if peer.is_open}

    def _close_one_of(self, others: list[Client]) -> None:
        peers = self._peers
        strangers = [each for each in others if not peers[each].is_known]
        without_page = [each for each in others if not peers[each].is_web_socket]
        chosen = random.choice(strangers or without_page or others)  # noqa: S311
        peers.pop(chosen).transport.abort()


@dataclass(frozen=True)
class Limited:
    """An application that reports what its connections do to their limits."""

    app: ASGIApp
    limits: ConnectionLimits

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Forward a request, which counts from its last byte to the end of its answer."""
        peer = self.limits.peer(scope)
        if peer is None:
            await self.app(scope, receive, send)
            return
        if not has_body(scope):
            peer.waiting_since_s = None

        async def received() -> Message:
            message = await receive()
            is_complete = not message.get("more_body", False)
            peer.waiting_since_s = None if is_complete else time.monotonic()
            return message

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                peer.waiting_since_s = None
                peer.is_known |= message["status"] not in REFUSALS
            elif message["type"] == "websocket.accept":
                peer.is_known = peer.is_web_socket = True
            await send(message)

        try:
            await self.app(scope, received, sent)
        finally:
            # Its answer may have to be sent still, and another request may follow.
            peer.waiting_since_s = time.monotonic()


def has_body(scope: Scope) -> bool:
    """Return whether a request has a body, which may not have arrived yet."""
    fields: Mapping[bytes, bytes] = dict(scope.get("headers", ()))
    return b"transfer-encoding" in fields or fields.get(b"content-length", b"0") != b"0"


def protocol_within(limits: ConnectionLimits) -> type[H11Protocol]:
    """Return the protocol of HTTP, of which each connection counts."""

    class Protocol(H11Protocol):
        def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
            super().connection_made(transport)
            if self.client is None:  # it has gone already
                transport.abort()
            else:
                limits.open(self.client, transport)

    return Protocol

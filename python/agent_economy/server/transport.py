"""The WebSocket that connects the server to a page."""

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import msgspec
from starlette.websockets import WebSocket, WebSocketDisconnect

from agent_economy.types.page import ServerMessage


class ConnectionClosedError(Exception):
    """The page has closed the connection, or the server is about to close it."""


class Page(Protocol):
    """The page at the other end; every method raises `ConnectionClosedError` once it is gone."""

    async def receive(self) -> str:
        """Return the next message of the page."""

    async def send(self, message: ServerMessage) -> None:
        """Send a message."""

    async def send_bytes(self, data: bytes) -> None:
        """Send a frame or an overlay."""


@dataclass(frozen=True)
class Connection:
    """A page that is connected by a WebSocket."""

    socket: WebSocket

    async def receive(self) -> str:
        """Return the next message of the page."""
        try:
            return await self.socket.receive_text()
        except (WebSocketDisconnect, RuntimeError, KeyError):
            raise ConnectionClosedError from None

    async def send(self, message: ServerMessage) -> None:
        """Send a message."""
        with closed_if_disconnected():
            await self.socket.send_text(msgspec.json.encode(message).decode())

    async def send_bytes(self, data: bytes) -> None:
        """Send a frame or an overlay."""
        with closed_if_disconnected():
            await self.socket.send_bytes(data)

    async def close(self, code: int = 1000) -> None:
        """Close the connection, if the page has not."""
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await self.socket.close(code)


@contextlib.contextmanager
def closed_if_disconnected() -> Iterator[None]:
    """Raise `ConnectionClosedError` where the WebSocket is disconnected."""
    try:
        yield
    except (WebSocketDisconnect, RuntimeError):
        raise ConnectionClosedError from None

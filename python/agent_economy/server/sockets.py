"""A page at the other end of a WebSocket."""

import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from agent_economy.server.session import GoneError


@dataclass(frozen=True)
class Socket:
    """A page at the other end of a WebSocket."""

    socket: WebSocket

    async def receive(self) -> str:
        """Return what the page says next."""
        try:
            return await self.socket.receive_text()
        except (WebSocketDisconnect, RuntimeError, KeyError):
            raise GoneError from None

    async def tell(self, said: dict[str, Any]) -> None:
        """Tell the page something."""
        with ended_if_gone():
            await self.socket.send_text(json.dumps(said, allow_nan=False))

    async def show(self, frame: bytes) -> None:
        """Send a frame."""
        with ended_if_gone():
            await self.socket.send_bytes(frame)

    async def close(self, code: int = 1000) -> None:
        """Close it, if the page has not."""
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await self.socket.close(code)


@contextlib.contextmanager
def ended_if_gone() -> Iterator[None]:
    """Say so if the page has gone."""
    try:
        yield
    except (WebSocketDisconnect, RuntimeError):
        raise GoneError from None

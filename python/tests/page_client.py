"""A client of the server that behaves as the page does."""

import json
import struct
from typing import Any

from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

HEADER = struct.Struct("<4Id2I")

OWN, WS = "http://127.0.0.1:8765", "ws://127.0.0.1:8765/ws"


class Page:
    """A page that receives all messages, and acknowledges each frame."""

    def __init__(self, socket: WebSocketTestSession, *, draws: bool = True) -> None:
        """Begin with nothing received."""
        self.socket, self.draws = socket, draws
        self.frames: list[bytes] = []
        self.received: list[dict[str, Any]] = []

    def send(self, kind: str, **rest: Any) -> None:
        """Send a message."""
        self.socket.send_text(json.dumps({"type": kind, **rest}))

    def next(self) -> dict[str, Any]:
        """Return the next message; frames before it are acknowledged."""
        while True:
            message = self.socket.receive()
            if message["type"] == "websocket.close":
                raise WebSocketDisconnect(message["code"])
            if message.get("bytes") is not None:
                self.frames.append(message["bytes"])
                if self.draws:
                    self.send("acknowledge", frame=HEADER.unpack_from(message["bytes"])[6])
                continue
            self.received.append(json.loads(message["text"]))
            return self.received[-1]

    def wait_for(self, kind: str, **rest: Any) -> dict[str, Any]:
        """Wait for a message of a type that contains these values."""
        while True:
            message = self.next()
            if message["type"] == kind and all(
                message[key] == value for key, value in rest.items()
            ):
                return message

    def open(self, **rest: Any) -> dict[str, Any]:
        """Open a run, and wait until it has reached its tick."""
        self.send("open", **{"scenario": "search-beliefs", "seed": "7", "run": "0"} | rest)
        self.wait_for("opened")
        return self.wait_for("state", tick=rest.get("tick", 0))

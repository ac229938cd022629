"""A page that watches a run of a server."""

import json
import struct
from typing import Any

from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

HEADER = struct.Struct("<4Id2I")

OWN, WS = "http://127.0.0.1:8765", "ws://127.0.0.1:8765/ws"


class Page:
    """A page that reads all that it is sent, and says that it has drawn each frame."""

    def __init__(self, socket: WebSocketTestSession, *, draws: bool = True) -> None:
        """Begin with nothing heard."""
        self.socket, self.draws = socket, draws
        self.frames: list[bytes] = []
        self.said: list[dict[str, Any]] = []

    def say(self, kind: str, **rest: Any) -> None:
        """Say something."""
        self.socket.send_text(json.dumps({"type": kind, **rest}))

    def next(self) -> dict[str, Any]:
        """Return what is told next; frames are drawn on the way."""
        while True:
            message = self.socket.receive()
            if message["type"] == "websocket.close":
                raise WebSocketDisconnect(message["code"])
            if message.get("bytes") is not None:
                self.frames.append(message["bytes"])
                if self.draws:
                    self.say("acknowledge", frame=HEADER.unpack_from(message["bytes"])[6])
                continue
            self.said.append(json.loads(message["text"]))
            return self.said[-1]

    def until(self, kind: str, **rest: Any) -> dict[str, Any]:
        """Wait until something is told, with these values in it."""
        while True:
            told = self.next()
            if told["type"] == kind and all(told[key] == value for key, value in rest.items()):
                return told

    def open(self, **rest: Any) -> dict[str, Any]:
        """Open a run, and wait until it has come to its tick."""
        self.say("open", **{"scenario": "search-beliefs", "seed": "7", "run": "0"} | rest)
        self.until("opened")
        return self.until("state", tick=rest.get("tick", 0))

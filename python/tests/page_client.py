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

    def change(self, path: str, value: object, **rest: Any) -> dict[str, Any]:
        """Change the scenario, and return the setting."""
        self.send("change", path=path, value=value, **rest)
        return self.wait_for("setting")

    def step(self, steps: int, *, to: int) -> dict[str, Any]:
        """Step forward or back to a tick, and return the state there."""
        self.send("step", steps=steps)
        return self.wait_for("state", tick=to)

    def seek(self, tick: int) -> dict[str, Any]:
        """Seek a tick, and return the state there."""
        self.send("seek", tick=tick)
        return self.wait_for("state", tick=tick)

    def finish(self) -> dict[str, Any]:
        """Play the run as fast as possible, and return its last state."""
        self.send("play", speed=None)
        return self.wait_for("state", is_over=True, is_playing=False)

    def refusal(self, kind: str, **rest: Any) -> str:
        """Send a message that is refused, and return the reason."""
        self.send(kind, **rest)
        reason = self.wait_for("refused")["errors"][0]["message"]
        assert isinstance(reason, str)
        return reason

    def open_recording(self, name: str, tick: int = 0, **rest: Any) -> dict[str, Any]:
        """Open a recording, and wait until it has reached its tick."""
        self.send("open", recording=name, tick=tick, **rest)
        self.wait_for("opened")
        return self.wait_for("state", tick=tick)

    def open(self, **rest: Any) -> dict[str, Any]:
        """Open a run, and wait until it has reached its tick."""
        self.send("open", **{"scenario": "search-beliefs", "seed": "7", "run": "0"} | rest)
        self.wait_for("opened")
        return self.wait_for("state", tick=rest.get("tick", 0))

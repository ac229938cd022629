"""One TCP connection to a port of a robot."""

import asyncio
import fcntl
import socket
import struct
import sys
from collections.abc import Callable

from agent_economy.live.drivers.lines import LineSplitter

_SIOCOUTQ = 0x5411 if sys.platform == "linux" else None

MAX_LINES = 20
"""Lines that are taken of one port at once, and in one turn: a robot that sends more, or has piled
up more, must not hold up the others."""

Received = Callable[[bytes], None]


class Connection(asyncio.Protocol):
    """Passes on complete lines as they arrive, and knows what has not been acknowledged.

    Attributes:
        is_up: Whether it is connected.
        reason: Why it is not; empty while it is.
    """

    def __init__(self, received: Received) -> None:
        """Wait to be connected; `received` is called with each line."""
        self.is_up, self.reason = False, "not connected yet"
        self.closed = asyncio.Event()
        self._received, self._splitter = received, LineSplitter()
        self._transport: asyncio.Transport | None = None
        self._socket: socket.socket | None = None
        self._queued_since_s: float | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Note the connection."""
        assert isinstance(transport, asyncio.Transport)  # noqa: S101  (of create_connection)
        self._transport, self._socket = transport, transport.get_extra_info("socket")
        if self._socket is not None:
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.is_up, self.reason = True, ""

    def data_received(self, data: bytes) -> None:
        """Pass on the lines that are complete: of many that came together, only the newest."""
        for line in self._splitter.feed(data)[-MAX_LINES:]:
            self._received(line)

    def connection_lost(self, error: Exception | None) -> None:
        """Note why the connection ended."""
        self.is_up = False
        self.reason = str(error) if error else "closed by the robot"
        self.closed.set()

    def peer(self) -> tuple[str, int] | None:
        """Return the numeric address of the robot; None while it is not connected."""
        if self._transport is None or not self.is_up:
            return None
        address = self._transport.get_extra_info("peername")
        return (str(address[0]), int(address[1]))

    def write(self, data: bytes, now_s: float) -> None:
        """Write or queue bytes."""
        if self._transport is not None and self.is_up:
            self._transport.write(data)
            if self._queued_since_s is None:
                self._queued_since_s = now_s

    def is_empty(self) -> bool:
        """Whether the robot's machine has acknowledged all that was written.

        Where the system does not show that, whether all has been handed to it.
        """
        if self._transport is None or not self.is_up:
            return True
        if self._transport.get_write_buffer_size() > 0:
            return False
        number = -1 if self._socket is None else self._socket.fileno()
        if _SIOCOUTQ is None or number < 0:  # closing
            return True
        queued = fcntl.ioctl(number, _SIOCOUTQ, b"\0" * 4)
        return bool(struct.unpack("i", queued)[0] == 0)

    def is_acknowledged(self) -> bool:
        """Whether the robot's machine is known to have acknowledged all that was written."""
        return _SIOCOUTQ is not None and self.is_up and self.is_empty()

    def unacknowledged_s(self, now_s: float) -> float:
        """Return for how long written bytes have not been acknowledged."""
        if self._queued_since_s is None or self.is_empty():
            self._queued_since_s = None
            return 0.0
        return now_s - self._queued_since_s

    def abort(self) -> None:
        """Close at once, and drop what is queued here."""
        if self._transport is not None:
            self._transport.abort()

    def close(self) -> None:
        """Close after what is queued here has been sent."""
        if self._transport is not None:
            self._transport.close()

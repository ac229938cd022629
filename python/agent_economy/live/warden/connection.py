"""One TCP connection to a port of a robot."""

import asyncio
import fcntl
import socket
import struct
import sys
from collections.abc import Callable
from dataclasses import dataclass

from agent_economy.live.drivers.lines import MAX_LINES, LineSplitter

_SIOCOUTQ = 0x5411 if sys.platform == "linux" else None

MAX_TURN_BYTES, MAX_TURN_LINES = 262_144, 200
"""What is taken in one turn of the warden, of all ports of all robots together."""

MIN_BYTES, MAX_BYTES = 1024, 16_384
"""Bytes that are read of one port in one turn: at least, so that any line is read, and at most."""

_RESET = struct.pack("ii", 1, 0)
"""The option SO_LINGER with which a close resets the connection."""

Received = Callable[[bytes], None]


@dataclass(frozen=True)
class Share:
    """What is taken of one port in one turn of the warden.

    Attributes:
        bytes: Bytes that are read.
        lines: Lines that are taken; of more, the newest.
    """

    bytes: int = MAX_BYTES
    lines: int = MAX_LINES

    @classmethod
    def of(cls, ports: int) -> "Share":
        """Return the share of each of a number of ports."""
        return cls(
            max(MIN_BYTES, min(MAX_BYTES, MAX_TURN_BYTES // ports)),
            max(1, min(MAX_LINES, MAX_TURN_LINES // ports)),
        )


class Connection(asyncio.BufferedProtocol):
    """Passes on complete lines as they arrive, and knows what has not been acknowledged.

    It reads once, and then not until the next turn of the warden (`resume`), so that the work per
    turn is bounded however much all robots send.

    Attributes:
        is_up: Whether it is connected.
        reason: Why it is not; empty while it is.
        closed: Is set when it has ended.
        lost: Is set when it has ended, or should be replaced because nothing is acknowledged.
    """

    def __init__(self, received: Received, share: Share) -> None:
        """Wait to be connected; `received` is called with each line, the newest of each read."""
        self.is_up, self.reason = False, "not connected yet"
        self.closed, self.lost = asyncio.Event(), asyncio.Event()
        self._received, self._splitter = received, LineSplitter(share.lines)
        self._buffer = bytearray(share.bytes)
        self._transport: asyncio.Transport | None = None
        self._socket: socket.socket | None = None
        self._queued_since_s: float | None = None
        self._written = self._acknowledged = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Note the connection."""
        assert isinstance(transport, asyncio.Transport)  # noqa: S101  (of create_connection)
        self._transport, self._socket = transport, transport.get_extra_info("socket")
        if self._socket is not None:
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.is_up, self.reason = True, ""

    def get_buffer(self, sizehint: int) -> bytearray:  # noqa: ARG002  (asyncio's signature)
        """Return where to read to."""
        return self._buffer

    def buffer_updated(self, count: int) -> None:
        """Pass on the lines that are complete, and read no more in this turn.

        A full buffer has others behind it: its lines are old, although they have just arrived, and
        are dropped. A port that sends more than is read therefore gives no value.
        """
        assert self._transport is not None  # noqa: S101  (it is connected)
        self._transport.pause_reading()
        if count == len(self._buffer):
            self._splitter.skip()
            return
        for line in self._splitter.feed(bytes(self._buffer[:count])):
            self._received(line)

    def resume(self) -> None:
        """Read again: a turn has begun."""
        if self._transport is not None and self.is_up:
            self._transport.resume_reading()

    def connection_lost(self, error: Exception | None) -> None:
        """Note why the connection ended."""
        self.is_up = False
        self.reason = str(error) if error else "closed by the robot"
        self.closed.set()
        self.lost.set()

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
            self._written += len(data)
            if self._queued_since_s is None:
                self._queued_since_s = now_s

    def is_empty(self) -> bool:
        """Whether the robot's machine has acknowledged all that was written.

        Where the system does not show that, whether all has been handed to it.
        """
        return self._outstanding() == 0

    def _outstanding(self) -> int:
        """Return how many of the written bytes have not been acknowledged."""
        if self._transport is None or not self.is_up:
            return 0
        queued = self._transport.get_write_buffer_size()
        number = -1 if self._socket is None else self._socket.fileno()
        if _SIOCOUTQ is None or number < 0:  # closing
            return queued
        sent = fcntl.ioctl(number, _SIOCOUTQ, b"\0" * 4)
        return queued + int(struct.unpack("i", sent)[0])

    def is_acknowledged(self) -> bool:
        """Whether the robot's machine is known to have acknowledged all that was written."""
        return _SIOCOUTQ is not None and self.is_up and self.is_empty()

    def unacknowledged_s(self, now_s: float) -> float:
        """Return for how long nothing has been acknowledged although something was written."""
        outstanding = self._outstanding()
        before, self._acknowledged = self._acknowledged, self._written - outstanding
        if self._queued_since_s is None or outstanding == 0:
            self._queued_since_s = None
            return 0.0
        if self._acknowledged > before:
            # A slow link acknowledges each line, and has another one under way all the time.
            self._queued_since_s = now_s
        return now_s - self._queued_since_s

    def abort(self) -> None:
        """Close at once, and drop what is queued here."""
        if self._transport is not None:
            self._transport.abort()

    def reset(self) -> None:
        """Close at once, and drop everything that the robot's machine has not acknowledged.

        After a close, the kernel would deliver an old motion for minutes.
        """
        if self._socket is not None and self.is_up:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET)
        self.abort()

    def close(self) -> None:
        """Close after what is queued here has been sent."""
        if self._transport is not None:
            self._transport.close()

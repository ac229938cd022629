"""The TCP servers of the robots: each sends to all of its clients, and reads their lines."""

import asyncio
import socket
from collections.abc import Callable, Iterable
from typing import Any

from agent_economy._core import InputError
from agent_economy.listening import listening_socket
from agent_economy.live.emulator.lines import LineReader
from agent_economy.live.emulator.packet_loss import lose_packets
from agent_economy.live.emulator.transport import Piece

MAX_UNSENT_BYTES = 65_536
"""A client that has not read this much gets no further lines."""

Receive = Callable[[bytes], None]
Report = Callable[[str], None]


class Port:
    """A TCP server of one robot.

    Attributes:
        number: The number of its port.
    """

    def __init__(self, host: str, receive: Receive, report: Report) -> None:
        """Create a server that does not listen yet.

        Args:
            host: Name or address to listen on.
            receive: Called with each line, without its end.
            report: Called with each event: opened, closed, turned away, overflow.
        """
        self._host, self._receive, self._report = host, receive, report
        self._clients: set[_Client] = set()
        self._server: asyncio.Server | None = None
        self._is_stalled = False
        self.number = 0
        self.max_clients: int | None = None

    async def listen(self, number: int) -> None:
        """Listen on a port; 0 is any free one.

        Raises:
            InputError: If the address cannot be used.
        """
        listening = bound(self._host, number)
        self.number = listening.getsockname()[1]
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(self._client, sock=listening)

    async def refuse(self, *, on: bool) -> None:
        """Refuse new connections, or accept them again on the same port."""
        if on and self._server:
            self._server.close()
            self._server = None
        elif not on and self._server is None:
            await self.listen(self.number)

    def stall(self, *, on: bool) -> None:
        """Stop reading, or read again."""
        self._is_stalled = on
        for client in self._clients:
            client.stall(on=on)

    def cut(self, *, on: bool) -> None:
        """Lose every packet that arrives, also those of new connections, or take them again."""
        sockets = [*self._server.sockets] if self._server else []
        sockets += [link for client in self._clients if (link := client.socket()) is not None]
        for link in sockets:
            lose_packets(link, on=on)

    def send(self, parts: Iterable[Piece]) -> bool:
        """Send the parts of a line to all clients; return whether there is any."""
        for delay_s, data in parts:
            if delay_s > 0:
                asyncio.get_running_loop().call_later(delay_s, self._write, data)
            else:
                self._write(data)
        return bool(self._clients)

    def _write(self, data: bytes) -> None:
        for client in self._clients:
            if not client.write(data):
                self._report("overflow")

    @property
    def connections(self) -> int:
        """Number of clients."""
        return len(self._clients)

    def close_clients(self) -> None:
        """Close all connections."""
        for client in list(self._clients):
            client.close()

    def close(self) -> None:
        """Stop listening and close all connections."""
        if self._server:
            self._server.close()
        self.close_clients()

    def _client(self) -> "_Client":
        return _Client(self)

    def opened(self, client: "_Client") -> None:
        """Add a client, or close its connection if there are enough."""
        if self.max_clients is not None and len(self._clients) >= self.max_clients:
            self._report("turned away")
            client.close()
            return
        self._clients.add(client)
        self._report("opened")
        client.stall(on=self._is_stalled)

    def closed(self, client: "_Client") -> None:
        """Remove a client."""
        if client in self._clients:
            self._clients.remove(client)
            self._report("closed")

    def received(self, lines: list[bytes]) -> None:
        """Pass on lines of a client."""
        for line in lines:
            self._receive(line)


class _Client(asyncio.Protocol):
    def __init__(self, port: Port) -> None:
        self._port = port
        self._reader = LineReader()
        self._transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)  # noqa: S101  (a TCP connection)
        self._transport = transport
        self._port.opened(self)

    def data_received(self, data: bytes) -> None:
        self._port.received(self._reader.feed(data))

    def connection_lost(self, exc: Exception | None) -> None:  # noqa: ARG002  (asyncio's name)
        self._port.closed(self)

    def write(self, data: bytes) -> bool:
        """Write unless the client reads too slowly; return whether it was written."""
        if self._transport is None or self._transport.is_closing():
            return True
        if self._transport.get_write_buffer_size() > MAX_UNSENT_BYTES:
            return False
        self._transport.write(data)
        return True

    def stall(self, *, on: bool) -> None:
        if self._transport is None or self._transport.is_closing():
            return
        if on:
            self._transport.pause_reading()
        else:
            self._transport.resume_reading()

    def socket(self) -> Any:
        """Return its socket; None once it is closing."""
        if self._transport is None or self._transport.is_closing():
            return None
        return self._transport.get_extra_info("socket")

    def close(self) -> None:
        if self._transport:
            self._transport.abort()


def bound(host: str, number: int) -> socket.socket:
    """Return a listening socket.

    Raises:
        InputError: If the address cannot be used.
    """
    try:
        return listening_socket(host, number)
    except InputError as error:
        message = f"host {host}, port {number}: {error}"
        raise InputError(message) from None

"""The TCP server of the control port."""

import asyncio
import json

from agent_economy.live.emulator.control import Controlled, reply
from agent_economy.live.emulator.ports import bound

MAX_REQUEST_BYTES = 65_536
"""A client that sends a longer line is disconnected."""


class ControlPort:
    """Answers each request line of each client with one line.

    Attributes:
        number: The number of its port.
    """

    def __init__(self, controlled: Controlled) -> None:
        """Create a server that does not listen yet."""
        self._controlled = controlled
        self._server: asyncio.Server | None = None
        self._writers: set[asyncio.StreamWriter] = set()
        self.number = 0

    async def listen(self, host: str, number: int) -> None:
        """Listen on a port; 0 is any free one.

        Raises:
            InputError: If the address cannot be used.
        """
        listening = bound(host, number)
        self.number = listening.getsockname()[1]
        self._server = await asyncio.start_server(
            self._serve, sock=listening, limit=MAX_REQUEST_BYTES
        )

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._writers.add(writer)
        try:
            while line := await reader.readline():
                answer = await reply(line, self._controlled)
                writer.write(json.dumps(answer).encode() + b"\n")
                await writer.drain()
        except (ConnectionError, ValueError, asyncio.CancelledError):
            # The client is gone, its line is too long, or the emulator ends: asyncio of Python 3.11
            # would report the last one as an error.
            pass
        finally:
            self._writers.discard(writer)
            writer.close()

    def close(self) -> None:
        """Stop listening and close all connections."""
        if self._server:
            self._server.close()
        for writer in self._writers:
            writer.transport.abort()

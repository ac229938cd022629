"""Looks up the address of a host, once at a time however many ports need it."""

import asyncio
import socket
from contextlib import suppress
from ipaddress import ip_address


class NameLookup:
    """The numeric address of one host.

    A lookup that takes long continues while connections time out and try again, so that it takes
    one thread, not one per attempt, and lookups of other hosts are not held up.
    """

    def __init__(self, host: str) -> None:
        """Create it without looking up anything."""
        self._host = host
        self._task: asyncio.Task[str] | None = None

    async def address(self) -> str:
        """Return the address.

        Raises:
            OSError: If the name is unknown.
        """
        with suppress(ValueError):
            return str(ip_address(self._host))
        if self._task is None or (self._task.done() and self._task.exception() is not None):
            self._task = asyncio.create_task(self._look_up())
        return await asyncio.shield(self._task)

    def forget(self) -> None:
        """Look up the name again the next time, because nothing answered at its address."""
        if self._task is not None and self._task.done():
            self._task = None

    async def _look_up(self) -> str:
        loop = asyncio.get_running_loop()
        found = await loop.getaddrinfo(self._host, None, type=socket.SOCK_STREAM)
        return str(found[0][4][0])

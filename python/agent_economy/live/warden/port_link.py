"""Keeps one port of a robot connected."""

import asyncio
import math
import os
from collections.abc import Callable, Sequence
from contextlib import suppress

from agent_economy.live.clock import now_s
from agent_economy.live.locks import AddressLocks, LockedError
from agent_economy.live.rules.faults import MAX_UNACKNOWLEDGED_S
from agent_economy.live.warden.connection import Connection
from agent_economy.live.warden.name_lookup import NameLookup

CONNECT_TIMEOUT_S = 2.0
ATTEMPT_S = 0.3
"""While nothing answers, another attempt is begun after this time. The system repeats the first
packet of an attempt after growing pauses only, so that a new one is answered sooner when the robot
can be reached again. The others continue: an answer may take longer than this."""

FIRST_PAUSE_S, MAX_PAUSE_S = 0.05, 0.4
"""Pauses before connecting again: short, because a robot without its motor port drives on until it
can be connected and stopped."""

STABLE_S = 1.0
"""After a connection that lasted for this time, the next pause is the first again."""

Address = tuple[str, int]


class PortLink:
    """Connects to an address, and again with growing pauses when the connection is lost.

    A connection on which nothing is acknowledged is replaced: it stays until another one has been
    established, and is then reset.

    Attributes:
        connection: The current connection; it may be down.
        has_connected: Whether it has ever been connected.
    """

    def __init__(
        self,
        address: Address,
        lookup: NameLookup,
        new: Callable[[], Connection],
        connected: Callable[[], None],
        locks: AddressLocks | None = None,
    ) -> None:
        """Wait for `run`.

        Args:
            address: The host and the port.
            lookup: Looks up the host.
            new: Makes a connection.
            connected: Is called after each connect.
            locks: Take the lock of the numeric address before each connect; None without a lock.
        """
        self._address, self._lookup, self._locks = address, lookup, locks
        self._new, self._connected = new, connected
        self.connection, self.has_connected = new(), False

    async def run(self) -> None:
        """Keep the port connected, until cancelled."""
        pause_s = FIRST_PAUSE_S
        while True:
            began_s = now_s()
            is_connected = await self._connect()
            if is_connected:
                await self.connection.lost.wait()
            # A robot that accepts and closes at once is not tried more often than one that refuses.
            pause_s = FIRST_PAUSE_S if is_connected and now_s() - began_s > STABLE_S else pause_s
            await asyncio.sleep(pause_s)
            pause_s = min(2 * pause_s, MAX_PAUSE_S)

    def unacknowledged_s(self, time_s: float) -> float:
        """Return for how long nothing has been acknowledged; let a silent connection be replaced.

        One on which everything is acknowledged after all is kept.
        """
        connection = self.connection
        waiting_s = connection.unacknowledged_s(time_s)
        if waiting_s >= MAX_UNACKNOWLEDGED_S:
            connection.lost.set()
        elif connection.is_up:
            connection.lost.clear()
        return waiting_s

    async def _connect(self) -> bool:
        """Connect; return False if the address refuses. While nothing answers, it tries on."""
        attempts: set[asyncio.Task[Connection | None]] = set()
        next_s = -math.inf
        try:
            while self.connection.lost.is_set() or not self.connection.is_up:
                if now_s() >= next_s:
                    next_s = now_s() + ATTEMPT_S
                    attempts.add(asyncio.create_task(self._attempt()))
                done, attempts = await _first_of(attempts, next_s - now_s())
                found = [each for task in done if (each := _connection_of(task)) is not None]
                if found:
                    self._replace(found)
                    return True
                for task in done:
                    task.result()
        except LockedError as error:
            self._lookup.forget()
            # In a thread: the name of a user may be looked up on a server.
            loop = asyncio.get_running_loop()
            self.connection.reason = await loop.run_in_executor(None, str, error)
            return False
        except (OSError, UnicodeError) as error:  # the latter: no name of a host, such as "a..b"
            self._refused(error)
            return False
        finally:
            for task in attempts:
                _give_up(task)
        return True

    def _refused(self, error: OSError | UnicodeError) -> None:
        """Note why an address cannot be connected.

        A robot that refuses can be reached. If it holds the connection on which nothing was
        acknowledged, it may take no other one: that one is reset.
        """
        if isinstance(error, ConnectionRefusedError):
            self.connection.reset()
        self._lookup.forget()
        host, port = self._address
        self.connection.reason = f"{host}:{port}: {_words(error)}"

    def _replace(self, found: Sequence[Connection]) -> None:
        """Take the first of new connections, and reset the others and the one before."""
        for each in (self.connection, *found[1:]):
            each.reset()
        self.connection, self.has_connected = found[0], True
        self._connected()

    async def _attempt(self) -> Connection | None:
        """Return a new connection; None if nothing has answered."""
        host, port = self._address
        new, numeric = self._new(), None
        try:
            async with asyncio.timeout(CONNECT_TIMEOUT_S):
                numeric = await self._lookup.address()
                if self._locks is not None:
                    # Of this address: the name may have had another one when the drive started.
                    self._locks.take([(numeric, port)])
                await asyncio.get_running_loop().create_connection(lambda: new, numeric, port)
        except TimeoutError:
            what = "no answer from" if numeric else "no answer to the lookup of the name of"
            self.connection.reason = f"{what} {host}:{port} within {CONNECT_TIMEOUT_S:g} s"
            self._lookup.forget()
            return None
        return new

    async def end(self) -> None:
        """Close the connection after what is queued has been sent."""
        self.connection.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(0.5):
                if self.connection.is_up:
                    await self.connection.closed.wait()
        self.connection.abort()


def _words(error: OSError | UnicodeError) -> str:
    if isinstance(error, UnicodeError):
        return str(error)
    # asyncio replaces the words of the system; those of name lookups have negative numbers.
    if error.errno is not None and error.errno > 0:
        return os.strerror(error.errno)
    return error.strerror or str(error)


async def _first_of(
    attempts: set[asyncio.Task[Connection | None]], timeout_s: float
) -> tuple[set[asyncio.Task[Connection | None]], set[asyncio.Task[Connection | None]]]:
    """Wait until an attempt has ended, or for a time; return those that have, and the others."""
    if not attempts:
        await asyncio.sleep(max(0.0, timeout_s))
        return set(), attempts
    wait = asyncio.FIRST_COMPLETED
    return await asyncio.wait(attempts, timeout=max(0.0, timeout_s), return_when=wait)


def _connection_of(task: asyncio.Task[Connection | None]) -> Connection | None:
    """Return the connection of an attempt; None if it has failed."""
    return None if task.exception() is not None else task.result()


def _give_up(task: asyncio.Task[Connection | None]) -> None:
    """End an attempt; a connection that has just been established is reset."""
    if not task.cancel() and not task.cancelled():
        connection = _connection_of(task)
        if connection is not None:
            connection.reset()

"""Locks on the addresses of robots, which keep two programs of a machine from driving one robot.

On Linux, a lock is an abstract socket: it holds for all users and environments that share the
network of the machine, and names its holder. Elsewhere it is a port of the loopback interface.

A lock is held for as long as any process has its socket. The warden sends a copy of each to the
loop, which holds them when the warden has ended.
"""

import errno
import os
import socket
from collections.abc import Sequence
from contextlib import suppress
from ipaddress import IPv6Address, ip_address
from pathlib import Path
from zlib import crc32

from agent_economy.live import local_socket
from agent_economy.live.local_socket import Peer

Address = tuple[str, int]

PREFIX = "agent-economy/robot"

BACKLOG = 1024
"""Programs that have been refused: each leaves a connection that is never accepted."""

FIRST_PORT, PORTS = 20_000, 10_000
"""Ports that are locks where there are no abstract sockets."""


class LockedError(Exception):
    """Another program drives a robot at this address."""

    def __init__(self, address: Address, holder: Peer | None = None, doubt: str = "") -> None:
        """Keep what is known; the words, which may take a lookup of a user, are made on demand.

        Args:
            address: The address.
            holder: The other program, if it is known.
            doubt: What else can be the cause, in words.
        """
        super().__init__(address, holder, doubt)
        self._address, self.holder, self._doubt = address, holder, doubt

    def __str__(self) -> str:
        """Return the reason in words."""
        host, port = self._address
        text = f"{host}:{port} is being driven by another"
        if self.holder is not None and self.holder.pid == os.getpid():
            return f"{text} robot of this fleet"
        holder = f" ({self.holder})" if self.holder else ""
        return f"{text} program{holder}{self._doubt}: end that one first"


class AddressLocks:
    """Holds locks on the addresses of one robot until closed, or until this process dies."""

    def __init__(self, backup: socket.socket | None = None) -> None:
        """Hold nothing; a copy of each lock is sent to another process through `backup`."""
        self._backup = backup
        self._sockets: dict[Address, socket.socket] = {}
        self._holders: dict[Address, Peer | None] = {}

    def holds(self, address: Address) -> bool:
        """Whether an address is locked here."""
        return _normal(address) in self._sockets

    def take(self, addresses: Sequence[Address]) -> None:
        """Lock all addresses, of which the hosts are numeric; those held already stay so.

        Raises:
            LockedError: If another program, or another robot of this one, has one of them.
            OSError: If the system has no socket left.
        """
        # In one order, so that of two programs that start at once one gets all.
        for address in sorted(set(map(_normal, addresses)) - set(self._sockets)):
            self._sockets[address] = lock = self._locked(address)
            if self._backup is not None:
                with suppress(OSError):  # it has ended
                    socket.send_fds(self._backup, [b"\0"], [lock.fileno()])

    def close(self) -> None:
        """Give up all locks."""
        for each in self._sockets.values():
            each.close()
        self._sockets.clear()

    def _locked(self, address: Address) -> socket.socket:
        name = f"{PREFIX}/{address[0]}:{address[1]}"
        if not local_socket.HAS_ABSTRACT:
            return _loopback(name, address)
        try:
            return local_socket.listen(name, BACKLOG)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise
        raise LockedError(address, self._holder(name, address))

    def _holder(self, name: str, address: Address) -> Peer | None:
        # A robot that is tried again and again must not fill the other program's backlog.
        known = self._holders.get(address)
        if known is None or not Path(f"/proc/{known.pid}").exists():
            known = self._holders[address] = local_socket.holder_of(name)
        return known


class InheritedLocks:
    """The copies of the locks of another process; they are held also before they are received."""

    def __init__(self, descriptor: int) -> None:
        """Hold what arrives at a socket, of which the descriptor was inherited."""
        self._source = socket.socket(fileno=descriptor)
        self._source.setblocking(False)  # noqa: FBT003
        self._source.set_inheritable(False)
        self._sockets: list[socket.socket] = []

    def take_over(self) -> None:
        """Become the process that messages name as the holder."""
        with suppress(OSError):  # there are no others
            while descriptors := socket.recv_fds(self._source, 1, 1)[1]:
                self._sockets += [socket.socket(fileno=each) for each in descriptors]
        for each in self._sockets:
            if local_socket.HAS_ABSTRACT:
                with suppress(OSError):
                    each.listen(BACKLOG)

    def close(self) -> None:
        """Give up all locks."""
        for each in (self._source, *self._sockets):
            each.close()


def _loopback(name: str, address: Address) -> socket.socket:
    number = FIRST_PORT + crc32(name.encode()) % PORTS
    lock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        lock.bind(("127.0.0.1", number))
    except OSError as error:
        lock.close()
        if error.errno not in (errno.EADDRINUSE, errno.EACCES):
            raise
        doubt = f", or one has UDP port {number} of 127.0.0.1"
        raise LockedError(address, None, doubt) from None
    return lock


def _normal(address: Address) -> Address:
    """Return one host for all forms of an address: 10.0.0.1 is ::ffff:10.0.0.1 too."""
    host, port = address
    number = ip_address(host)
    if isinstance(number, IPv6Address):
        if number.ipv4_mapped is not None:
            return str(number.ipv4_mapped), port
        if number.scope_id is not None:
            return f"{IPv6Address(int(number))}%{_interface(number.scope_id)}", port
    return str(number), port


def _interface(scope: str) -> int | str:
    """Return the number of a network interface, which may be stated as its name."""
    try:
        return int(scope) if scope.isdecimal() else socket.if_nametoindex(scope)
    except OSError:
        return scope

"""Abstract sockets of Linux: programs of one machine meet there whatever their environment is.

Their names have no file: no other user can block one with a file of that name, no cleaning removes
it, and it vanishes with its process. Python closes sockets in programs that it starts.
"""

import re
import socket
import struct
import sys
from dataclasses import dataclass
from pathlib import Path

HAS_ABSTRACT = sys.platform == "linux"

BACKLOG = 16
"""Connections that wait. Few: a flood of them then delays others by milliseconds only."""

_CREDENTIALS = struct.Struct("iII")
_TIME = struct.Struct("ll")


@dataclass(frozen=True)
class Peer:
    """The program at the other end of a connection, as the system reports it.

    Attributes:
        pid: Its process; 0 if it is in another container.
        uid: Its user.
    """

    pid: int
    uid: int

    def __str__(self) -> str:
        """Return it in words."""
        process = f"process {self.pid}" if self.pid else "a process of another container"
        return f"{process} of user {user_name(self.uid)}"


def listen(name: str, backlog: int = BACKLOG) -> socket.socket:
    """Return a socket that listens at a name, without blocking; `backlog` connections may wait.

    Raises:
        OSError: With EADDRINUSE if another socket has the name.
    """
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        listening.setblocking(False)  # noqa: FBT003
        listening.bind(_address(name))
        listening.listen(backlog)
    except OSError:
        listening.close()
        raise
    return listening


def connect(name: str, timeout_s: float = 0.0) -> socket.socket:
    """Connect to a name; reads of the connection have the same timeout.

    Raises:
        OSError: If nothing listens there, or, with EAGAIN, if too many others wait there.
    """
    link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        if timeout_s > 0:
            # The timeout of Python would not wait for a place among those that wait; the system's
            # does, in order of arrival.
            limit = _TIME.pack(int(timeout_s), int(timeout_s % 1 * 1e6))
            link.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, limit)
            link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, limit)
        else:
            link.setblocking(False)  # noqa: FBT003
        link.connect(_address(name))
    except OSError:
        link.close()
        raise
    return link


def peer_of(link: socket.socket) -> Peer:
    """Return which program is at the other end of a connection; it cannot be forged."""
    assert sys.platform == "linux"  # noqa: S101  (for type checkers: only there is the option)
    data = link.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    pid, uid, _ = _CREDENTIALS.unpack(data)
    return Peer(pid, uid)


def holder_of(name: str) -> Peer | None:
    """Return which program listens at a name, without waiting; None if that is unknown."""
    try:
        with connect(name) as link:
            return peer_of(link)
    except OSError:
        return None


def names(pattern: str) -> list[str]:
    """Return the names of sockets of this machine that match a regular expression, each once.

    Any program can choose any name: only `peer_of` shows which program listens there.
    """
    try:
        table = Path("/proc/net/unix").read_bytes().decode("latin-1")
    except OSError:
        return []
    found = re.findall(rf"@({pattern})$", table, re.ASCII | re.MULTILINE)
    return list(dict.fromkeys(each if isinstance(each, str) else each[0] for each in found))


def user_name(uid: int) -> str:
    """Return the name of a user, or the number if it has none. It may query a server of names."""
    import pwd  # noqa: PLC0415  (only systems with users by number have it)

    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)


def _address(name: str) -> str:
    return f"\0{name}"

"""Finds the abstract sockets of drives, and receives their entries.

Apart from what listens there: `stop` must not take the time to load it.
"""

import re
import secrets
import socket
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic

from agent_economy.live import local_socket
from agent_economy.live.discovery.running_drive import RunningDrive, drive_of, received
from agent_economy.live.local_socket import Peer

PREFIX = "agent-economy/drive"

ANSWER_S = 1.0
"""Time within which a drive that runs sends its entry."""

_NAME = re.compile(rf"{PREFIX}/([0-9]{{1,10}})/([0-9]{{1,10}})-[0-9a-f]{{32}}")


@dataclass(frozen=True)
class NamedSocket:
    """The name of a socket that may be that of a drive: any program can choose any name.

    Attributes:
        name: The name.
        uid: The user that it names: in a container, users may have other numbers than outside.
        pid: The process that it names, which may have another number too.
    """

    name: str
    uid: int
    pid: int


@dataclass(frozen=True)
class Contact:
    """A program that listens at the name of a drive.

    Attributes:
        peer: The program; None if no connection is possible, as when too many wait there.
        link: The connection; it has yet to be read.
    """

    peer: Peer | None
    link: socket.socket | None


def new_name(uid: int, pid: int) -> str:
    """Return a name for the socket of a drive.

    The user and the process are for messages; the random part keeps others from having it first.
    """
    return f"{PREFIX}/{uid}/{pid}-{secrets.token_hex(16)}"


def named_sockets() -> list[NamedSocket]:
    """Return all sockets of this machine with a name that a drive has."""
    if not local_socket.HAS_ABSTRACT:
        return []
    found = []
    for name in local_socket.names(_NAME.pattern.replace("(", "(?:")):
        match = _NAME.fullmatch(name)
        if match is not None:
            found.append(NamedSocket(name, int(match[1]), int(match[2])))
    return found


def contact(named: NamedSocket, timeout_s: float) -> Contact | None:
    """Connect to what may be a drive; None if nothing listens there."""
    try:
        link = local_socket.connect(named.name, timeout_s)
    except ConnectionRefusedError:
        return None
    except OSError:
        return Contact(None, None)
    try:
        return Contact(local_socket.peer_of(link), link)
    except OSError:
        link.close()
        return None


def entry_of(link: socket.socket) -> RunningDrive | None:
    """Return what a drive sends, and close the connection; None if it sends no entry in time."""
    with link, suppress(OSError):
        return drive_of(received(link, monotonic() + ANSWER_S))
    return None

"""The abstract socket of a drive, through which programs of its user receive its port and token.

Linux only. The name has the user and the process, for messages, and a random part, so that no other
program can have it first. It does not depend on the environment, and nothing can remove it.
"""

import asyncio
import os
import re
import secrets
import socket
from contextlib import suppress
from dataclasses import dataclass
from time import monotonic

from agent_economy.live import local_socket
from agent_economy.live.discovery.running_drive import MAX_BYTES, RunningDrive, drive_of
from agent_economy.live.local_socket import Peer

PREFIX = "agent-economy/drive"

BATCH, PAUSE_S = 16, 0.01
"""Connections that are served at once, and the pause after them: a flood must not hold up turns."""

ANSWER_S = 1.0
"""Time within which a drive that runs sends its entry."""

_NAME = re.compile(rf"{PREFIX}/([0-9]{{1,10}})/([0-9]{{1,10}})-[0-9a-f]{{32}}")


class EntrySocket:
    """Sends the entry of a drive to each program of its user, or of root, that connects."""

    def __init__(self, drive: RunningDrive) -> None:
        """Create it without listening."""
        self._entry = drive.encoded()
        self._readers = (os.geteuid(), 0)
        self._name = f"{PREFIX}/{os.geteuid()}/{drive.pid}-{secrets.token_hex(16)}"
        self._socket: socket.socket | None = None
        self._pause: asyncio.TimerHandle | None = None

    def start(self) -> None:
        """Listen; must be called in the event loop."""
        self._socket = local_socket.listen(self._name)
        self._resume()

    def close(self) -> None:
        """Listen no more."""
        if self._socket is None:
            return
        if self._pause is not None:
            self._pause.cancel()
        asyncio.get_running_loop().remove_reader(self._socket)
        self._socket.close()
        self._socket = None

    def _resume(self) -> None:
        if self._socket is not None:
            asyncio.get_running_loop().add_reader(self._socket, self._serve, self._socket)

    def _serve(self, listening: socket.socket) -> None:
        try:
            for _ in range(BATCH):
                link, _address = listening.accept()
                with link:
                    self._send(link)
        except BlockingIOError:
            return
        except OSError:  # no descriptor is left
            pass
        loop = asyncio.get_running_loop()
        loop.remove_reader(listening)
        self._pause = loop.call_later(PAUSE_S, self._resume)

    def _send(self, link: socket.socket) -> None:
        link.setblocking(False)  # noqa: FBT003
        # An entry is shorter than what the system queues for a connection.
        with suppress(OSError):
            if local_socket.peer_of(link).uid in self._readers:
                link.send(self._entry)


@dataclass(frozen=True)
class NamedSocket:
    """The name of a socket that may be that of a drive: any program can choose any name.

    Attributes:
        name: The name.
        uid: The user that it names.
        pid: The process that it names.
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
    """Connect to a drive; None if there is none, or a program of another user than it names."""
    try:
        link = local_socket.connect(named.name, timeout_s)
    except ConnectionRefusedError:
        return None
    except OSError:
        return Contact(None, None)
    try:
        peer = local_socket.peer_of(link)
    except OSError:
        link.close()
        return None
    if peer.uid != named.uid:
        link.close()
        return None
    return Contact(peer, link)


def entry_of(link: socket.socket) -> RunningDrive | None:
    """Return what a drive sends, and close the connection; None if it sends no entry in time."""
    data, until_s = b"", monotonic() + ANSWER_S
    with link, suppress(OSError):
        while len(data) < MAX_BYTES and (left_s := until_s - monotonic()) > 0:
            link.settimeout(left_s)
            received = link.recv(MAX_BYTES - len(data))
            if not received:
                break
            data += received
    return drive_of(data)

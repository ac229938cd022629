"""The abstract socket of a drive, through which programs of its user receive its port and token.

Linux only. It does not depend on the environment, and nothing can remove it.
"""

import asyncio
import os
import socket
from contextlib import suppress

from agent_economy.live import local_socket
from agent_economy.live.discovery.contact import new_name
from agent_economy.live.discovery.running_drive import RunningDrive

BATCH, PAUSE_S = 16, 0.01
"""Connections that are served at once, and the pause after them: a flood must not hold up turns."""


class EntrySocket:
    """Sends the entry of a drive to each program of its user, or of root, that connects."""

    def __init__(self, drive: RunningDrive) -> None:
        """Create it without listening."""
        self._entry = drive.encoded()
        self._readers = (os.geteuid(), 0)
        self._name = new_name(os.geteuid(), drive.pid)
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

"""The child process that runs the brains, as the warden sees it."""

import asyncio
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from agent_economy.live.channel import Decoder, Message, encode

MAX_QUEUE_BYTES = 2**22
"""A loop that leaves more than this unread is dead; nothing more is queued for it."""

END_S = 5.0
"""Time that it has to close the recording."""


class LoopProcess:
    """Starts the loop, and exchanges messages with it without ever waiting for it.

    It is started by exec, so that it holds no socket of the warden except copies of its locks, and
    in a session of its own, so that Ctrl-C, Ctrl-Z and a closed terminal reach the warden alone.

    Attributes:
        backup: Where copies of locks are sent, which the loop holds; None before the start.
        has_ended: Whether it has ended or was closed.
    """

    def __init__(self, received: Callable[[dict[str, Any]], None]) -> None:
        """Create it without starting; `received` is called with each message."""
        self.has_ended = False
        self.backup: socket.socket | None = None
        self._received, self._decoder = received, Decoder()
        self._queue = bytearray()
        self._is_writing = False
        self._process: subprocess.Popen[bytes] | None = None

    def start(self, arguments: Sequence[str]) -> None:
        """Start it; must be called in the event loop."""
        self.backup, inherited = socket.socketpair()
        self.backup.setblocking(False)  # noqa: FBT003
        locks = ["--locks", str(inherited.fileno())]
        command = [sys.executable, "-m", "agent_economy.live.loop", *arguments, *locks]
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if sys.stderr is None else None,  # closed by its parent
            start_new_session=True,
            pass_fds=(inherited.fileno(),),
        )
        inherited.close()
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None  # noqa: S101  (both are pipes)
            os.set_blocking(stream.fileno(), False)
        asyncio.get_running_loop().add_reader(self._stdout, self._read)

    @property
    def returncode(self) -> int | None:
        """Its exit code; None while it runs."""
        return self._process.poll() if self._process else None

    @property
    def pid(self) -> int | None:
        """Its process id."""
        return self._process.pid if self._process else None

    def send(self, *messages: Message) -> bool:
        """Send messages, or queue them; return whether they were: all of them, or none.

        Nothing more is queued for a loop that does not read.
        """
        is_taken = not self.has_ended and len(self._queue) < MAX_QUEUE_BYTES
        if is_taken:
            self._queue += b"".join(map(encode, messages))
            self._write()
        return is_taken

    async def end(self, *, is_cancelled: bool = False) -> int | None:
        """Let it close the recording and end, or kill it; return its exit code.

        The recording of a drive that is cancelled before it began is removed.
        """
        self.send({"type": "cancel" if is_cancelled else "end"})
        with suppress(TimeoutError):
            async with asyncio.timeout(END_S):
                while self.returncode is None:
                    await asyncio.sleep(0.02)
        if self.returncode is None:
            self.kill()
        self._close()
        return self.returncode

    def kill(self) -> None:
        """End it at once."""
        if self._process is not None and self._process.poll() is None:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()

    @property
    def _stdin(self) -> int:
        assert self._process and self._process.stdin  # noqa: S101, PT018
        return self._process.stdin.fileno()

    @property
    def _stdout(self) -> int:
        assert self._process and self._process.stdout  # noqa: S101, PT018
        return self._process.stdout.fileno()

    def _read(self) -> None:
        try:
            data = os.read(self._stdout, 2**16)
        except BlockingIOError:
            return
        if not data:
            self._close()
            self._received({"type": "ended"})
            return
        for message in self._decoder.feed(data):
            self._received(message)

    def _write(self) -> None:
        try:
            while self._queue:
                del self._queue[: os.write(self._stdin, self._queue)]
        except BlockingIOError:
            self._wait_to_write()
            return
        except OSError:
            self._close()
            return
        if self._is_writing:
            asyncio.get_running_loop().remove_writer(self._stdin)
            self._is_writing = False

    def _wait_to_write(self) -> None:
        if not self._is_writing:
            asyncio.get_running_loop().add_writer(self._stdin, self._write)
            self._is_writing = True

    def _close(self) -> None:
        if self.has_ended or self._process is None:
            return
        self.has_ended = True
        loop = asyncio.get_running_loop()
        loop.remove_reader(self._stdout)
        loop.remove_writer(self._stdin)
        for stream in (self._process.stdin, self._process.stdout, self.backup):
            with suppress(OSError):
                if stream is not None:
                    stream.close()

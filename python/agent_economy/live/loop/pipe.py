"""The loop's end of the pipes to the warden."""

import os
import select
import sys
from collections.abc import Iterator
from typing import Any

from agent_economy.live.channel import SILENCE_S, Decoder, Message, encode
from agent_economy.live.clock import now_s

MAX_READS = 1000
"""Reads after a tick is due before it is taken all the same: a flood of lines must not hold the
brains up, nor have them step early."""


class WardenLostError(Exception):
    """The warden has ended, or has been silent for too long."""


class Pipe:
    """Receives from and sends to the warden, and notices when it is gone.

    Setpoints expire, so that one that does not fit into the pipe can be dropped.
    """

    def __init__(self) -> None:
        """Take over the standard streams; everything printed goes to standard error from now on."""
        self._input, self._output = os.dup(sys.stdin.fileno()), os.dup(sys.stdout.fileno())
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
        self._decoder, self._unsent = Decoder(), b""
        self._heard_s = self._looked_s = now_s()
        self._is_watching = False

    def watch(self) -> None:
        """Regard the warden as lost when it is silent; nothing sent blocks any more.

        Its silence counts from its first message on: before, it looks up the names of robots, and
        none of them is connected.
        """
        os.set_blocking(self._input, False)
        os.set_blocking(self._output, False)
        self._heard_s = self._looked_s = now_s()

    def send(self, message: Message) -> bool:
        """Send a message; return whether it was sent, and not dropped because the pipe is full.

        Raises:
            WardenLostError: If the warden has closed the pipe.
        """
        self._flush()
        if self._unsent:
            return False
        self._unsent = data = encode(message)
        self._flush()
        if len(self._unsent) < len(data):
            return True  # The rest of a long message follows.
        self._unsent = b""
        return False

    def _flush(self) -> None:
        try:
            while self._unsent:
                self._unsent = self._unsent[os.write(self._output, self._unsent) :]
        except BlockingIOError:
            pass
        except OSError as error:
            raise WardenLostError from error

    def receive_until(self, until_s: float) -> Iterator[dict[str, Any]]:
        """Yield all messages that arrive until a time, which may be past.

        Raises:
            WardenLostError: If the warden has ended, or has been silent for too long.
        """
        reads = 0
        while reads < MAX_READS:
            self._flush()
            wait_s = max(0.0, min(until_s - now_s(), SILENCE_S / 3))
            is_readable = bool(select.select([self._input], [], [], wait_s)[0])
            now = now_s()
            if now - self._looked_s > SILENCE_S:
                self._heard_s = now  # this process was suspended or busy: judge after reading
            self._looked_s = now
            reads += now >= until_s
            if is_readable:
                yield from self._read()
            elif self._is_watching and now - self._heard_s > SILENCE_S:
                raise WardenLostError
            elif now >= until_s:
                return

    def _read(self) -> Iterator[dict[str, Any]]:
        try:
            data = os.read(self._input, 2**16)
        except BlockingIOError:
            return
        if not data:
            raise WardenLostError
        self._heard_s, self._is_watching = now_s(), True
        yield from self._decoder.feed(data)

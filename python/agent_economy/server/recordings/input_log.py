"""The inputs of all steps of a live run, on disk: they are needed in order only."""

import struct
import threading
from collections.abc import Mapping
from typing import Any

import msgspec

from agent_economy.spool import Spool

BLOCK_BYTES = 2**16
LENGTH = struct.Struct("<I")
"""Precedes each entry."""

Inputs = Mapping[str, Any]


class InputLog:
    """Inputs by tick, which one thread adds and others read."""

    def __init__(self) -> None:
        """Begin without inputs."""
        self._spool = Spool()
        self._last = bytearray()
        self._lock = threading.Lock()

    def append(self, tick: int, inputs: Inputs) -> None:
        """Add the inputs of a step; its tick is greater than those before."""
        entry = msgspec.msgpack.encode((tick, inputs))
        with self._lock:
            self._last += LENGTH.pack(len(entry)) + entry
            if len(self._last) >= BLOCK_BYTES:
                self._spool.append(bytes(self._last))
                self._last.clear()

    def after(self, block: int, offset: int) -> tuple[bytes, bool]:
        """Return what is in a block after an offset, and whether the block is complete."""
        with self._lock:
            if block == len(self._spool):
                return bytes(self._last[offset:]), False
        return self._spool[block][offset:], True


class InputReader:
    """Reads a log from its beginning, by ticks that never decrease."""

    def __init__(self, log: InputLog) -> None:
        """Begin before the first inputs."""
        self._log = log
        self._block = self._offset = 0
        self._data, self._is_complete = memoryview(b""), False
        self._next: tuple[int, dict[str, Any]] | None = None

    def get(self, tick: int, default: Inputs, /) -> Inputs:
        """Return the inputs of a step, or the default if it has none."""
        while self._next is None or self._next[0] < tick:
            self._next = self._read()
            if self._next is None:
                return default
        at, inputs = self._next
        return inputs if at == tick else default

    def _read(self) -> tuple[int, dict[str, Any]] | None:
        """Return the next entry; None if there is none yet."""
        while not self._data:
            if self._is_complete:
                self._block, self._offset = self._block + 1, 0
            data, self._is_complete = self._log.after(self._block, self._offset)
            self._data = memoryview(data)
            if not data and not self._is_complete:
                return None
        end = LENGTH.size + LENGTH.unpack_from(self._data)[0]
        entry: tuple[int, dict[str, Any]]
        entry = msgspec.msgpack.decode(
            self._data[LENGTH.size : end], type=tuple[int, dict[str, Any]]
        )
        self._data, self._offset = self._data[end:], self._offset + end
        return entry

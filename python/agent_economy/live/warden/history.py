"""All that was ever sent to the server of the page, so that a new one can take the run again."""

from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from threading import Thread

from agent_economy.spool import Spool

BLOCK_BYTES = 2**16


class History:
    """Blocks of bytes on disk, which a thread writes and reads: the warden never waits for a disk.

    Only the last block is in memory, and those that wait for the thread.
    """

    def __init__(self, loaded: Callable[[], None]) -> None:
        """Start empty; `loaded` is called in the thread, when a block has been read."""
        self._notify = loaded
        self._spool = Spool()
        self._complete = 0
        self._last = bytearray()
        self._unwritten: dict[int, bytes] = {}
        self._read: dict[int, bytes] = {}
        self._requested = -1
        self._work: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._thread = Thread(target=self._run, daemon=True)

    def add(self, data: bytes) -> None:
        """Add bytes."""
        self._last += data
        if len(self._last) >= BLOCK_BYTES:
            number, self._complete = self._complete, self._complete + 1
            self._unwritten[number] = bytes(self._last)
            self._last.clear()
            self._order(lambda: self._write(number))

    def block(self, number: int) -> tuple[bytes, bool] | None:
        """Return a block, and whether it is complete; None if it has to be read first."""
        if number == self._complete:
            return bytes(self._last), False
        data = self._unwritten.get(number) or self._read.get(number)
        if data is not None:
            return data, True
        if self._requested != number:
            self._requested = number
            self._order(lambda: self._load(number))
        return None

    def close(self) -> None:
        """End the thread."""
        self._work.put(None)

    def _order(self, work: Callable[[], None]) -> None:
        if self._thread.ident is None:
            self._thread.start()
        self._work.put(work)

    # In the thread.

    def _run(self) -> None:
        while (work := self._work.get()) is not None:
            with suppress(OSError):  # a block that cannot be read is missing in the page only
                work()

    def _write(self, number: int) -> None:
        self._spool.append(self._unwritten[number])
        del self._unwritten[number]

    def _load(self, number: int) -> None:
        self._read = {number: self._spool[number]}
        self._notify()

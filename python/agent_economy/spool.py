"""Blocks of bytes that are kept on disk, because a drive takes hours."""

import os
import zlib
from array import array
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

ON_DISK = Path("/var/tmp")  # noqa: S108  (for files without a name)
"""Unlike /tmp, never in memory."""


class Spool:
    """Compressed blocks in a file without a name; in memory from the first that the disk refuses.

    One thread may append while others read.
    """

    def __init__(self) -> None:
        """Begin without blocks."""
        self._file: IO[bytes] | None = None
        self._ends = array("Q", [0])
        self._rest: list[bytes] = []

    def __len__(self) -> int:
        """Return the number of blocks."""
        return len(self._ends) - 1 + len(self._rest)

    def __getitem__(self, number: int) -> bytes:
        """Return a block."""
        on_disk = len(self._ends) - 1
        if number >= on_disk:
            return zlib.decompress(self._rest[number - on_disk])
        begin, end = self._ends[number], self._ends[number + 1]
        assert self._file is not None  # noqa: S101  (something is in it)
        return zlib.decompress(os.pread(self._file.fileno(), end - begin, begin))

    def append(self, block: bytes) -> None:
        """Add a block."""
        data = zlib.compress(block, 1)
        if self._rest or not self._is_written(data):
            self._rest.append(data)

    def _is_written(self, data: bytes) -> bool:
        """Write a block behind the others; return whether the disk has taken it."""
        at = self._ends[-1]
        try:
            self._file = self._file or file_without_name()
            while data:
                written = os.pwrite(self._file.fileno(), data, at)
                data, at = data[written:], at + written
        except OSError:
            return False
        self._ends.append(at)
        return True


def file_without_name() -> IO[bytes]:
    """Open a file that only this user can read, and that ends with the process.

    Raises:
        OSError: If there is no folder for it.
    """
    is_usual = "TMPDIR" in os.environ or not os.access(ON_DISK, os.W_OK)
    return TemporaryFile(dir=None if is_usual else ON_DISK)

"""Files that are being written, and those that terminated processes have left behind."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO
from uuid import uuid4

try:
    import fcntl
except ImportError:  # Without file locks, files that are being written cannot be identified.
    fcntl = None  # type: ignore[assignment]

PREFIX = ".unfinished-"
"""Prefix of the names of files until they are complete; hidden files are never listed."""


@contextmanager
def temporary_file(folder: Path, suffix: str) -> Iterator[Path]:
    """Create a file, and remove it on exit unless it was renamed."""
    file, lock = locked_file(folder, suffix)
    try:
        yield file
    finally:
        lock.close()
        with suppress(OSError):
            file.unlink(missing_ok=True)


def locked_file(folder: Path, suffix: str) -> tuple[Path, IO[bytes]]:
    """Return a new file, and what locks it until it is closed or the process ends."""
    while True:
        file = folder / f"{PREFIX}{uuid4().hex}{suffix}"
        stream = file.open("xb")
        if fcntl is None:
            stream.close()  # Such systems cannot rename an open file.
            return file, stream
        with suppress(OSError):  # Some file systems have no locks.
            fcntl.flock(stream, fcntl.LOCK_EX)
        # Another process may have cleaned the folder between the two calls.
        if os.fstat(stream.fileno()).st_nlink:
            return file, stream
        stream.close()


def remove_abandoned(folder: Path, suffix: str) -> None:
    """Remove the temporary files of processes that were killed."""
    if fcntl is None:
        return
    for file in folder.glob(f"{PREFIX}*{suffix}"):
        with suppress(OSError):  # The file is locked, or has been removed meanwhile.
            if file.is_file() and not file.is_symlink():
                with file.open("rb") as stream:
                    fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    file.unlink()

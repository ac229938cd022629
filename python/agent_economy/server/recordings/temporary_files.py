"""Files on their way, and what killed processes left of such."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO
from uuid import uuid4

try:
    import fcntl
except ImportError:  # not of this system: nobody can tell which files are still written
    fcntl = None  # type: ignore[assignment]

BEGINNING = ".unfinished-"
"""Of the names of files until they are whole; hidden ones are never listed."""


@contextmanager
def unfinished(folder: Path, ending: str) -> Iterator[Path]:
    """Give a new file, and remove it in the end, unless it has another name then."""
    file, held = claimed(folder, ending)
    try:
        yield file
    finally:
        held.close()
        with suppress(OSError):
            file.unlink(missing_ok=True)


def claimed(folder: Path, ending: str) -> tuple[Path, IO[bytes]]:
    """Return a new file, and what holds it until it is closed or the process ends."""
    while True:
        file = folder / f"{BEGINNING}{uuid4().hex}{ending}"
        stream = file.open("xb")
        if fcntl is None:
            stream.close()  # what is open cannot be given another name there
            return file, stream
        with suppress(OSError):  # there are disks on which nothing can be held
            fcntl.flock(stream, fcntl.LOCK_EX)
        # Whoever clears the folder may have come between the two.
        if os.fstat(stream.fileno()).st_nlink:
            return file, stream
        stream.close()


def clear(folder: Path, ending: str) -> None:
    """Remove files that nobody writes any more, as whoever did so was killed."""
    if fcntl is None:
        return
    for file in folder.glob(f"{BEGINNING}*{ending}"):
        with suppress(OSError):  # someone holds it, or it has gone meanwhile
            if file.is_file() and not file.is_symlink():
                with file.open("rb") as stream:
                    fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    file.unlink()

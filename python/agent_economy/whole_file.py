"""Writes files that appear whole or not at all, also if several programs write one file.

A file is written under a name of its own in the folder of its final name, synced and renamed. The
last to be renamed stays; what reads it meanwhile reads one file or the other. A program that is
killed leaves its unfinished file, which is locked while it is written: `remove_abandoned` removes
only those that no program writes.
"""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BufferedWriter
from pathlib import Path
from uuid import uuid4

try:
    import fcntl
except ImportError:  # Without file locks, files that are being written cannot be identified.
    fcntl = None  # type: ignore[assignment]

PREFIX = ".unfinished-"
"""Prefix of the names of files until they are complete; hidden files are never listed."""


def write_whole(path: Path, data: bytes | memoryview) -> None:
    """Write a file, which is on the disk on return.

    A symbolic link stays, and its target is written. The permissions are those of a new file.

    Raises:
        OSError: If it cannot be written; then an existing file is as before.
    """
    with replacing(path) as stream:
        stream.write(data)


@contextmanager
def replacing(path: Path) -> Iterator[BufferedWriter]:
    """Open a file for writing that takes its place when the block ends without an exception.

    Raises:
        OSError: As `write_whole`.
    """
    target = target_of(path)
    with temporary_file(target.parent) as stream:
        yield stream
        put_in_place(stream, target)


def check_writable(path: Path) -> None:
    """Check that a file can be written; none remains.

    Raises:
        OSError: If it cannot.
    """
    with temporary_file(target_of(path).parent):
        pass


def target_of(path: Path) -> Path:
    """Return the file that is written at a path: the target of a link, which may not exist yet.

    Raises:
        OSError: If links form a circle, or lead to what a file must not replace.
    """
    try:
        target = Path(os.path.realpath(path, strict=True))
    except FileNotFoundError:
        return Path(os.path.realpath(path))
    if not (target.is_file() or target.is_dir()):
        raise OSError(errno.EPERM, "it is a pipe or a device", str(path))
    return target


@contextmanager
def temporary_file(folder: Path, suffix: str = "") -> Iterator[BufferedWriter]:
    """Create a file with a name of its own, and remove it on exit unless it was renamed.

    Raises:
        OSError: If it cannot be created.
    """
    stream = locked_file(folder, suffix)
    try:
        yield stream
    finally:
        # What could not be written has been reported by `put_in_place`.
        with suppress(OSError):
            stream.close()
        with suppress(OSError):
            Path(stream.name).unlink(missing_ok=True)


def locked_file(folder: Path, suffix: str) -> BufferedWriter:
    """Return a new file, which is locked until it is closed or the process ends."""
    while True:
        stream = (folder / f"{PREFIX}{uuid4().hex}{suffix}").open("xb")
        has_lock(stream.fileno())
        # Another process may have cleaned the folder between the two calls.
        if os.fstat(stream.fileno()).st_nlink:
            return stream
        stream.close()


def put_in_place(stream: BufferedWriter, target: Path) -> None:
    """Give a temporary file its final name, once its content is on the disk.

    Raises:
        OSError: If it cannot be written or renamed.
    """
    stream.flush()
    os.fsync(stream.fileno())
    if fcntl is None:
        stream.close()  # Such systems cannot rename an open file.
    Path(stream.name).replace(target)
    sync_folder(target.parent)


def sync_folder(folder: Path) -> None:
    """Sync the file names of a folder to the disk."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def has_lock(descriptor: int) -> bool:
    """Lock an open file until it is closed; return whether no other program has locked it."""
    if fcntl is None:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        pass  # Some file systems have no locks.
    return True


def is_being_written(path: Path) -> bool:
    """Return whether a program has locked a file; for a moment, this locks it for writers too."""
    if fcntl is None or not path.is_file():
        return False
    try:
        with path.open("rb") as stream:
            fcntl.flock(stream, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # It has been removed meanwhile, or the file system has no locks.
        return False
    return False


def remove_abandoned(folder: Path, suffix: str = "") -> None:
    """Remove the unfinished files of programs that were killed, as far as this is allowed."""
    if fcntl is None:
        return
    for file in folder.glob(f"{PREFIX}*{suffix}"):
        with suppress(OSError):  # It has been removed meanwhile.
            if file.is_file() and not file.is_symlink():
                with file.open("rb") as stream:
                    fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    file.unlink()

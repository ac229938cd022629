"""Creates the files of recordings. The recording of a drive is never replaced.

A run can be computed again, a drive of a real robot cannot.
"""

import os
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import IO

from agent_economy._core import InputError
from agent_economy.recording.live_topics import LIVE
from agent_economy.regular_file import FLAGS, IrregularFileError
from agent_economy.whole_file import has_lock

MARK = len(LIVE).to_bytes(4, "little") + LIVE.encode()
"""The name of the metadata of a drive as in a file: MCAP never compresses metadata."""

BLOCK_BYTES = 2**20

PATIENCE_S = 0.2
"""A program that finds out whether a file is being written locks it for a moment."""


def create_new(path: Path, *, is_numbered: bool = False) -> Path:
    """Create an empty file for the recording of a drive, and return its path.

    Args:
        path: The file.
        is_numbered: Whether NAME-2, NAME-3 and so on are tried if it exists.

    Raises:
        InputError: If it exists, also as a folder, a pipe or a link, or cannot be created.
    """
    for number in count(1):
        each = path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")
        try:
            with write_errors(each):
                # Exclusive: two drives that begin at once do not get one file.
                os.close(os.open(each, os.O_WRONLY | os.O_CREAT | os.O_EXCL | FLAGS, 0o666))
        except FileExistsError:
            if not is_numbered:
                raise InputError(why_refused(each)) from None
        else:
            return each
    raise AssertionError  # The loop has no end.


def why_refused(path: Path) -> str:
    """Return why a drive does not record to what exists, and what to do."""
    what = "exists already"
    if path.is_symlink():
        what = "is a symbolic link"
    elif path.is_dir():
        what = "is a folder"
    return f"{path}: {what}: a drive never replaces a file: choose another name, or move it"


def open_replacing(path: Path) -> IO[bytes]:
    """Open the file of a recording; an existing one is emptied, unless it is of a drive.

    Raises:
        InputError: If it is the recording of a drive or a pipe, or cannot be written.
    """
    with write_errors(path):
        if path.exists():  # A pipe is not even opened: its reader would find it closed again.
            check_no_pipe(path, path.stat().st_mode)
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | FLAGS, 0o666)
        try:
            make_empty(path, descriptor)
            return os.fdopen(descriptor, "wb")
        except BaseException:
            os.close(descriptor)
            raise


def make_empty(path: Path, descriptor: int) -> None:
    """Empty an open file, unless it must not be replaced; a device stays as it is.

    Raises:
        InputError: If it is the recording of a drive, or being written.
        OSError: If it is a pipe, or cannot be read or emptied.
    """
    mode = os.fstat(descriptor).st_mode
    check_no_pipe(path, mode)
    if stat.S_ISREG(mode):
        exclude_others(path, descriptor)
        refuse_drive(path, descriptor)
        os.ftruncate(descriptor, 0)


def exclude_others(path: Path, descriptor: int) -> None:
    """Exclude other writers of an open file until it is closed.

    A recording and a log can be read while they are written, so they are written in their place.

    Raises:
        InputError: If it is being written.
    """
    end_s = time.monotonic() + PATIENCE_S
    while not has_lock(descriptor):
        if time.monotonic() > end_s:
            message = (
                f"{path}: is being written, by another program or by a recording that was not "
                "closed: wait until it ends, or choose another name"
            )
            raise InputError(message)
        time.sleep(PATIENCE_S / 10)


def check_no_pipe(path: Path, mode: int) -> None:
    """Check that a file is not a pipe: a recording contains its own places.

    Raises:
        OSError: If it is.
    """
    if stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode):
        raise IrregularFileError(0, "it is a pipe: choose a file", str(path))


def refuse_drive(path: Path, descriptor: int) -> None:
    """Refuse an open file that is the recording of a drive.

    Raises:
        InputError: If it is.
    """
    if has_mark(descriptor):
        message = (
            f"{path}: is the recording of a drive, which is never replaced because a drive cannot "
            "be computed again: choose another name, or move or delete the file"
        )
        raise InputError(message)


def check_no_drive(path: Path) -> None:
    """Check that a file that is to be replaced is not the recording of a drive, if it exists.

    Raises:
        InputError: If it is.
    """
    if path.is_file():
        with write_errors(path), path.open("rb") as stream:
            refuse_drive(path, stream.fileno())


@contextmanager
def write_errors(path: Path) -> Iterator[None]:
    """Convert errors of creating a file, except that it exists.

    Raises:
        InputError: If there is such an error.
    """
    try:
        yield
    except FileExistsError:
        raise
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        message = f"{path}: cannot be written: {getattr(error, 'strerror', None) or error}"
        raise InputError(message) from None


def has_mark(descriptor: int) -> bool:
    """Return whether an open file is the recording of a drive, however damaged it is."""
    os.lseek(descriptor, 0, os.SEEK_SET)
    rest = b""
    while block := os.read(descriptor, BLOCK_BYTES):
        if MARK in rest + block:
            return True
        rest = block[-len(MARK) :]
    os.lseek(descriptor, 0, os.SEEK_SET)
    return False

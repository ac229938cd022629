"""Opens files that users name: regular ones only, since a pipe or a device may block for ever."""

import errno
import os
import stat
from pathlib import Path
from typing import IO

IRREGULAR = "it is a pipe or a device; save its output to a file and pass that"

FLAGS = sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_CLOEXEC", "O_BINARY"))
"""Flags of `os.open`: without O_NONBLOCK, opening a pipe waits for its other end."""


class IrregularFileError(OSError):
    """The path is a pipe, a socket or a device."""


def open_regular(path: Path) -> IO[bytes]:
    """Open a regular file for reading.

    Raises:
        IrregularFileError: If it is a pipe, a socket or a device.
        OSError: If it cannot be opened, also if no file can have this name.
    """
    return os.fdopen(descriptor_of(path, os.O_RDONLY), "rb")


def descriptor_of(path: Path, flags: int) -> int:
    """Return the descriptor of a regular file, opened with some flags of `os.open`.

    Raises:
        IrregularFileError: If it is a pipe, a socket or a device.
        OSError: If it cannot be opened, also if no file can have this name.
    """
    # A pipe is not even opened: closing it again would end the program that writes to it.
    check_regular(path)
    try:
        descriptor = os.open(path, flags | FLAGS, 0o666)
    except ValueError as error:
        raise OSError(errno.EILSEQ, str(error), str(path)) from None
    try:
        # Another program may have replaced the file after the first check.
        check_kind(path, os.fstat(descriptor).st_mode)
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


def check_regular(path: Path) -> None:
    """Refuse what exists and is not a regular file.

    Raises:
        IrregularFileError: If it is a pipe, a socket or a device.
        IsADirectoryError: If it is a folder.
    """
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return  # What opens the file reports it.
    check_kind(path, mode)


def check_kind(path: Path, mode: int) -> None:
    """Refuse the mode of what is not a regular file.

    Raises:
        IrregularFileError: If it is a pipe, a socket or a device.
        IsADirectoryError: If it is a folder.
    """
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise IrregularFileError(errno.EPERM, IRREGULAR, str(path))

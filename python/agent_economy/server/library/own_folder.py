"""The hidden folder of the library in the server's folder: its lock, and what was deleted."""

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from agent_economy._core import InputError
from agent_economy.regular_file import descriptor_of
from agent_economy.scenario.validation import check
from agent_economy.server.workspace import OUTSIDE, Workspace

NAME = ".agent-economy"
LOCK = "library.lock"

WAIT_S = 10.0
"""Maximum time that another server of the folder is waited for; changes take milliseconds."""

RETRY_S = 0.01


def own_folder(workspace: Workspace) -> Path:
    """Return the folder, which is created.

    Raises:
        InputError: If it is a link that leads out of the server's folder, or cannot be created.
    """
    folder = workspace.folder / NAME
    check(workspace.has(folder), "folder", NAME, f"a folder here, and {OUTSIDE}")
    with disk_errors(NAME):
        folder.mkdir(exist_ok=True)
    return folder


@contextmanager
def locked(workspace: Workspace) -> Iterator[Path]:
    """Let no other server of this folder change the library; yield the hidden folder.

    Raises:
        InputError: If another one does not finish, or the lock cannot be opened.
    """
    folder = own_folder(workspace)
    check(workspace.has(folder / LOCK), "lock", f"{NAME}/{LOCK}", f"a file here, and {OUTSIDE}")
    with disk_errors(f"{NAME}/{LOCK}"):
        descriptor = descriptor_of(folder / LOCK, os.O_RDWR | os.O_CREAT)
    try:
        with disk_errors(f"{NAME}/{LOCK}"):
            wait_for(descriptor)
        yield folder
    finally:
        os.close(descriptor)


def wait_for(descriptor: int) -> None:
    """Lock an open file once no other program has locked it.

    Raises:
        InputError: If one keeps it locked.
        OSError: If it cannot be locked.
    """
    until_s = time.monotonic() + WAIT_S
    while True:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > until_s:
                message = "another server of this folder is changing the library: try again"
                raise InputError(message) from None
            time.sleep(RETRY_S)
        else:
            return


@contextmanager
def disk_errors(name: str) -> Iterator[None]:
    """Name an entry in the errors of the disk.

    Raises:
        InputError: For an OSError.
    """
    try:
        yield
    except OSError as error:
        message = f"{name}: cannot be changed: {error.strerror or error}"
        raise InputError(message) from None

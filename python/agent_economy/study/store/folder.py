"""A study's folder: its lock, files that are written atomically, and errors with paths."""

import fcntl
import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from agent_economy._core import InputError
from agent_economy.regular_file import IrregularFileError, descriptor_of, open_regular
from agent_economy.scenario import validation
from agent_economy.study.errors import StoreError
from agent_economy.study.store.differences import differences
from agent_economy.whole_file import remove_abandoned, sync_folder
from agent_economy.whole_file import write_whole as write_atomically

QUESTION = "study.toml"
BLOCKS = "blocks"
FILES = "files"
LEDGER = "ledger.sqlite"
STAGING = "staging.runs"
LOCK = ".lock"
ANSWER = "answer.json"
REPORT = "report.html"
MAX_BYTES = 2**30
"""Maximum size of a file; blocks, answers and maps are smaller."""

ATTEMPTS = 5
RETRY_S = 0.02
"""Attempts at locking a folder, and the pause between two."""


@contextmanager
def disk_errors(
    path: Path, action: str = "written", error_type: type[InputError] = StoreError
) -> Iterator[None]:
    """Turn errors of the disk and of SQLite into ones that name the path and the reason.

    Raises:
        InputError: For an OSError or a sqlite3.Error.
    """
    try:
        yield
    except IrregularFileError as error:
        message = f"{error.filename}: cannot be read: {error.strerror}"
        raise InputError(message) from None
    except OSError as error:
        message = f"{path}: cannot be {action} ({error.strerror or error})"
        raise error_type(message) from error
    except sqlite3.Error as error:
        message = f"{path}: cannot be {action} ({error})"
        raise error_type(message) from error


def make(folder: Path) -> None:
    """Create a study's folder if it does not exist.

    Raises:
        InputError: If it cannot be created.
    """
    with disk_errors(folder, "created", InputError):
        (folder / BLOCKS).mkdir(parents=True, exist_ok=True)
        sync_folder(folder)


def lock(folder: Path) -> int:
    """Lock a folder for this process until the descriptor is closed or the process ends.

    Raises:
        InputError: If another process has locked it.
    """
    with disk_errors(folder):
        descriptor = descriptor_of(folder / LOCK, os.O_RDWR | os.O_CREAT)
    for attempt in range(ATTEMPTS):
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            # `is_locked` of another process holds the lock for a moment.
            time.sleep(RETRY_S if attempt + 1 < ATTEMPTS else 0)
        except OSError as error:
            os.close(descriptor)
            message = f"{folder}: cannot be locked ({error.strerror})"
            raise StoreError(message) from None
        else:
            return descriptor
    os.close(descriptor)
    message = f"{folder}: another process is using it: wait until it ends, or use another folder"
    raise StoreError(message)


def is_locked(folder: str | Path) -> bool:
    """Return whether a process has locked a folder, which means that its study is running.

    Raises:
        InputError: If `folder` is not a path.
    """
    place = validation.path("folder", folder)
    try:
        descriptor = descriptor_of(place / LOCK, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return True
    finally:
        os.close(descriptor)
    return False


def remove_unfinished(folder: Path) -> None:
    """Remove partial files of killed processes."""
    for place in (folder / BLOCKS, folder / FILES, folder):
        remove_abandoned(place)


def write_whole(path: Path, data: bytes | memoryview) -> None:
    """Write a file atomically: it appears whole or not at all, and is on the disk on return.

    A symbolic link stays, and its target is written.

    Raises:
        InputError: If it cannot be written; no partial file remains.
    """
    with disk_errors(path):
        write_atomically(path, data)


def write_files(folder: Path, content: Mapping[str, bytes]) -> None:
    """Write the files that a study needs besides study.toml; their names are their digests.

    Raises:
        InputError: If one cannot be written.
    """
    place = folder / FILES
    if content:
        with disk_errors(place, "created"):
            place.mkdir(exist_ok=True)
    for name, data in content.items():
        if not (place / name).exists():
            write_whole(place / name, data)


def write_question(
    folder: Path, question: str, may_replace: Callable[[str, str], bool], *, is_begun: bool
) -> None:
    """Write study.toml, or check that it is the existing one.

    Raises:
        InputError: If the folder holds another study.
    """
    path = folder / QUESTION
    existing = read_bytes(path)
    if existing is None and is_begun:
        message = f"{path}: is missing, but there are results: restore it, or use another folder"
        raise InputError(message)
    if existing == question.encode():
        return
    if existing is None or may_replace(existing.decode(errors="replace"), question):
        # Removed first: whenever this is killed, an existing answer belongs to study.toml.
        for name in (ANSWER, REPORT):
            with disk_errors(folder / name):
                (folder / name).unlink(missing_ok=True)
        write_whole(path, question.encode())
    else:
        message = (
            f"{folder}: contains another study: use another folder (--out), or remove it\n"
            + differences(existing.decode(errors="replace"), question)
        )
        raise InputError(message)


def read_bytes(path: Path) -> bytes | None:
    """Return a file's bytes; None if it does not exist.

    Raises:
        InputError: If it cannot be read.
    """
    with disk_errors(path, "read"):
        try:
            with open_regular(path) as stream:
                if os.fstat(stream.fileno()).st_size <= MAX_BYTES:
                    return stream.read()
        except (FileNotFoundError, NotADirectoryError):
            return None
    message = f"{path}: cannot be read: it is larger than the limit of {MAX_BYTES:,} bytes"
    raise StoreError(message)

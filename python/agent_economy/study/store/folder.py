"""A study's folder: the lock, files that appear whole, and faults as people read them."""

import contextlib
import difflib
import fcntl
import os
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.study.errors import StoreError

ASKED = "study.toml"
BLOCKS = "blocks"
FILES = "files"
LEDGER = "ledger.sqlite"
LOCK = ".lock"
ANSWER = "answer.json"
REPORT = "report.html"
UNFINISHED = ".unfinished-"
"""What the names of files begin with until they are whole."""

TRIALS = 5
TRIAL_S = 0.02
"""How often, and how long after each, a folder's lock is tried."""

MOST_SHOWN = 6
"""Differing lines that a fault shows."""


@contextmanager
def told(
    path: Path, doing: str = "written", fault: type[InputError] = StoreError
) -> Iterator[None]:
    """Turn what a disk or a ledger refuses into a fault that names the path and the reason.

    Raises:
        InputError: For an OSError or a sqlite3.Error.
    """
    try:
        yield
    except OSError as error:
        message = f"{path}: cannot be {doing} ({error.strerror or error})"
        raise fault(message) from error
    except sqlite3.Error as error:
        message = f"{path}: cannot be {doing} ({error})"
        raise fault(message) from error


def make(folder: Path) -> None:
    """Make a study's folder as far as it is not there.

    Raises:
        InputError: If it cannot be.
    """
    with told(folder, "made", InputError):
        (folder / BLOCKS).mkdir(parents=True, exist_ok=True)
        sync_folder(folder)


def lock(folder: Path) -> int:
    """Take a folder for this process until the descriptor is closed, if only by its death.

    Raises:
        InputError: If another process has it.
    """
    with told(folder):
        descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    for trial in range(TRIALS):
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            # Somebody may just be looking (`is_worked_on`).
            time.sleep(TRIAL_S if trial + 1 < TRIALS else 0)
        except OSError as error:
            os.close(descriptor)
            message = f"{folder}: cannot be locked ({error.strerror})"
            raise StoreError(message) from None
        else:
            return descriptor
    os.close(descriptor)
    message = f"{folder}: another process is working on it: wait for it, or use another folder"
    raise StoreError(message)


def is_worked_on(folder: str | Path) -> bool:
    """Return whether a process has a folder now.

    Raises:
        InputError: If it is no path.
    """
    place = validation.path("folder", folder)
    try:
        descriptor = os.open(place / LOCK, os.O_RDONLY | os.O_CLOEXEC)
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
    """Remove what killed processes left half-written. The folder must be locked."""
    with told(folder):
        for place in (folder / BLOCKS, folder / FILES, folder):
            for path in place.glob(f"{UNFINISHED}*"):
                if path.is_file():
                    path.unlink()


def write_whole(path: Path, data: bytes | memoryview) -> None:
    """Write a file that appears whole or not at all, and is on the disk when this returns.

    Raises:
        InputError: If it cannot be written; nothing is left of it.
    """
    unfinished = path.with_name(UNFINISHED + path.name)
    with told(path):
        try:
            with unfinished.open("wb", buffering=0) as file:
                write_all(file.fileno(), data)
                os.fsync(file.fileno())
            unfinished.replace(path)
            sync_folder(path.parent)
        except OSError:
            with contextlib.suppress(OSError):
                unfinished.unlink()
            raise


def try_out(path: Path) -> None:
    """See whether `write_whole` can write a file; nothing is left of the trial.

    Raises:
        OSError: If it cannot.
    """
    unfinished = path.with_name(UNFINISHED + path.name)
    unfinished.touch()
    unfinished.unlink()


def write_all(descriptor: int, data: bytes | memoryview) -> None:
    """Write every byte: a write may take fewer than it is given."""
    left = memoryview(data)
    while left:
        left = left[os.write(descriptor, left) :]


def sync_folder(folder: Path) -> None:
    """Wait until the names in a folder are on the disk."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def keep(folder: Path, content: Mapping[str, bytes]) -> None:
    """Write down files that a study needs besides study.toml, by their digests, which are names.

    Raises:
        InputError: If one cannot be written.
    """
    place = folder / FILES
    if content:
        with told(place, "made"):
            place.mkdir(exist_ok=True)
    for name, data in content.items():
        if not (place / name).exists():
            write_whole(place / name, data)


def settle(
    folder: Path, asked: str, may_replace: Callable[[str, str], bool], *, is_begun: bool
) -> None:
    """Write down what is asked, or see that it is what was asked before.

    Raises:
        InputError: If the folder holds another study.
    """
    path = folder / ASKED
    there = read_bytes(path)
    if there is None and is_begun:
        message = f"{path}: is missing, though there are results: restore it, or use another folder"
        raise InputError(message)
    if there == asked.encode():
        return
    if there is None or may_replace(there.decode(errors="replace"), asked):
        # An answer that is there is to what study.toml asks, whenever this is killed.
        with told(folder):
            for name in (ANSWER, REPORT):
                (folder / name).unlink(missing_ok=True)
        write_whole(path, asked.encode())
    else:
        message = (
            f"{folder}: holds another study: use another folder (--out), or remove it\n"
            + differences(there.decode(errors="replace"), asked)
        )
        raise InputError(message)


def read_bytes(path: Path) -> bytes | None:
    """Return a file's bytes, None if it is not there.

    Raises:
        InputError: If it cannot be read.
    """
    with told(path, "read"):
        try:
            return path.read_bytes()
        except FileNotFoundError:
            return None


def differences(there: str, asked: str) -> str:
    """Return the first lines in which a study differs from what is asked."""
    diff = difflib.ndiff(there.splitlines(), asked.splitlines())
    words = {"- ": "there", "+ ": "asked"}
    lines = [f"  {words[line[:2]]}: {line[2:]}" for line in diff if line[:2] in words]
    more = [f"  and {len(lines) - MOST_SHOWN} more lines"] if len(lines) > MOST_SHOWN else []
    return "\n".join([*lines[:MOST_SHOWN], *more]) or "  they differ in how lines end"

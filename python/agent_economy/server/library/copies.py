"""Copies of entries, which appear whole under names that are free."""

import os
import re
import shutil
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from uuid import uuid4

from agent_economy.regular_file import open_regular
from agent_economy.server.library.own_folder import disk_errors, locked
from agent_economy.server.workspace import Workspace
from agent_economy.whole_file import put_in_place, remove_abandoned, sync_folder, temporary_file

MAX_STEM = 200
"""Maximum length of the name of a copy without its suffix, in bytes; systems allow 255."""

ENDING = re.compile(r"-copy(-\d+)?$")

PART = "new-"
"""Prefix of folders until they are complete."""


def copy_file(workspace: Workspace, path: Path, folder: Path) -> Path:
    """Copy a file to a folder, and return the copy.

    Raises:
        InputError: If it cannot be read or written.
    """
    remove_abandoned(folder, path.suffix)
    with disk_errors(f"the copy of {path.name}"), open_regular(path) as source:
        with temporary_file(folder, path.suffix) as stream:
            shutil.copyfileobj(source, stream, 2**20)
            with locked(workspace):
                target = free_path(folder / path.name, path.suffix)
                put_in_place(stream, target)
        return target


def make_folder(workspace: Workspace, path: Path, fill: Callable[[Path], None]) -> Path:
    """Make a folder beside another one with what `fill` writes, and return it.

    Raises:
        InputError: If it cannot be written.
    """
    with locked(workspace) as own, disk_errors(f"the copy of {path.name}"):
        for each in own.glob(f"{PART}*"):  # of programs that were killed
            shutil.rmtree(each, ignore_errors=True)
        made = own / f"{PART}{uuid4().hex}"
        made.mkdir()
        fill(made)
        target = free_path(path, "")
        made.rename(target)
        sync_folder(target.parent)
        return target


def free_path(path: Path, suffix: str) -> Path:
    """Return a path beside another one for its copy: NAME-copy, NAME-copy-2 and so on."""
    return next(each for each in names(path, suffix) if not os.path.lexists(each))


def names(path: Path, suffix: str) -> Iterator[Path]:
    """Yield the names of copies of a path."""
    stem = ENDING.sub("", path.name.removesuffix(suffix)).encode()[:MAX_STEM]
    for number in count(1):
        ending = "-copy" if number == 1 else f"-copy-{number}"
        yield path.with_name(f"{stem.decode(errors='ignore')}{ending}{suffix}")

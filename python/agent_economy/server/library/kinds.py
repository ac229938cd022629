"""The kinds of entries of the library: a new one is a class like these, and an entry in `KINDS`."""

import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Protocol

from agent_economy import study
from agent_economy._core import MAX_IMAGE_BYTES, InputError
from agent_economy.recording.recorder import SUFFIX
from agent_economy.regular_file import open_regular
from agent_economy.scenario import Scenario, bundled
from agent_economy.scenario.source import read_file
from agent_economy.scenario.validation import check, is_text
from agent_economy.server.library.copies import copy_file, make_folder
from agent_economy.server.library.own_folder import disk_errors
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.workspace import OUTSIDE, Workspace, described
from agent_economy.study.plan import digest
from agent_economy.study.store.folder import QUESTION, lock, write_files, write_whole
from agent_economy.whole_file import has_lock

MAX_ID = 4096
"""Maximum length of an id; no path of a file is longer."""

TOML = ".toml"


class Kind(Protocol):
    """A kind of entries, each a file or a folder below the server's folder."""

    name: str
    """Its name in addresses, and in records of what was deleted."""

    def entries(self, workspace: Workspace) -> Iterator[tuple[str, Path]]:
        """Yield the ids and paths of all entries."""

    def find(self, workspace: Workspace, name: str) -> Path:
        """Return the path of an entry by its id.

        Raises:
            InputError: If there is none.
        """

    def unused(self, path: Path) -> AbstractContextManager[None]:
        """Keep other programs from writing an entry.

        Raises:
            InputError: If one is writing it.
        """

    def copy(self, workspace: Workspace, path: Path) -> Path:
        """Copy an entry to a free name, and return the copy.

        Raises:
            InputError: If the entry is damaged, or the copy cannot be written.
        """


class Studies:
    """Folders of studies. A copy has the question only, and is computed by this program."""

    name = "studies"

    def entries(self, workspace: Workspace) -> Iterator[tuple[str, Path]]:
        """Yield the ids and paths of all studies."""
        return workspace.studies()

    def find(self, workspace: Workspace, name: str) -> Path:
        """Return the folder of a study by its id."""
        return workspace.study(checked_id(name))

    @contextmanager
    def unused(self, path: Path) -> Iterator[None]:
        """Hold the lock of a study."""
        try:
            descriptor = lock(path)
        except InputError:
            message = f"{path.name}: is running: stop it first, or wait for its answer"
            raise InputError(message) from None
        try:
            yield
        finally:
            os.close(descriptor)

    def copy(self, workspace: Workspace, path: Path) -> Path:
        """Make a study with the question of another one."""
        plan = study.load_plan(path)

        def fill(folder: Path) -> None:
            write_files(folder, {digest(data): data for data in plan.files.values()})
            write_whole(folder / QUESTION, plan.text().encode())

        return make_folder(workspace, path, fill)


class Recordings:
    """Files of recordings."""

    name = "recordings"

    def entries(self, workspace: Workspace) -> Iterator[tuple[str, Path]]:
        """Yield the ids and paths of all recordings."""
        return with_ids(workspace, SUFFIX)

    def find(self, workspace: Workspace, name: str) -> Path:
        """Return the file of a recording by its id."""
        return RecordingStore(workspace).find(checked_id(name))

    @contextmanager
    def unused(self, path: Path) -> Iterator[None]:
        """Hold the lock of a recording."""
        with disk_errors(path.name), open_regular(path) as stream:
            if not has_lock(stream.fileno()):
                message = f"{path.name}: is being written: wait until it is complete"
                raise InputError(message)
            yield

    def copy(self, workspace: Workspace, path: Path) -> Path:
        """Copy a recording."""
        with self.unused(path):
            return copy_file(workspace, path, path.parent)


class Scenarios:
    """Files of scenarios; the bundled ones are not below the server's folder."""

    name = "scenarios"

    def entries(self, workspace: Workspace) -> Iterator[tuple[str, Path]]:
        """Yield the ids and paths of all files that may be scenarios, the bundled ones first."""
        yield from bundled.scenarios().items()
        yield from with_ids(workspace, TOML)

    def find(self, workspace: Workspace, name: str) -> Path:
        """Return the file of a scenario by its id."""
        ships = bundled.scenarios().get(checked_id(name))
        if ships is not None:
            return ships
        file = workspace.folder / name
        # Other TOML files, such as those of fleets, are in no list.
        is_here = workspace.has(file) and file.suffix == TOML
        check(is_here and described(name, file, "folder") is not None, "id", name, "in the gallery")
        return file

    def unused(self, path: Path) -> AbstractContextManager[None]:  # noqa: ARG002
        """Do nothing: scenarios are written by their users."""
        return nullcontext()

    def copy(self, workspace: Workspace, path: Path) -> Path:
        """Copy a scenario; that of a bundled one is in the server's folder, with its maps."""
        if not is_bundled(path):
            return copy_file(workspace, path, path.parent)
        for name, data in Scenario.load(path).source.files.items():
            add_file(workspace, name, data)
        return copy_file(workspace, path, workspace.folder)


KINDS: tuple[Kind, ...] = (Studies(), Recordings(), Scenarios())


def add_file(workspace: Workspace, name: str, data: bytes | str) -> None:
    """Write a file that a scenario names to the server's folder, unless it is there already.

    Raises:
        InputError: If another file has its name, or it cannot be written.
    """
    file = workspace.folder / name
    check(workspace.has(file), "file", name, f"a file here, and {OUTSIDE}")
    content = data if isinstance(data, bytes) else b""
    with disk_errors(name):
        if not os.path.lexists(file):
            write_whole(file, content)
            return
    if read_file(file, MAX_IMAGE_BYTES) != content:
        message = f"{name}: exists with other content, and the scenario needs it: rename it"
        raise InputError(message)


@cache
def bundled_files() -> frozenset[Path]:
    """Return the files of the bundled scenarios."""
    return frozenset(bundled.scenarios().values())


def is_bundled(path: Path) -> bool:
    """Return whether an entry is part of the program."""
    return path in bundled_files()


def with_ids(workspace: Workspace, ending: str) -> Iterator[tuple[str, Path]]:
    """Yield the ids and paths of the files with a suffix."""
    for file in workspace.files(ending):
        yield str(file.relative_to(workspace.folder)), file


def checked_id(name: object) -> str:
    """Return an id that can be one of an entry: a path below the server's folder, not hidden.

    Raises:
        InputError: If it cannot be one.
    """
    allowed = "the id of an entry of the list"
    check(is_text(name) and 0 < len(name) <= MAX_ID, "id", kind_of_value(name), allowed)
    path = PurePosixPath(str(name))
    is_plain = not path.is_absolute() and path.as_posix() == name and "\0" not in str(name)
    is_shown = not any(part.startswith(".") for part in path.parts)
    check(is_plain and is_shown, "id", name, allowed)
    return str(name)


def kind_of_value(name: object) -> str:
    """Return what an id is that is no short text, which errors do not repeat."""
    return f"{len(name):,} characters" if isinstance(name, str) else type(name).__name__

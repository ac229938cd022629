"""The scenarios and studies of a server: the bundled ones, and those below its folder."""

import tomllib
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario import Scenario, Source, bundled, validation
from agent_economy.scenario.source import MAX_BYTES, read_file
from agent_economy.study import load_plan
from agent_economy.study.store.folder import QUESTION, read_bytes
from agent_economy.study.store.kind import is_selection

MAX_DEPTH, MAX_FOLDERS, MAX_FILES = 4, 5000, 2000
"""Limits of the search for files: depth of folders, number of folders, number of files."""

OUTSIDE = "it is not below the folder in which the server was started"


@dataclass(frozen=True)
class Workspace:
    """The server's folder: no file outside of it is opened, except the bundled scenarios."""

    folder: Path

    def listed(self) -> list[dict[str, Any]]:
        """Return all files that declare an engine, the bundled scenarios first."""
        builtin = ((name, file, "bundled") for name, file in bundled.scenarios().items())
        files = islice(self.files(".toml"), MAX_FILES)
        mine = ((str(file.relative_to(self.folder)), file, "folder") for file in files)
        rows = (described(name, file, where) for name, file, where in (*builtin, *mine))
        return [row for row in rows if row]

    def load(self, name: str) -> Scenario:
        """Return a scenario by its id.

        Raises:
            InputError: If there is none, it is outside of the folder, or it has errors.
        """
        ships = bundled.scenarios().get(name)
        return Scenario.load(ships) if ships else self.read(self.text(name), name)

    def text(self, name: str) -> str:
        """Return the text of a scenario by its id, without checking it.

        Raises:
            InputError: If there is none, it is outside of the folder, or cannot be read.
        """
        ships, mine = bundled.scenarios().get(name), self.folder / name
        is_here = ships is not None or (self.has(mine) and mine.suffix == ".toml")
        validation.check(is_here, "scenario", name, "one of the gallery")
        data = read_file(ships or mine, MAX_BYTES)
        if isinstance(data, str):
            message = f"{name}: cannot be read: {data}"
            raise InputError(message)
        return lines(data.decode(errors="replace"))

    def read(self, text: str, name: str = "scenario.toml") -> Scenario:
        """Parse a scenario; the files that it names are read from the folder.

        Raises:
            InputError: If it has errors, or a file is outside of the folder.
        """
        source = Source(name, lines(text), ())
        beside = (self.folder / name).parent
        while wanted := _core.missing_files(source):
            found = {each: self._content(beside / each) for each in wanted}
            source = Source(name, source.text, (), {**source.files, **found})
        return Scenario.of(source)

    def study(self, name: str) -> Path:
        """Return the folder of a study by its id.

        Raises:
            InputError: If there is none, or it is outside of the folder.
        """
        folder = self.folder / name
        is_plain = name == folder_id(folder, self.folder) and ".." not in folder.parts
        is_here = is_plain and self.has(folder / QUESTION) and is_listed(folder)
        validation.check(is_here, "study", name, "the id of a study in the list")
        return folder

    def studies(self) -> Iterator[tuple[str, Path]]:
        """Yield the ids and folders of the studies in the folder."""
        for folder in filter(is_listed, self._folders()):
            yield folder_id(folder, self.folder), folder

    def id_of_study(self, folder: Path) -> str:
        """Return the id of a study in a folder.

        Raises:
            InputError: If that is outside of the server's folder.
        """
        validation.check(
            self.has(folder), "study", str(folder), "below the server's folder, and not a link"
        )
        return folder_id(folder, self.folder)

    def member(self, name: str, configuration: int) -> tuple[Scenario, int]:
        """Return the scenario of a configuration of a study, and the study's seed.

        Raises:
            InputError: If there is no such study or configuration.
        """
        plan = load_plan(self.study(name))
        if agents := plan.engine.agents:
            listed = ", ".join(map(str, agents))
            parameters = ", ".join(f"{each.parameter}=..." for each in agents)
            message = (
                f"study {name}: its runs have agents in Python ({listed}), which the page does not "
                f"run: use agent_economy.Simulation(..., {parameters})"
            )
            raise InputError(message)
        return plan.alone(configuration), plan.seed

    def _content(self, file: Path) -> bytes | str:
        return read_file(file, _core.MAX_IMAGE_BYTES) if self.has(file) else OUTSIDE

    def has(self, file: Path) -> bool:
        """Return whether a file is below the folder, with all links resolved."""
        try:
            return file.resolve().is_relative_to(self.folder.resolve())
        # A circle of links is a RuntimeError before Python 3.13.
        except (OSError, ValueError, RuntimeError):
            return False

    def _folders(self) -> Iterator[Path]:
        return islice(folders_of(self.folder, MAX_DEPTH), MAX_FOLDERS)

    def files(self, ending: str) -> Iterator[Path]:
        """Yield the files with a suffix, without hidden ones and those of studies."""
        folders = (folder for folder in self._folders() if not is_study(folder))
        files = (file for folder in folders for file in listable(folder))
        yield from (file for file in files if file.name.endswith(ending) and self.has(file))


def lines(text: str) -> str:
    """Return text with Unix line endings."""
    return text.replace("\r\n", "\n")


def described(name: str, file: Path, where: str) -> dict[str, Any] | None:
    """Return the entry of a scenario in the gallery; its errors are reported when it is opened.

    Returns:
        None if the file does not declare an engine.
    """
    data = read_file(file, MAX_BYTES)
    if isinstance(data, str):
        return None
    try:
        document = tomllib.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return None
    if not isinstance(document.get("engine"), str):
        return None
    texts = {key: str(document.get(key, "")) for key in ("engine", "summary")}
    return {"id": name, "name": file.stem, **texts, "where": where}


def folders_of(folder: Path, depth: int) -> Iterator[Path]:
    """Yield a folder and its subfolders, breadth first, without hidden ones, links and studies."""
    waiting = deque([(folder, depth)])
    while waiting:
        each, left = waiting.popleft()
        yield each
        if left and not is_study(each):
            waiting += [(inner, left - 1) for inner in subfolders(each)]


def subfolders(folder: Path) -> list[Path]:
    """Return the subfolders of a folder, without hidden ones and links."""
    return [each for each in listable(folder) if is_own_folder(each)]


def listable(folder: Path) -> list[Path]:
    """Return the entries of a folder that a page can name: not hidden, and named in UTF-8."""
    try:
        found = sorted(folder.iterdir())
    except OSError:  # It cannot be read, or has been removed meanwhile.
        return []
    return [
        each for each in found if not each.name.startswith(".") and validation.is_text(each.name)
    ]


def is_own_folder(path: Path) -> bool:
    """Return whether a path is a folder, and not a link to one."""
    try:
        return not path.is_symlink() and path.is_dir()
    except OSError:
        return False


def folder_id(folder: Path, below: Path) -> str:
    """Return the id of a study: the path of its folder below another; empty if it is not below."""
    return folder.relative_to(below).as_posix() if folder.is_relative_to(below) else ""


def is_study(folder: Path) -> bool:
    """Return whether a folder contains a study, or a selection of a user's program."""
    return is_file(folder / QUESTION)


def is_listed(folder: Path) -> bool:
    """Return whether a folder contains a study, which the page shows; it may be damaged."""
    if not is_study(folder):
        return False
    try:
        return not is_selection((read_bytes(folder / QUESTION) or b"").decode(errors="replace"))
    except InputError:
        return True


def is_file(path: Path) -> bool:
    """Return whether a file exists; False for a name that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False

"""Where scenarios and studies are: what ships, and what is in the server's folder."""

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
from agent_economy.study import plan_of
from agent_economy.study.store.folder import ASKED

DEEP, MAX_FOLDERS, MAX_FILES = 4, 1000, 200
"""So many of the folder's files are looked at, in so many folders, so many below each other."""

OUTSIDE = "it is not below the folder in which the server was started"


@dataclass(frozen=True)
class Workspace:
    """The folder below which files are opened, and no others but those that ship."""

    folder: Path

    def listed(self) -> list[dict[str, Any]]:
        """Return all that say that they are scenarios, those that ship first."""
        ships = ((name, file, "shipped") for name, file in bundled.scenarios().items())
        files = islice(self.files(".toml"), MAX_FILES)
        mine = ((str(file.relative_to(self.folder)), file, "folder") for file in files)
        rows = (described(name, file, where) for name, file, where in (*ships, *mine))
        return [row for row in rows if row]

    def load(self, name: str) -> Scenario:
        """Return a scenario by its id.

        Raises:
            InputError: If there is none, it is outside of the folder, or wrong.
        """
        ships = bundled.scenarios().get(name)
        return Scenario.load(ships) if ships else self.read(self.text(name), name)

    def text(self, name: str) -> str:
        """Return the text of a scenario by its id, whatever is wrong in it.

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
        """Return the scenario of a text; files that it names are looked for in the folder.

        Raises:
            InputError: If anything in it is wrong, or a file is outside of the folder.
        """
        source = Source(name, lines(text), ())
        beside = (self.folder / name).parent
        while wanted := _core.files_wanted(source):
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
        is_here = is_plain and self.has(folder / ASKED) and is_study(folder)
        validation.check(is_here, "study", name, "the id of a study in the list")
        return folder

    def studies(self) -> Iterator[tuple[str, Path]]:
        """Yield the ids and folders of the studies in the folder."""
        for folder in filter(is_study, self._folders()):
            yield folder_id(folder, self.folder), folder

    def for_study(self, folder: Path) -> str:
        """Return the id that a study in a folder would have.

        Raises:
            InputError: If it would be outside of the folder.
        """
        validation.check(
            self.has(folder), "study", str(folder), "below the server's folder: no link"
        )
        return folder_id(folder, self.folder)

    def member(self, name: str, configuration: int) -> tuple[Scenario, int]:
        """Return the scenario of a configuration of a study, and the study's seed.

        Raises:
            InputError: If there is no such study or configuration.
        """
        plan = plan_of(self.study(name))
        return plan.alone(configuration), plan.seed

    def _content(self, file: Path) -> bytes | str:
        return read_file(file, _core.MAX_IMAGE_BYTES) if self.has(file) else OUTSIDE

    def has(self, file: Path) -> bool:
        """Return whether a file is below the folder, whatever links there are on the way."""
        try:
            return file.resolve().is_relative_to(self.folder.resolve())
        except (OSError, ValueError):
            return False

    def _folders(self) -> Iterator[Path]:
        return islice(folders_of(self.folder, DEEP), MAX_FOLDERS)

    def files(self, ending: str) -> Iterator[Path]:
        """Yield the folder's files of a kind, but not hidden ones, nor those of studies."""
        folders = (folder for folder in self._folders() if not is_study(folder))
        files = (file for folder in folders for file in sorted(folder.glob(f"*{ending}")))
        yield from (file for file in files if self.has(file) and not file.name.startswith("."))


def lines(text: str) -> str:
    """Return a text whose lines end as ours do."""
    return text.replace("\r\n", "\n")


def described(name: str, file: Path, where: str) -> dict[str, Any] | None:
    """Return what the gallery tells of a scenario; what is wrong in it is told who opens it.

    Returns:
        None if the file does not say which engine it is for.
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
    told = {key: str(document.get(key, "")) for key in ("engine", "summary")}
    return {"id": name, "name": file.stem, **told, "where": where}


def folders_of(folder: Path, deep: int) -> Iterator[Path]:
    """Yield a folder and those in it, but no hidden ones, links or a study's; the nearest first."""
    waiting = deque([(folder, deep)])
    while waiting:
        each, left = waiting.popleft()
        yield each
        if left and not is_study(each):
            waiting += [(inner, left - 1) for inner in inside(each)]


def inside(folder: Path) -> list[Path]:
    """Return the folders in one, but not hidden ones and links."""
    try:
        found = sorted(folder.iterdir())
    except OSError:
        return []
    return [
        each
        for each in found
        if not each.name.startswith(".") and not each.is_symlink() and each.is_dir()
    ]


def folder_id(folder: Path, below: Path) -> str:
    """Return the id of a study: where its folder is below another; nothing if it is not."""
    return folder.relative_to(below).as_posix() if folder.is_relative_to(below) else ""


def is_study(folder: Path) -> bool:
    """Return whether a folder holds a study."""
    return is_file(folder / ASKED)


def is_file(path: Path) -> bool:
    """Return whether there is a file; of a name that no file can have there is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False

"""Where scenarios are: those that ship, and those in the folder in which the server was started."""

import tomllib
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from agent_economy import _core, given, shipped
from agent_economy._core import InputError
from agent_economy.scenario import MAX_BYTES, Scenario, Source, content

DEEP, MOST_FOLDERS, MOST_FILES = 4, 1000, 200
"""So many of the folder's files are looked at, in so many folders, so many below each other."""

OUTSIDE = "it is not below the folder in which the server was started"


@dataclass(frozen=True)
class Places:
    """The folder below which files are opened, and no others but those that ship."""

    folder: Path

    def listed(self) -> list[dict[str, Any]]:
        """Return all that say that they are scenarios, those that ship first."""
        ships = ((name, file, "shipped") for name, file in shipped.scenarios().items())
        mine = ((str(file.relative_to(self.folder)), file, "folder") for file in self._files())
        rows = (described(name, file, where) for name, file, where in (*ships, *mine))
        return [row for row in rows if row]

    def load(self, name: str) -> Scenario:
        """Return a scenario by its id.

        Raises:
            InputError: If there is none, it is outside of the folder, or wrong.
        """
        ships = shipped.scenarios()
        if name in ships:
            return Scenario.load(ships[name])
        file = self.folder / name
        is_here = self._has(file) and file.suffix == ".toml"
        given.check(is_here, "scenario", name, "one of the gallery")
        data = content(file, MAX_BYTES)
        if isinstance(data, str):
            message = f"{name}: cannot be read: {data}"
            raise InputError(message)
        return self.read(data.decode(errors="replace"), name)

    def read(self, text: str, name: str = "scenario.toml") -> Scenario:
        """Return the scenario of a text; files that it names are looked for in the folder.

        Raises:
            InputError: If anything in it is wrong, or a file is outside of the folder.
        """
        source = Source(name, text.replace("\r\n", "\n"), ())
        beside = (self.folder / name).parent
        while wanted := _core.files_wanted(source):
            found = {each: self._content(beside / each) for each in wanted}
            source = Source(name, source.text, (), {**source.files, **found})
        return Scenario.of(source)

    def _content(self, file: Path) -> bytes | str:
        return content(file, _core.MAX_IMAGE_BYTES) if self._has(file) else OUTSIDE

    def _has(self, file: Path) -> bool:
        try:
            return file.resolve().is_relative_to(self.folder.resolve())
        except (OSError, ValueError):
            return False

    def _files(self) -> Iterator[Path]:
        """Yield the folder's TOML files."""
        folders = islice(folders_of(self.folder, DEEP), MOST_FOLDERS)
        files = (file for folder in folders for file in sorted(folder.glob("*.toml")))
        yield from islice((file for file in files if self._has(file)), MOST_FILES)


def described(name: str, file: Path, where: str) -> dict[str, Any] | None:
    """Return what the gallery tells of a scenario; what is wrong in it is told who opens it.

    Returns:
        None if the file does not say which engine it is for.
    """
    data = content(file, MAX_BYTES)
    if isinstance(data, str):
        return None
    try:
        document = tomllib.loads(data.decode())
    except ValueError:
        return None
    if not isinstance(document.get("engine"), str):
        return None
    told = {key: str(document.get(key, "")) for key in ("engine", "summary")}
    return {"id": name, "name": file.stem, **told, "where": where}


def folders_of(folder: Path, deep: int) -> Iterator[Path]:
    """Yield a folder, and those in it, but not hidden ones and links; the nearest first."""
    waiting = deque([(folder, deep)])
    while waiting:
        each, left = waiting.popleft()
        yield each
        if left:
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

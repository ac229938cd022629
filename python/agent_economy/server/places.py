"""Where scenarios are: those that ship, and those in the folder in which the server was started."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy import _core, given, shipped
from agent_economy._core import InputError
from agent_economy.scenario import MAX_BYTES, Scenario, Source, content

DEEP = 4
MOST_FILES = 200
"""Of the folder's scenarios so many are listed, from so many folders below each other at most."""

OUTSIDE = "it is not below the folder in which the server was started"


@dataclass(frozen=True)
class Places:
    """The folder below which files are opened, and no others but those that ship."""

    folder: Path

    def listed(self) -> list[dict[str, Any]]:
        """Return all scenarios that can be read, those that ship first."""
        ships = ((name, "shipped") for name in shipped.scenarios())
        mine = ((str(file.relative_to(self.folder)), "folder") for file in self._files())
        rows = []
        for name, where in (*ships, *mine):
            try:
                scenario = self.load(name)
            except InputError:
                continue
            rows.append(
                {
                    "id": name,
                    "name": scenario.name,
                    "engine": scenario.engine,
                    "summary": scenario.summary,
                    "where": where,
                }
            )
        return rows

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
        """Yield the folder's TOML files that may be scenarios."""
        found = (file for file in sorted(tomls(self.folder, DEEP)) if self._has(file))
        for number, file in enumerate(found):
            if number == MOST_FILES:
                return
            yield file


def tomls(folder: Path, deep: int) -> Iterator[Path]:
    """Yield TOML files in and below a folder, but not in hidden ones or links."""
    try:
        inside = sorted(folder.iterdir())
    except OSError:
        return
    for each in inside:
        if each.name.startswith(".") or each.is_symlink():
            continue
        if each.is_dir() and deep:
            yield from tomls(each, deep - 1)
        elif each.suffix == ".toml" and each.is_file():
            yield each

"""The recordings of a folder: which there are, and where new ones go."""

from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from agent_economy import given
from agent_economy._core import InputError
from agent_economy.recording.identity import Identity
from agent_economy.recording.reading import Recorded, read
from agent_economy.recording.recorder import ENDING
from agent_economy.recording.summary import glance
from agent_economy.server.workspace import OUTSIDE, Workspace, is_file

FOLDER = "recordings"
"""Where new ones go, below the folder in which the server was started."""

MAX_LISTED = 200
"""So many are listed, the newest."""

MAX_BYTES = 2**30
"""A larger one is not opened: its states alone would be too many to hold."""


@dataclass(frozen=True)
class RecordingStore:
    """Where recordings are."""

    places: Workspace

    @property
    def folder(self) -> Path:
        """Where new ones go.

        Raises:
            InputError: If that is a link to somewhere else.
        """
        folder = self.places.folder / FOLDER
        given.check(self.places.has(folder), "save", FOLDER, f"a folder here, and {OUTSIDE}")
        return folder

    def listed(self) -> list[dict[str, Any]]:
        """Return what each is of, the newest first."""
        times: dict[Path, float] = {}
        for file in self.places.files(ENDING):
            with suppress(OSError):  # gone meanwhile
                times[file] = file.stat().st_mtime
        newest = sorted(times, key=lambda file: (-times[file], file))[:MAX_LISTED]
        return [row for row in map(self.row, newest) if row]

    def row(self, file: Path) -> dict[str, Any]:
        """Return what a recording is of, or what is wrong with it; nothing if it has gone."""
        try:
            state = file.stat()
        except OSError:
            return {}
        row: dict[str, Any] = {
            "id": str(file.relative_to(self.places.folder)),
            "bytes": state.st_size,
            "saved_s": state.st_mtime,
        }
        try:
            seen = asdict(glance(file))
        except InputError as error:
            words = str(error).removeprefix(f"{file}: ")
            return row | {"of": None, "fault": words}
        # JavaScript's numbers have not so many digits.
        return row | {"of": seen | {key: str(seen[key]) for key in ("seed", "run")}, "fault": None}

    def find(self, name: str) -> Path:
        """Return a recording's file by its id.

        Raises:
            InputError: If there is none, or it is outside of the folder.
        """
        file = self.places.folder / name
        is_here = self.places.has(file) and file.suffix == ENDING and is_file(file)
        given.check(is_here, "recording", name, "one below the folder of the server")
        return file

    def load(self, name: str) -> tuple[Identity, Recorded]:
        """Return which run a recording is of, and what it says of it.

        Raises:
            InputError: If there is none, or it is damaged, outside of the folder or too large.
        """
        file = self.find(name)
        size = file.stat().st_size
        allowed = f"one of at most {MAX_BYTES:,} bytes; agent-economy rerun takes larger ones"
        given.check(size <= MAX_BYTES, "recording", f"{name} ({size:,} bytes)", allowed)
        return read(file)

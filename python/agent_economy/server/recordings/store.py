"""The recordings below the server's folder."""

from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.recording.identity import Identity
from agent_economy.recording.reading import Recorded, read
from agent_economy.recording.recorder import SUFFIX
from agent_economy.recording.summary import summarise
from agent_economy.scenario import validation
from agent_economy.server.messages import escaped
from agent_economy.server.workspace import OUTSIDE, Workspace, is_file
from agent_economy.types.page import RecordingEntry

FOLDER = "recordings"
"""The folder of new recordings, below the server's folder."""

MAX_LISTED = 2000
"""Maximum number of recordings in the list; the newest are listed."""

MAX_BYTES = 2**30
"""Maximum size of a recording that is opened: the states of a larger one do not fit into memory."""


@dataclass(frozen=True)
class RecordingStore:
    """The recordings of a workspace."""

    workspace: Workspace

    @property
    def folder(self) -> Path:
        """The folder of new recordings.

        Raises:
            InputError: If it is a link that leads out of the server's folder.
        """
        folder = self.workspace.folder / FOLDER
        validation.check(
            self.workspace.has(folder), "save", FOLDER, f"a folder here, and {OUTSIDE}"
        )
        return folder

    def listed(self) -> list[RecordingEntry]:
        """Return a row for each recording, the newest first."""
        times: dict[Path, float] = {}
        for file in self.workspace.files(SUFFIX):
            with suppress(OSError):  # The file has been removed meanwhile.
                times[file] = file.stat().st_mtime
        newest = sorted(times, key=lambda file: (-times[file], file))[:MAX_LISTED]
        return [row for row in map(self.row, newest) if row]

    def row(self, file: Path) -> RecordingEntry | None:
        """Return a recording's row in the list; None if the file has been removed."""
        try:
            state = file.stat()
        except OSError:
            return None
        row: Any = {
            "id": str(file.relative_to(self.workspace.folder)),
            "bytes": state.st_size,
            "saved_at_s": state.st_mtime,
        }
        try:
            run = asdict(summarise(file))
        except InputError as error:
            row |= {"run": None, "error": escaped(str(error).removeprefix(f"{file}: "))}
        else:
            # JavaScript's numbers have 53 bits.
            row |= {"run": run | {key: str(run[key]) for key in ("seed", "run")}, "error": None}
        entry: RecordingEntry = row
        return entry

    def find(self, name: str) -> Path:
        """Return the file of a recording by its id.

        Raises:
            InputError: If there is none, or it is outside of the server's folder.
        """
        file = self.workspace.folder / name
        is_here = self.workspace.has(file) and file.suffix == SUFFIX and is_file(file)
        validation.check(is_here, "recording", name, "one below the folder of the server")
        return file

    def load(self, name: str) -> tuple[Identity, Recorded]:
        """Return the identity and the content of a recording by its id.

        Raises:
            InputError: If there is none, or it is damaged, outside of the folder or too large.
        """
        file = self.find(name)
        size = file.stat().st_size
        allowed = f"at most {MAX_BYTES:,} bytes; agent-economy replay reads larger recordings"
        validation.check(size <= MAX_BYTES, "recording", f"{name} ({size:,} bytes)", allowed)
        return read(file)

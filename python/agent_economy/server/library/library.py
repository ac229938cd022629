"""What pages request of the library: each change of it is made while no other server makes one."""

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.scenario.validation import check
from agent_economy.server.library.kinds import KINDS, Kind, checked_id, is_bundled
from agent_economy.server.library.label import NAME, Label, label_file, read, write
from agent_economy.server.library.own_folder import disk_errors, locked
from agent_economy.server.library.trash import FOLDER, GONE, Trash
from agent_economy.server.messages import escaped
from agent_economy.server.workspace import OUTSIDE, Workspace
from agent_economy.types import page

MAX_COUNTED = 20_000
"""Maximum number of files of an entry whose sizes are added."""


@dataclass(frozen=True)
class Library:
    """The entries of a server's folder; its methods may be called in any thread."""

    workspace: Workspace

    def listed(self, kind: Kind) -> list[page.LibraryEntry]:
        """Return all entries of a kind."""
        rows = (self.row(*each) for each in kind.entries(self.workspace))
        return [row for row in rows if row is not None]

    def entry(self, kind: Kind, name: Any) -> page.LibraryEntry:
        """Return an entry by its id.

        Raises:
            InputError: If there is none.
        """
        row = self.row(name, kind.find(self.workspace, name))
        if row is None:
            message = f"{name}: has been removed"
            raise InputError(message)
        return row

    def row(self, name: str, path: Path) -> page.LibraryEntry | None:
        """Return an entry as pages take it; None if it has been removed."""
        try:
            size, changed_s = size_and_time(path)
        except OSError:
            return None
        label, error = self.label(path)
        return {
            "id": name,
            "title": label.title,
            "note": label.note,
            "tags": list(label.tags),
            "bytes": size,
            "changed_s": changed_s,
            "is_bundled": is_bundled(path),
            "error": error,
        }

    def label(self, path: Path) -> tuple[Label, str | None]:
        """Return the label of an entry, or an empty one and what is wrong with its file."""
        try:
            return read(self.own_label_file(path)), None
        except InputError as error:
            return Label(), escaped(f"{label_file(path).name}: {error}")

    def own_label_file(self, path: Path) -> Path:
        """Return the file of the label of an entry.

        Raises:
            InputError: If it is a link that leads out of the server's folder.
        """
        file = label_file(path)
        # `Path.is_symlink` raises an error for a name that is too long.
        is_own = not os.path.islink(file) or self.workspace.has(file)  # noqa: PTH114
        check(is_own, "label", file.name, f"a file here, and {OUTSIDE}")
        return file

    def set_label(self, kind: Kind, request: dict[str, Any]) -> page.LibraryEntry:
        """Set what a request contains of the title, the note and the tags of an entry.

        Raises:
            InputError: If there is no such entry, or a value is not allowed.
        """
        name: Any = request.get("id")
        with locked(self.workspace):
            path = self.own(kind, name, "renamed")
            label, _ = self.label(path)
            changed = label.changed(request)
            with disk_errors(f"{name}: {NAME}"):
                write(self.own_label_file(path), changed)
            return self.entry(kind, name)

    def duplicate(self, kind: Kind, request: dict[str, Any]) -> page.LibraryEntry:
        """Copy an entry, and return the copy.

        Raises:
            InputError: If there is no such entry, or it cannot be copied.
        """
        name: Any = request.get("id")
        path = kind.find(self.workspace, name)
        check_inside(path, self.workspace, "duplicated")
        label, _ = self.label(path)
        target = kind.copy(self.workspace, path)
        if label != Label():
            with locked(self.workspace), disk_errors(f"{target.name}: {NAME}"):
                write(label_file(target), label.of_copy())
        return self.entry(kind, target.relative_to(self.workspace.folder).as_posix())

    def delete(self, kind: Kind, request: dict[str, Any]) -> page.Deleted:
        """Move an entry to the trash.

        Raises:
            InputError: If there is no such entry, it is in use, or it cannot be moved.
        """
        name: Any = request.get("id")
        with locked(self.workspace) as own:
            path = self.own(kind, name, "deleted")
            check_inside(path, self.workspace, "deleted")
            label, _ = self.label(path)
            with disk_errors(str(name)), kind.unused(path):
                token = self.trash(own).put(path, kind.name, str(name), label.title)
        return {"token": token, "kind": kind.name, "id": str(name), "title": label.title}

    def restore(self, request: dict[str, Any]) -> page.Deleted:
        """Move what was deleted back to its place.

        Raises:
            InputError: If it is not in the trash any more, or its place is taken.
        """
        with locked(self.workspace) as own:
            trash, token = self.trash(own), request.get("token")
            record = trash.record(token)
            kind = next((each for each in KINDS if each.name == record.kind), None)
            if kind is None:
                raise InputError(GONE)
            target = self.workspace.folder / checked_id(record.id)
            check(self.workspace.has(target), "id", record.id, f"a place here, and {OUTSIDE}")
            if os.path.lexists(target):
                message = f"{record.id}: exists again: rename or remove it, then undo"
                raise InputError(message)
            with disk_errors(record.id):
                trash.restore(str(token), target)
        return {"token": str(token), "kind": kind.name, "id": record.id, "title": record.title}

    def own(self, kind: Kind, name: Any, done: str) -> Path:
        """Return the path of an entry that is not part of the program.

        Raises:
            InputError: If there is no such entry, or it is.
        """
        path = kind.find(self.workspace, name)
        if is_bundled(path):
            message = f"{name}: is bundled and cannot be {done}: duplicate it"
            raise InputError(message)
        return path

    def trash(self, own_folder: Path) -> Trash:
        """Return the trash.

        Raises:
            InputError: If it is a link that leads out of the server's folder.
        """
        folder = own_folder / FOLDER
        check(self.workspace.has(folder), "folder", FOLDER, f"a folder here, and {OUTSIDE}")
        return Trash(folder)


def check_inside(path: Path, workspace: Workspace, done: str) -> None:
    """Refuse the server's folder itself, which may be a study.

    Raises:
        InputError: If it is.
    """
    if path == workspace.folder:
        message = f"the server's folder itself cannot be {done}: start the server in another one"
        raise InputError(message)


def size_and_time(path: Path) -> tuple[int, float]:
    """Return the bytes of a file or folder and its last change, without those of its label.

    Raises:
        OSError: If it does not exist.
    """
    about = path.stat()
    if not stat.S_ISDIR(about.st_mode):
        return about.st_size, about.st_mtime
    size, changed_s = 0, 0.0
    for counted, each in enumerate(files_below(path)):
        if counted == MAX_COUNTED:
            break
        size += each.st_size
        changed_s = max(changed_s, each.st_mtime)
    return size, changed_s or about.st_mtime


def files_below(folder: Path) -> Iterator[os.stat_result]:
    """Yield what is known of the files below a folder, without links and labels."""
    waiting = [folder]
    while waiting:
        try:
            with os.scandir(waiting.pop()) as entries:
                found = list(entries)
        except OSError:  # It has been removed meanwhile.
            continue
        for each in found:
            try:
                about = each.stat(follow_symlinks=False)
            except OSError:
                continue
            if stat.S_ISDIR(about.st_mode):
                waiting.append(Path(each.path))
            elif stat.S_ISREG(about.st_mode) and each.name != NAME:
                yield about

"""What was deleted: each entry in a folder of its own, from which it is restored.

An entry is deleted, and restored, by renaming it: it is in its place or here whenever this program
is killed. Its label, a file beside it, follows when it is deleted and precedes when it is restored.
"""

import json
import os
import re
import shutil
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

from agent_economy._core import InputError
from agent_economy.regular_file import open_regular
from agent_economy.scenario.validation import check
from agent_economy.server.library.label import label_file
from agent_economy.whole_file import sync_folder, write_whole

FOLDER, RECORD, CONTENT = "trash", "entry.json", "content"

TOKEN = re.compile(r"[0-9a-f]{32}")

GONE = "what was deleted is not in the trash any more"


@dataclass(frozen=True)
class Record:
    """What was deleted, and when, in seconds since 1970."""

    kind: str
    id: str
    title: str
    deleted_s: float


@dataclass(frozen=True)
class Trash:
    """The folder of what was deleted; its user holds the lock of the library."""

    folder: Path

    def put(self, path: Path, kind: str, name: str, title: str) -> str:
        """Move an entry to the trash, and return the token that restores it.

        Raises:
            OSError: If it cannot be moved; then it is in its place.
        """
        token = uuid4().hex
        place, label = self.folder / token, label_file(path)
        place.mkdir(parents=True)
        record = json.dumps(asdict(Record(kind, name, title, time.time())))
        write_whole(place / RECORD, record.encode())
        try:
            path.rename(place / CONTENT)
        except OSError:
            shutil.rmtree(place, ignore_errors=True)
            raise
        sync_folder(path.parent)
        move_label(label, label_file(place / CONTENT))
        return token

    def record(self, token: object) -> Record:
        """Return what was deleted.

        Raises:
            InputError: If there is nothing with this token, or its record is damaged.
        """
        is_token = isinstance(token, str) and TOKEN.fullmatch(token) is not None
        check(is_token, "token", type(token).__name__, "the token of what was deleted")
        place = self.folder / str(token)
        if not os.path.lexists(place / CONTENT):
            raise InputError(GONE)
        try:
            with open_regular(place / RECORD) as stream:
                return record_of(json.load(stream))
        except (OSError, ValueError, TypeError, RecursionError):
            message = f"{place / RECORD}: is damaged: move {CONTENT} beside it back by hand"
            raise InputError(message) from None

    def restore(self, token: str, target: Path) -> None:
        """Move what was deleted back to its place, which is free.

        Raises:
            OSError: If it cannot be moved.
        """
        place = self.folder / token
        target.parent.mkdir(parents=True, exist_ok=True)
        if not (place / CONTENT).is_dir():
            move_label(label_file(place / CONTENT), label_file(target))
        (place / CONTENT).rename(target)
        sync_folder(target.parent)
        with suppress(OSError):  # A label that could not be moved is kept.
            (place / RECORD).unlink()
            place.rmdir()


def record_of(given: Any) -> Record:
    """Return a record that was read.

    Raises:
        TypeError: If it is none.
    """
    record = Record(**given)
    if not all(isinstance(each, str) for each in (record.kind, record.id, record.title)):
        raise TypeError(given)
    return record


def move_label(file: Path, target: Path) -> None:
    """Move the label of a file, unless its place is taken; that of a folder is in the folder."""
    if os.path.lexists(file) and not os.path.lexists(target):
        file.rename(target)

"""The label of an entry: its title, note and tags, in a JSON file that moves with it.

That of a folder is `label.json` in it, that of a file is `NAME.label.json` beside it.
"""

import errno
import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.regular_file import open_regular
from agent_economy.scenario.validation import check, is_text
from agent_economy.whole_file import write_whole

NAME = "label.json"

MAX_TITLE, MAX_NOTE, MAX_TAG = 200, 10_000, 60
"""Maximum number of characters."""

MAX_TAGS = 50

MAX_BYTES = 2**20
"""Maximum size of a label file; what it may contain is far smaller."""

IN_NOTES = "\n\t"
"""Control characters that a note may contain."""


@dataclass(frozen=True)
class Label:
    """What a user calls and notes of an entry."""

    title: str = ""
    note: str = ""
    tags: tuple[str, ...] = ()

    def changed(self, request: dict[str, Any]) -> "Label":
        """Return the label with what a request contains of `title`, `note` and `tags`.

        Raises:
            InputError: If a value is not allowed.
        """
        title = checked_text("title", request.get("title", self.title), MAX_TITLE)
        note = checked_text("note", request.get("note", self.note), MAX_NOTE, IN_NOTES)
        return Label(title, note, checked_tags(request.get("tags", list(self.tags))))

    def of_copy(self) -> "Label":
        """Return the label of a copy."""
        title = f"Copy of {self.title}"[:MAX_TITLE] if self.title else ""
        return Label(title, self.note, self.tags)


def label_file(path: Path) -> Path:
    """Return the file of the label of a file or folder."""
    return path / NAME if path.is_dir() else path.with_name(f"{path.name}.{NAME}")


def read(file: Path) -> Label:
    """Return the label in a file; an empty one if there is no file.

    Raises:
        InputError: If it cannot be read or is damaged; its message does not name the file.
    """
    return Label().changed(document(file))


def write(file: Path, label: Label) -> None:
    """Write a label; a damaged file is kept as FILE.damaged, and keys of newer programs stay.

    Raises:
        OSError: If it cannot be written; then the file is as before.
    """
    try:
        known = document(file)
        Label().changed(known)
    except InputError:
        file.replace(free_name(file))
        known = {}
    if label == Label() and not known.keys() - asdict(label).keys():
        file.unlink(missing_ok=True)
        return
    text = json.dumps(known | asdict(label), indent=2, ensure_ascii=False)
    write_whole(file, f"{text}\n".encode())


def free_name(file: Path) -> Path:
    """Return a name for a damaged file that nothing has yet."""
    number, free = 1, file.with_name(f"{file.name}.damaged")
    while free.exists() or free.is_symlink():
        number += 1
        free = file.with_name(f"{file.name}.damaged-{number}")
    return free


def document(file: Path) -> dict[str, Any]:
    """Return the JSON object in a file; an empty one if there is no file.

    Raises:
        InputError: If it cannot be read, or is not a JSON object.
    """
    try:
        with open_regular(file) as stream:
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        return {}
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:  # No such file can exist, so none is damaged.
            return {}
        message = f"cannot be read: {error.strerror or error}"
        raise InputError(message) from None
    check(len(data) <= MAX_BYTES, "size", len(data), f"at most {MAX_BYTES:,} bytes")
    try:
        found = json.loads(data)
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        message = "is not a JSON object"
        raise InputError(message)
    # What newer programs add has to be JSON again when it is written.
    if not is_text(json.dumps(found, ensure_ascii=False)):
        message = "is not Unicode text"
        raise InputError(message)
    return found


def checked_text(name: str, value: object, longest: int, allowed: str = "") -> str:
    """Return a string of a label without spaces around it.

    Raises:
        InputError: If it is not a string, too long, or contains control characters.
    """
    check(is_text(value), name, type(value).__name__, "a string of Unicode text")
    text = str(value).strip()
    check(len(text) <= longest, name, f"{len(text):,} characters", f"at most {longest:,}")
    plain = all(char.isprintable() or char in allowed for char in text)
    besides = " besides line feeds and tabs" if allowed else ""
    check(plain, name, text[:MAX_TAG], f"text without control characters{besides}")
    return text


def checked_tags(value: object) -> tuple[str, ...]:
    """Return tags, each once, in their order.

    Raises:
        InputError: If they are not a list of short strings without commas, or too many.
    """
    check(isinstance(value, list), "tags", type(value).__name__, "a list of strings")
    given = list(value) if isinstance(value, list) else []
    check(len(given) <= MAX_TAGS, "tags", f"{len(given):,} tags", f"at most {MAX_TAGS}")
    tags = [checked_text("tags", each, MAX_TAG) for each in given]
    for tag in tags:
        check("," not in tag, "tags", tag, "without commas, which separate tags on the page")
    return tuple(dict.fromkeys(tag for tag in tags if tag))

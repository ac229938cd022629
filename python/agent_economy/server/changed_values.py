"""What was changed in the scenario of a run, in the first comments of its exported file.

So the form of a study can show it, wherever the file comes from: an address, a disk, a recording.
"""

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.types import page

MAX_LISTED = 10
"""Maximum number of changed values that are listed; all are counted."""

MAX_VALUE = 60
"""Maximum length of a value in a list; of a longer one, its number of entries is listed."""

NOTHING = "nothing"

ORIGIN = re.compile(r"# From (.+), seed \d+, run \d+, at tick \d+ \(.*\)\.")
TOTAL = re.compile(r"# Changed values: (\d{1,9})\.")
VALUE = re.compile(r"# (\S+) = (.*) \(was (.*)\)")
BARE = re.compile(r"[A-Za-z0-9_-]+")


@dataclass(frozen=True)
class Change:
    """A changed value: its path, and what it was and is in one line; None where there is none."""

    path: str
    old: str | None
    new: str | None


def comments(changes: list[Change]) -> list[str]:
    """Return the lines of a file that list changed values."""
    shown = [
        f"{each.path} = {each.new or NOTHING} (was {each.old or NOTHING})"
        for each in changes[:MAX_LISTED]
    ]
    return [f"Changed values: {len(changes)}.", *shown]


def exported_from(text: str, document: Mapping[str, Any]) -> page.ChangedScenario | None:
    """Return the scenario that a file was exported from, with what was changed in it.

    Args:
        text: The file's content.
        document: The scenario as nested dicts: its values now, also if the file was edited since.

    Returns:
        None if the file was not exported.
    """
    declared = declared_in(text)
    if declared is None:
        return None
    listed = [found.groups() for found in map(VALUE.fullmatch, head(text)) if found]
    changes = [Change(path, old, value_at(document, path)) for path, _, old in listed]
    values = [each for each in changes if each.old != (each.new or NOTHING)]
    # Without those that were set back by hand since.
    total = max(len(values), declared[1] - (len(changes) - len(values)))
    return {
        "name": declared[0],
        "values": [
            {"path": each.path, "old": None if each.old == NOTHING else each.old, "new": each.new}
            for each in values[:MAX_LISTED]
        ],
        "total": total,
    }


def declared_in(text: str) -> tuple[str, int] | None:
    """Return the name of the scenario of an exported file, and how many values were changed."""
    lines = head(text)
    origin = ORIGIN.fullmatch(next(lines, ""))
    if origin is None:
        return None
    counts = [int(found[1]) for found in map(TOTAL.fullmatch, lines) if found]
    return origin[1], (counts or [0])[0]


def head(text: str) -> Iterator[str]:
    """Yield the comments at the beginning of a file."""
    for line in text.split("\n", 2 * MAX_LISTED + 100):
        if not line.startswith("#"):
            return
        yield line


def changes_between(before: Any, after: Any, path: str = "") -> Iterator[Change]:
    """Yield the values that differ between two documents, by their paths."""
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        for key in {**before, **after}:
            inner = f"{path}.{key_text(key)}" if path else key_text(key)
            yield from changes_between(before.get(key), after.get(key), inner)
    elif before != after:
        yield Change(path, text_of(before), text_of(after))


def key_text(key: str) -> str:
    """Return a key of a path in one line without spaces."""
    return key if BARE.fullmatch(key) else json.dumps(key).replace(" ", "\\u0020")


def text_of(value: Any) -> str | None:
    """Return a value in one line; None if there is none."""
    if value is None:
        return None
    if isinstance(value, Mapping):
        return f"a table with {counted(len(value), 'key')}"
    text = json.dumps(value, default=str)
    if len(text) <= MAX_VALUE:
        return text
    is_list = isinstance(value, list | tuple)
    return counted(len(value), "entry") if is_list else f"{text[:MAX_VALUE]}..."


def counted(count: int, word: str) -> str:
    """Return a number of things in words."""
    plural = f"{word[:-1]}ies" if word == "entry" else f"{word}s"
    return f"{count} {word if count == 1 else plural}"


def value_at(document: Mapping[str, Any], path: str) -> str | None:
    """Return the text of the value at a path of a document; None if there is none."""
    found: Any = document
    for key in re.findall(r'"(?:[^"\\]|\\.)*"|[^.]+', path):
        plain = json.loads(key) if key.startswith('"') and key.endswith('"') else key
        found = found.get(plain) if isinstance(found, Mapping) else None
    return text_of(found)

"""Paths in the commands that messages print."""

from pathlib import Path
from shlex import quote


def shell_word(path: str | Path) -> str:
    """Return a path as a word of a shell command, which is no option of it."""
    text = str(path)
    return quote(f"./{text}" if text.startswith("-") else text)

"""Entries of what is read from a recording, seen to: a damaged file may lack any."""

import json
from collections.abc import Mapping
from typing import Any, NoReturn

from agent_economy._core import InputError
from agent_economy.scenario import validation

DIGITS = 20
"""Of 2^64, and no number of a recording is larger."""

SHOWN = 80
"""Letters of a text that is told."""


class Entries:
    """Metadata or a message of a recording, by name; what is wrong in it is told with its name."""

    def __init__(self, where: str, values: object) -> None:
        """Begin with what was read.

        Raises:
            InputError: If it has no entries.
        """
        self._where = where
        if not isinstance(values, Mapping):
            self.refuse("no entries")
        self._values: Mapping[str, Any] = values

    def text(self, name: str) -> str:
        """Return a text.

        Raises:
            InputError: If there is none.
        """
        value = self._of(name)
        return (
            value if validation.is_text(value) else self.refuse(f"{name} = {shown(value)}, no text")
        )

    def whole(self, name: str) -> int:
        """Return a whole number, 0 or more; metadata has such as texts.

        Raises:
            InputError: If it is none.
        """
        value = self._of(name)
        if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) <= DIGITS:
            return int(value)
        is_whole = validation.is_whole(value, 0)
        return int(value) if is_whole else self.refuse(f"{name} = {shown(value)}, no whole number")

    def json(self, name: str) -> Any:
        """Return what a text says as JSON.

        Raises:
            InputError: If it is no JSON.
        """
        text = self.text(name)
        try:
            return json.loads(text)
        except (ValueError, RecursionError):
            self.refuse(f"{name} = {shown(text)}, no JSON")

    def by_name(self, name: str) -> dict[str, Any]:
        """Return what there is of each robot.

        Raises:
            InputError: If it is nothing of the kind.
        """
        value = self._of(name)
        return value if isinstance(value, dict) else self.refuse(f"{name} that are of no robots")

    def refuse(self, what: str) -> NoReturn:
        """Say what is wrong.

        Raises:
            InputError: Always.
        """
        message = f"is damaged: its {self._where} has {what}"
        raise InputError(message)

    def _of(self, name: str) -> Any:
        return self._values[name] if name in self._values else self.refuse(f"no entry {name!r}")


def shown(value: object) -> str:
    """Return a value as it is told, not longer than a line."""
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."

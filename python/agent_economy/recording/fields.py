"""Typed access to the entries of a recording, any of which a damaged file may lack."""

import json
from collections.abc import Mapping
from typing import Any, NoReturn

from agent_economy._core import InputError
from agent_economy.scenario import validation

DIGITS = 20
"""Digits of 2^64, the largest number in a recording."""

MAX_SHOWN = 80
"""Maximum number of characters of a value in an error message."""


HEX_DIGITS = 16
"""Hexadecimal digits of a hash: 64 bits."""


def hash_text(value: int) -> str:
    """Return a hash as recordings store it."""
    return f"{value:0{HEX_DIGITS}x}"


class Entries:
    """Metadata or a message of a recording; errors name the entry."""

    def __init__(self, where: str, values: object) -> None:
        """Wrap decoded values; `where` is their name in errors.

        Raises:
            InputError: If they are not a mapping.
        """
        self._where = where
        if not isinstance(values, Mapping):
            self.refuse("no entries")
        self._values: Mapping[str, Any] = values

    def __contains__(self, name: str) -> bool:
        """Whether there is an entry with a name."""
        return name in self._values

    def has_value(self, name: str) -> bool:
        """Whether there is an entry with a name that is not null."""
        return self._values.get(name) is not None

    def text(self, name: str) -> str:
        """Return a string.

        Raises:
            InputError: If it is missing or not a string.
        """
        value = self._of(name)
        return (
            value
            if validation.is_text(value)
            else self.refuse(f"{name} = {shown(value)}, not a string")
        )

    def hash(self, name: str) -> str:
        """Return a hash: 16 hexadecimal digits.

        Raises:
            InputError: If it is missing or not a hash.
        """
        text = self.text(name)
        is_hash = len(text) == HEX_DIGITS and set(text) <= set("0123456789abcdef")
        return (
            text
            if is_hash
            else self.refuse(f"{name} = {shown(text)}, not {HEX_DIGITS} hexadecimal digits")
        )

    def whole(self, name: str) -> int:
        """Return a whole number, 0 or more; metadata contains numbers as strings.

        Raises:
            InputError: If it is missing or not a whole number.
        """
        value = self._of(name)
        if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) <= DIGITS:
            return int(value)
        is_whole = validation.is_whole(value, 0)
        return (
            int(value) if is_whole else self.refuse(f"{name} = {shown(value)}, not a whole number")
        )

    def json(self, name: str) -> Any:
        """Return the value of a string that contains JSON.

        Raises:
            InputError: If it is missing or not JSON.
        """
        text = self.text(name)
        try:
            return json.loads(text)
        except (ValueError, RecursionError):
            self.refuse(f"{name} = {shown(text)}, not JSON")

    def by_name(self, name: str) -> dict[str, Any]:
        """Return a mapping by robot name.

        Raises:
            InputError: If it is missing or not a mapping.
        """
        value = self._of(name)
        return (
            value
            if isinstance(value, dict)
            else self.refuse(f"{name} = {shown(value)}, not a mapping by robot name")
        )

    def refuse(self, what: str) -> NoReturn:
        """Raise an error about an entry.

        Raises:
            InputError: Always.
        """
        message = f"is damaged: its {self._where} has {what}"
        raise InputError(message)

    def _of(self, name: str) -> Any:
        return self._values[name] if name in self._values else self.refuse(f"no entry {name!r}")


def shown(value: object) -> str:
    """Return a value for an error message, shortened to fit on a line."""
    text = repr(value)
    return text if len(text) <= MAX_SHOWN else f"{text[:MAX_SHOWN]}..."

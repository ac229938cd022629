"""Checks of arguments; their errors have the form of a scenario's."""

import math
from collections.abc import Iterable
from numbers import Integral
from os import PathLike
from pathlib import Path
from types import UnionType
from typing import TypeGuard

from agent_economy import _core

Kinds = type | UnionType


def check(is_allowed: bool, name: str, value: object, allowed: str) -> None:  # noqa: FBT001
    """Raise an error unless an argument is allowed; `allowed` completes "must be ...".

    Raises:
        InputError: If it is not.
    """
    if not is_allowed:
        raise _core.refusal(name, value, allowed)


def of_type(name: str, value: object, kinds: Kinds, allowed: str) -> None:
    """Raise an error unless an argument is an instance of one of some types.

    Raises:
        InputError: If it is not.
    """
    check(isinstance(value, kinds), name, value, allowed)


def is_text(value: object) -> TypeGuard[str]:
    """Return whether a value is a string without unpaired surrogates."""
    if not isinstance(value, str):
        return False
    try:
        value.encode()
    except UnicodeEncodeError:
        return False
    else:
        return True


def is_whole(value: object, smallest: int, largest: float = math.inf) -> bool:
    """Return whether a value is an integer (not a bool) in a range, ends included."""
    if not isinstance(value, Integral) or isinstance(value, bool):
        return False
    return smallest <= int(value) <= largest


def whole(name: str, value: object, smallest: int, largest: float = math.inf) -> None:
    """Raise an error unless an argument is an integer in a range, ends included.

    Raises:
        InputError: If it is not.
    """
    bounds = f", {smallest} or more" if largest == math.inf else f" from {smallest} to {largest}"
    check(is_whole(value, smallest, largest), name, value, f"a whole number{bounds}")


def path(name: str, value: str | PathLike[str]) -> Path:
    """Return an argument as a path.

    Raises:
        InputError: If it is not a string or a path.
    """
    of_type(name, value, str | PathLike, "the path of a file or folder")
    return Path(value)


def texts(name: str, value: Iterable[str], allowed: str) -> tuple[str, ...]:
    """Return an argument as a tuple of strings; a single string is refused.

    Raises:
        InputError: If it is not an iterable of strings.
    """
    of_type(name, value, Iterable, allowed)
    check(not isinstance(value, str), name, value, allowed)
    values = tuple(value)
    check(all(map(is_text, values)), name, value, allowed)
    return values


def errors_unless(is_allowed: bool, name: str, value: object, allowed: str) -> list[str]:  # noqa: FBT001
    """Return the error that `check` would raise, as a list of at most one text."""
    return [] if is_allowed else [str(_core.refusal(name, value, allowed))]

"""What is given to functions, seen to where it comes in: told as what is wrong in scenarios is."""

import math
from collections.abc import Iterable
from numbers import Integral
from os import PathLike
from pathlib import Path
from types import UnionType
from typing import TypeGuard

from agent_economy import _core

Kinds = type | UnionType


def check(is_allowed: bool, name: str, given: object, allowed: str) -> None:  # noqa: FBT001
    """See to it that an argument is what is `allowed`, the end of "must be ...".

    Raises:
        InputError: If it is not.
    """
    if not is_allowed:
        raise _core.refusal(name, given, allowed)


def of_kind(name: str, given: object, kinds: Kinds, allowed: str) -> None:
    """See to it that an argument is of one of some kinds.

    Raises:
        InputError: If it is not.
    """
    check(isinstance(given, kinds), name, given, allowed)


def is_text(given: object) -> TypeGuard[str]:
    """Whether something is a text of whole characters, which half of a surrogate pair is not."""
    if not isinstance(given, str):
        return False
    try:
        given.encode()
    except UnicodeEncodeError:
        return False
    else:
        return True


def is_whole(given: object, least: int, greatest: float = math.inf) -> bool:
    """Whether something is a whole number (not a bool) in a range."""
    if not isinstance(given, Integral) or isinstance(given, bool):
        return False
    return least <= int(given) <= greatest


def path(name: str, given: str | PathLike[str]) -> Path:
    """Return the path that an argument is.

    Raises:
        InputError: If it is none.
    """
    of_kind(name, given, str | PathLike, "the path of a file or folder")
    return Path(given)


def texts(name: str, given: Iterable[str], allowed: str) -> tuple[str, ...]:
    """Return the texts of a list; one text alone is no list of its letters.

    Raises:
        InputError: If it is no list, or of something else.
    """
    of_kind(name, given, Iterable, allowed)
    check(not isinstance(given, str), name, given, allowed)
    all_given = tuple(given)
    check(all(isinstance(each, str) for each in all_given), name, given, allowed)
    return all_given


def fault(is_allowed: bool, name: str, given: object, allowed: str) -> list[str]:  # noqa: FBT001
    """Return what is wrong with a value, if anything."""
    return [] if is_allowed else [str(_core.refusal(name, given, allowed))]

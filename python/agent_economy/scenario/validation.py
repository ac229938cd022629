"""Checks of arguments; their errors have the form of a scenario's."""

import math
from collections.abc import Callable, Iterable
from numbers import Integral
from os import PathLike
from pathlib import Path
from types import UnionType
from typing import Any, TypeGuard, TypeVar

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.plain import NotPlainError, described, floats, plain

Kinds = type | UnionType
T = TypeVar("T")


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
    # NumPy counts durations as integers.
    if not isinstance(value, Integral) or isinstance(value, bool | np.timedelta64):
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
        InputError: If it is not a string or a path, empty, or cannot be one.
    """
    allowed = "the path of a file or folder"
    of_type(name, value, str | PathLike, allowed)
    check(value != "" and "\0" not in str(value), name, value, allowed)
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


def all_of(calls: Iterable[Callable[[], T]]) -> list[T]:
    """Return the results of all calls.

    Raises:
        InputError: If some raise one; it lists the errors of all.
    """
    results, found = [], []
    for call in calls:
        try:
            results.append(call())
        except InputError as error:
            found.append(error)
    if not found:
        return results
    joined = InputError("\n".join(map(str, found)))
    joined.errors = [each for error in found for each in error.errors]
    raise joined


def plain_value(name: str, value: object) -> Any:
    """Return an argument, or what a user's function returned, as plain Python values.

    Raises:
        InputError: If it contains anything but numbers, strings, True, False, None, and lists and
            dicts of these; as an array with masked values, or a quantity with a unit.
    """
    try:
        return plain(value)
    except NotPlainError as error:
        allowed = "a number, a string, True, False, None, or a list or dict of these"
        message = f"{name}{error.place} = {error.what}: must be {allowed}; {error.fix}"
        raise InputError(message) from None


def number_array(
    subject: str, value: object, shape: tuple[int, ...], meaning: str
) -> NDArray[np.float64]:
    """Return what a user's function returned as a new array of floats.

    Args:
        subject: The first words of an error, such as "the sampler returned".
        value: What it returned.
        shape: The shape that it must have; nothing is repeated.
        meaning: What its numbers mean, for the error.

    Raises:
        InputError: If it is not certainly numbers of that shape.
    """
    allowed = f"numbers of shape {shape}, {meaning}"
    try:
        found = floats(value)
    except NotPlainError as error:
        inside = f"{described(value)} with {error.what} at {error.place}"
        what = inside if error.place else error.what
        message = f"{subject} {what}: must be {allowed}; {error.fix}"
        raise InputError(message) from None
    if found.shape != shape:
        what, fix = f"numbers of shape {found.shape}", shape_fix(found.shape, shape)
        message = f"{subject} {what}: must be {allowed}; {fix}"
        raise InputError(message)
    return found


def shape_fix(given: tuple[int, ...], allowed: tuple[int, ...]) -> str:
    """Return what to do about an array of another shape than allowed."""
    if given == allowed[::-1]:
        return "exchange rows and columns, as in x.T"
    if math.prod(given) == math.prod(allowed):
        return f"use x.reshape{allowed} if it is in this order"
    return "one number for several is not repeated: give each"

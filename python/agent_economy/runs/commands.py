"""What Python brains return, in plain values: what is not certainly what it seems is refused.

The core then checks it against the schema of commands.
"""

from collections.abc import Mapping
from typing import Any

from agent_economy._core import InputError
from agent_economy.plain import PYTHON_NUMBERS, Floats, NotPlainError, floats, is_plain
from agent_economy.scenario import validation

LISTS = {"requests", "acts"}
"""Keys of commands with any number of entries per robot; `row` is the robot of each."""

PLACE = "at"
"""The key of such an entry with two numbers; all others have one."""

WIDTH = 2


def plain_command(at: str, command: object) -> Any:
    """Return the command of one robot or controller in plain values; `at` is its path in errors.

    Raises:
        InputError: If it contains something else.
    """
    # Most commands are plain, and brains in Python take a few microseconds per step.
    return command if is_plain(command) else validation.plain_value(at, command)


def plain_columns(at: str, given: object, rows: int) -> Any:
    """Return the commands of all robots of a kind, or a part of them, with arrays of floats.

    Args:
        at: Their path in errors.
        given: A dict of columns; anything else is returned as it is.
        rows: Number of robots, or of entries.

    Raises:
        InputError: If a column is not certainly numbers, or repeats those of some rows for others.
    """
    if not isinstance(given, Mapping):
        return given
    return {key: plain_column(f"{at}.{key}", key, each, rows) for key, each in given.items()}


def plain_column(at: str, key: str, given: object, rows: int) -> Any:
    """Return what a key of commands has: a column, columns, or messages."""
    if key == "outbox":
        return validation.plain_value(at, given)
    if isinstance(given, Mapping):
        if key in LISTS and "row" not in given:
            return given  # The core reports it.
        if key in LISTS:
            rows = floats_at(f"{at}.row", given["row"], "an array of row numbers").size
        return plain_columns(at, given, rows)
    if type(given) in PYTHON_NUMBERS and key != PLACE:
        return given
    shape, for_all = ((rows, WIDTH), "place") if key == PLACE else ((rows,), "value")
    allowed = f"one {for_all} for all, or an array of shape {shape}"
    found = floats_at(at, given, allowed)
    # The core repeats numbers as NumPy does.
    is_repeated = key == PLACE or found.size == 1
    if is_repeated and key != "row" and found.shape not in {shape, shape[1:]}:
        message = f"{at} = numbers of shape {found.shape}: must be {allowed}"
        raise InputError(message)
    return found


def floats_at(at: str, given: object, allowed: str) -> Floats:
    """Return a column as an array of floats.

    Raises:
        InputError: If it is not certainly numbers.
    """
    try:
        return floats(given)
    except NotPlainError as error:
        message = f"{at}{error.place} = {error.what}: must be {allowed}; {error.fix}"
        raise InputError(message) from None

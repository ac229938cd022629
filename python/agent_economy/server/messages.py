"""Decodes the messages of the page, and reports what is wrong with them."""

import json
from typing import Any, cast, get_args

import msgspec

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.types import page
from agent_economy.types.page import PageMessage

Error = page.InputError
"""An error of input, as the page takes it."""

DECODER = msgspec.json.Decoder(PageMessage)
MESSAGES: dict[str, type[PageMessage]] = {
    str(kind.__struct_config__.tag): kind for kind in get_args(PageMessage)
}
"""The messages of the page by their types."""

ONE_SOURCE = "exactly one of `scenario` and `text`"
"""What a request for a scenario contains."""

ONE_RUN = "exactly one of `scenario`, `text`, `study`, `recording` and `live`"
"""What an `open` contains."""

SHOWN = 80
"""Characters of a message that is not JSON that its error shows."""


def read(text: str) -> PageMessage:
    """Return a message of the page.

    Raises:
        InputError: If it is not one.
    """
    try:
        message: PageMessage = DECODER.decode(text)
    except (msgspec.DecodeError, RecursionError) as error:
        raise refusal(text, error) from None
    if isinstance(message, page.Open):
        check_open(message)
    if isinstance(message, page.Change):
        check_value("change.value", message.value)
    return message


def type_of(message: PageMessage) -> str:
    """Return the type of a message."""
    return str(message.__struct_config__.tag)


def refusal(text: str, error: Exception) -> InputError:
    """Return what is wrong with a message that cannot be decoded."""
    try:
        message: Any = json.loads(text)
    except (ValueError, RecursionError):
        message = text[:SHOWN]
    try:
        check_message(message)
    except InputError as refused:
        return refused
    return InputError(str(error))


def check_message(message: Any) -> None:
    """Raise what is wrong with a message, with its path, the value and what is allowed.

    Raises:
        InputError: If anything is.
    """
    validation.of_type("message", message, dict, "an object with a type, in JSON")
    kind = message.pop("type", None)
    is_known = isinstance(kind, str) and kind in MESSAGES
    validation.check(is_known, "message.type", kind, f"one of {', '.join(MESSAGES)}")
    for name in ("seed", "run"):
        if kind == "open" and message.get(name) is not None:
            number(f"open.{name}", message[name])
    for change in message.get("changes") or () if kind == "open" else ():
        is_change = isinstance(change, list) and len(change) == len(("tick", "path", "value"))
        validation.check(is_change, "open.changes", change, "[tick, path, value]")
    _core.check_page_message(kind, message)


def check_open(message: page.Open) -> None:
    """Check that an `open` names a run, and that its changes have values.

    Raises:
        InputError: If not.
    """
    sources = [message.scenario, message.text, message.study, message.recording]
    given = [each for each in sources if each is not None] + [True] * message.live
    validation.check(len(given) == 1, "open", given, ONE_RUN)
    for _, _, value in message.changes or ():
        check_value("open.changes", value)


def check_value(name: str, value: Any) -> None:
    """Check that a value can be one of a scenario, which has no null.

    Raises:
        InputError: If it cannot.
    """
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    for part in parts:
        check_value(name, part)
    validation.check(value is not None, name, value, "a value of a scenario: not null")


def number(name: str, text: object) -> int:
    """Return the whole number that a string contains; its user checks its bounds.

    Raises:
        InputError: If it contains none.
    """
    is_number = isinstance(text, str) and text.isascii() and text.isdigit() and len(text) <= 20  # noqa: PLR2004
    validation.check(is_number, name, text, 'a whole number as a string, such as "7"')
    return int(str(text))


MAX_ERRORS = 200
"""Maximum number of errors in an answer, which also has their total."""


def errors_of(error: InputError) -> list[Error]:
    """Return the errors of an exception for the page; of many, those of the first lines."""
    keys = page.InputError.__annotations__
    if not error.errors:
        blank: Any = dict.fromkeys(keys) | {"path": "", "allowed": ""}
        return [blank | {"message": escaped(str(error))}]
    rows: Any = error.errors
    if len(rows) > MAX_ERRORS:
        rows = sorted(rows, key=lambda row: row.get("line") or 0)[:MAX_ERRORS]
    return [cast("Error", {key: row[key] for key in keys if key in row}) for row in rows]


def number_of_errors(error: InputError) -> int:
    """Return the number of all errors of an exception."""
    return max(1, len(error.errors))


def escaped(message: str) -> str:
    """Return an error message, in which the path of the server's folder may not be UTF-8."""
    return message.encode(errors="backslashreplace").decode()


def refused(about: str, error: InputError, path: str | None = None) -> page.Refused:
    """Return the message that a message of the page was refused."""
    return {
        "type": "refused",
        "about": about,
        "path": path,
        "errors": errors_of(error),
        "total": number_of_errors(error),
    }

"""The body of a request: its keys, and values of the right type."""

import sys
from collections.abc import Iterable, Mapping
from typing import Any

from agent_economy.live.warden.authority import check_client

Body = Mapping[str, Any]

COMMON = ("token", "client")
"""Keys that every request may have."""


def check_body(body: Body, keys: Iterable[str]) -> None:
    """Refuse a request with an unknown key, or with a client that is none.

    Args:
        body: The body.
        keys: The keys of its path, without those that every request may have.

    Raises:
        ValueError: If it has another key, or its client is not valid.
    """
    allowed = (*COMMON, *keys)
    unknown = [key for key in body if key not in allowed]
    if unknown:
        message = f"{unknown[0]!r} is not a known key: expected one of {', '.join(allowed)}"
        raise ValueError(message)
    if "client" in body:
        check_client(body["client"])


def flag(body: Body, key: str, default: bool | None = None) -> bool:  # noqa: FBT001  (a value)
    """Return a value that is true or false.

    Raises:
        ValueError: If it is neither, or missing without a default.
    """
    value = body.get(key, default)
    if not isinstance(value, bool):
        message = f"{key} must be true or false"
        raise ValueError(message)  # noqa: TRY004  (of the request)
    return value


def number(value: object, name: str) -> float:
    """Return a value that is a finite number.

    Raises:
        ValueError: If it is none.
    """
    match value:
        case bool():
            pass
        # A whole number may be larger than any float; NaN compares as false.
        case int() | float() if abs(value) <= sys.float_info.max:
            return float(value)
    message = f"{name} must be a number"
    raise ValueError(message)

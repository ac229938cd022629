"""The body of a request, and the response to one that has errors."""

import json
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse

from agent_economy._core import InputError
from agent_economy.server.messages import MAX_ERRORS, Error, errors_of, number_of_errors

MAX_BYTES = 1_000_000
"""Maximum size of a request body."""


class RequestBodyError(Exception):
    """A request body cannot be read; `response` contains the reason."""

    def __init__(self, status: int, message: str) -> None:
        """Set the response."""
        super().__init__(message)
        self.response = error_response(InputError(message), status)


async def text(request: Request) -> str:
    """Return the body of a request as text.

    Raises:
        RequestBodyError: If it is too large, or not UTF-8.
    """
    data = bytearray()
    async for part in request.stream():
        data += part
        if len(data) > MAX_BYTES:
            raise RequestBodyError(413, f"The file has more than {MAX_BYTES:,} bytes.")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise RequestBodyError(422, "The file is not UTF-8 text.") from None


async def json_object(request: Request) -> dict[str, Any]:
    """Return the JSON object in the body of a request.

    Raises:
        RequestBodyError: If it is too large, or not a JSON object.
    """
    try:
        body = json.loads(await text(request))
    except (ValueError, RecursionError):
        body = None
    if not isinstance(body, dict):
        raise RequestBodyError(422, "The request body must be a JSON object.")
    return body


def error_response(error: InputError, status: int = 422) -> JSONResponse:
    """Return the response to a request that has errors: the first of them, and their total."""
    return errors_response(errors_of(error), number_of_errors(error), status)


def errors_response(errors: list[Error], total: int, status: int = 422) -> JSONResponse:
    """Return the response to a request that has errors, of which some are known."""
    return JSONResponse({"errors": errors[:MAX_ERRORS], "total": max(total, len(errors))}, status)

"""What comes with a request, and what is wrong with it."""

import json
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse

from agent_economy._core import InputError
from agent_economy.server.messages import Fault, faults_of

MAX_BYTES = 1_000_000
"""What a page sends has no more."""


class RequestBodyError(Exception):
    """What came cannot be taken; `response` says why."""

    def __init__(self, status: int, message: str) -> None:
        """Say what is wrong with all of it."""
        super().__init__(message)
        self.response = refused(faults_of(InputError(message)), status)


async def text(request: Request) -> str:
    """Return the text that came with a request.

    Raises:
        RequestBodyError: If it is too long, or none.
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


async def asked(request: Request) -> dict[str, Any]:
    """Return the object in JSON that came with a request.

    Raises:
        RequestBodyError: If it is too long, or none.
    """
    try:
        said = json.loads(await text(request))
    except (ValueError, RecursionError):
        said = None
    if not isinstance(said, dict):
        raise RequestBodyError(422, "What is asked must be an object, in JSON.")
    return said


def refused(faults: list[Fault], status: int = 422) -> JSONResponse:
    """Return the answer to what is not allowed."""
    return JSONResponse({"faults": faults}, status)

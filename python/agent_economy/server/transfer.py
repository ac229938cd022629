"""How the page and its data are transferred: compressed, and kept by browsers.

The build of the page writes `FILE.br` and `FILE.gz` beside its scripts and styles, whose names
contain a hash of their content. Other responses are compressed when they are sent, if their route
has `COMPRESSED`.
"""

import os
from pathlib import Path

from starlette.datastructures import Headers
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import FileResponse, Response
from starlette.staticfiles import NotModifiedResponse, PathLike, StaticFiles
from starlette.types import Receive, Scope, Send

HASHED = "assets"
"""The folder of the files whose names contain a hash of their content."""

FOREVER, REVALIDATE = "public, max-age=31536000, immutable", "no-cache"
"""Browsers keep a file without another request, or request it again unless it is unchanged."""

ENDINGS = {"br": ".br", "gzip": ".gz"}
"""The endings of compressed files by their content coding, the smallest first."""


class PageFiles(StaticFiles):
    """The files of the page, compressed as far as the client accepts it."""

    async def check_config(self) -> None:
        """Accept that there is no folder: the page can be built while it is served."""

    def file_response(
        self,
        full_path: PathLike,
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Return a file, or its compressed form."""
        file, headers = Path(full_path), Headers(scope=scope)
        codings = [each for each, ending in ENDINGS.items() if is_file(file, ending)]
        extra = {"cache-control": FOREVER if file.parent.name == HASHED else REVALIDATE}
        if codings:
            extra["vary"] = "Accept-Encoding"
        coding = preferred(headers.get("accept-encoding", ""), codings)
        if coding is None:
            response = FileResponse(file, status_code, extra, stat_result=stat_result)
        else:
            extra["content-encoding"] = coding
            response = compressed(file, coding, extra, status_code)
        if self.is_not_modified(response.headers, headers):
            return NotModifiedResponse(response.headers)
        return response


def is_file(file: Path, ending: str) -> bool:
    """Return whether a file has a compressed form."""
    return file.with_name(file.name + ending).is_file()


def compressed(file: Path, coding: str, headers: dict[str, str], status: int) -> FileResponse:
    """Return the compressed form of a file, with the media type of the file."""
    form = file.with_name(file.name + ENDINGS[coding])
    media_type = FileResponse(file).media_type
    return FileResponse(form, status, headers, media_type, stat_result=form.stat())


class Compressed(GZipMiddleware):
    """Compresses responses by gzip, for clients that accept it."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Forward a request, and compress the response to it."""
        accepted = Headers(scope=scope).get("accept-encoding", "")
        if preferred(accepted, ["gzip"]) is None:
            # Starlette's middleware looks for the word only, also in `gzip;q=0`.
            scope = without_codings(scope)
        await super().__call__(scope, receive, send)


COMPRESSED = [Middleware(Compressed)]


def without_codings(scope: Scope) -> Scope:
    """Return a request that accepts no content coding."""
    kept = [pair for pair in scope["headers"] if pair[0] != b"accept-encoding"]
    return {**scope, "headers": kept}


def preferred(accepted: str, codings: list[str]) -> str | None:
    """Return the content coding that a client weights highest (RFC 9110, 12.5.3).

    Args:
        accepted: The field `Accept-Encoding`.
        codings: The codings that there are; of those of equal weight, the first is returned.

    Returns:
        None if the client accepts none of them.
    """
    weights = dict(map(weighted, accepted.split(",")))
    best = max(codings, key=lambda each: weight_of(each, weights), default=None)
    return best if best is not None and weight_of(best, weights) > 0 else None


def weight_of(coding: str, weights: dict[str, float]) -> float:
    """Return the weight of a coding; that of `*` if it is not named."""
    return weights.get(coding, weights.get("*", 0.0))


def weighted(part: str) -> tuple[str, float]:
    """Return the coding in a part of the field, and its weight; 0 if that cannot be read."""
    name, _, parameter = part.partition(";")
    key, _, value = parameter.partition("=")
    if not parameter.strip():
        return name.strip().lower(), 1.0
    try:
        return name.strip().lower(), float(value) if key.strip().lower() == "q" else 0.0
    except ValueError:
        return name.strip().lower(), 0.0

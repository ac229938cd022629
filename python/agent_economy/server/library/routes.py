"""The addresses of the library; KIND is `studies`, `recordings` or `scenarios`.

GET `/api/library/KIND`: title, note, tags and size of all entries. `/api/library/KIND/entry?id=`:
those of one.
POST `/api/library/KIND/label`: `id`, and those of `title`, `note` and `tags` that are to be set.
`/api/library/KIND/duplicate` and `/api/library/KIND/delete`: `id`. `/api/library/undo`: the `token`
of what was deleted.
The response to a request with errors is `errors`, with status 422.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from agent_economy.server.library.kinds import KINDS, Kind
from agent_economy.server.library.library import Library
from agent_economy.server.studies.routes import get, post

Change = Callable[[Kind, dict[str, Any]], Mapping[str, Any]]


@dataclass(frozen=True)
class LibraryRoutes:
    """The addresses of the library."""

    library: Library

    def all(self) -> list[Route]:
        """Return all routes."""
        undo = Route("/api/library/undo", post(self.undo), methods=["POST"])
        return [undo, *(route for kind in KINDS for route in self.of(kind))]

    def of(self, kind: Kind) -> list[Route]:
        """Return the routes of a kind of entries."""
        place = f"/api/library/{kind.name}"
        changes: dict[str, Change] = {
            "label": self.library.set_label,
            "duplicate": self.library.duplicate,
            "delete": self.library.delete,
        }
        return [
            Route(place, get(partial(self.listed, kind))),
            Route(f"{place}/entry", get(partial(self.entry, kind))),
            *(
                Route(f"{place}/{name}", post(partial(responded, change, kind)), methods=["POST"])
                for name, change in changes.items()
            ),
        ]

    def listed(self, kind: Kind, _: dict[str, str]) -> Response:
        """Return all entries of a kind."""
        return JSONResponse({"entries": self.library.listed(kind)})

    def entry(self, kind: Kind, query: dict[str, str]) -> Response:
        """Return an entry."""
        return JSONResponse(self.library.entry(kind, query.get("id")))

    def undo(self, body: dict[str, Any]) -> Response:
        """Restore what was deleted."""
        return JSONResponse(self.library.restore(body))


def responded(change: Change, kind: Kind, body: dict[str, Any]) -> Response:
    """Return the response to a change."""
    return JSONResponse(change(kind, body))

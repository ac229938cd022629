"""The groups of the gallery: what people want to know, and the scenarios to start with."""

from collections.abc import Iterable
from typing import Any

START, YOURS = "Start here", "Your scenarios"
SEARCH = "How many robots search an area?"
MINES = "Mines"
GOALS = "Goals and controllers"
NATURE = "Natural systems"
REAL = "Real robots"

ORDER = (START, YOURS, SEARCH, MINES, GOALS, NATURE, REAL)
"""The groups, in the order of the gallery."""

GROUPS = {
    "search-beliefs": START,
    "warehouse": START,
    "waypoints": START,
    "classic": SEARCH,
    "search": SEARCH,
    "mines": MINES,
    "open-field": MINES,
    "flock": NATURE,
    "bender": REAL,
    "bender-team": REAL,
}
"""The group of each bundled scenario; inside a group, scenarios have this order."""


def grouped(entries: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the entries of the gallery with their groups, in the order of the groups."""
    places = {name: place for place, name in enumerate(GROUPS)}
    rows = [entry | {"group": group_of(entry)} for entry in entries]
    # The sort is stable: files of the user's own stay in the order of their folders.
    return sorted(rows, key=lambda row: (ORDER.index(row["group"]), places.get(row["id"], 0)))


def group_of(entry: dict[str, Any]) -> str:
    """Return the group of an entry."""
    return GROUPS[entry["id"]] if entry["where"] == "bundled" else YOURS

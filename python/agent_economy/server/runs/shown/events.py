"""The kinds of events, with the colours of their marks."""

from agent_economy.types.page import Colour, EventKind


def kind(name: str, label: str, colour: Colour, *, is_on: bool = True) -> EventKind:
    """Return a kind of events."""
    return {"id": name, "label": label, "colour": colour, "is_on": is_on}


EVENTS = (
    kind("found", "Found", "item-found"),
    kind("served", "Served", "cleared"),
    kind("acted", "Acted", "owner-1"),
    kind("marked", "Marked", "owner-2"),
    kind("declared", "Declared", "accent"),
    kind("passed", "Passed", "owner-5"),
    kind("issued", "Issued", "owner-6"),
    kind("awarded", "Awarded", "owner-3"),
    kind("sent", "Sent", "muted", is_on=False),
    kind("collided", "Collided", "robot-collided"),
    kind("stopped", "Stopped", "robot-broken"),
    kind("failed", "Failed", "owner-4"),
    kind("ended", "Ended", "text"),
    kind("changed", "Changed by hand", "robot-warning"),
)
"""The kinds of events, in the order of their filters: those of runs, and the changes of a page."""

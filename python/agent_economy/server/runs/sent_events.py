"""What a page has been sent of the events of its run."""

from typing import Any, cast

from agent_economy.runs.events import Event
from agent_economy.server.runs.run_events import RunEvents
from agent_economy.types.page import EventRow, Events


class SentEvents:
    """The events that a page has been sent."""

    def __init__(self) -> None:
        """Begin with nothing sent."""
        self._events: RunEvents | None = None
        self._revision = self._until = 0

    def since_last(self, events: RunEvents) -> list[Events]:
        """Return the message with what the page has not been sent; none if there is nothing."""
        is_same = events is self._events and events.revision == self._revision
        since = self._until if is_same else 0
        self._events, self._revision, self._until = events, events.revision, events.until
        rows = [row_of(event) for event in events.since(since)]
        if is_same and not rows:
            return []
        return [
            {
                "type": "events",
                "since": since,
                "rows": rows,
                "one_of": events.strides,
            }
        ]


def row_of(event: Event) -> EventRow:
    """Return what a page displays of an event."""
    row: Any = event._asdict()
    return cast("EventRow", row)

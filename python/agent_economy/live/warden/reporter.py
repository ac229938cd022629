"""Prints events in a thread of its own: a reader that does not read must not hold the warden up."""

import queue
import threading
from collections.abc import Callable, Mapping
from typing import Any

MAX_EVENTS = 1000
"""Events that wait for a slow reader; later ones are not printed. The recording has them all."""

LAST_S = 1.0
"""Time that the reader has for the last events."""

Event = Mapping[str, Any]


class Reporter:
    """Passes events on, in order, without ever waiting for their reader."""

    def __init__(self, report: Callable[[Event], None], closed: Callable[[], object]) -> None:
        """Start the thread.

        Args:
            report: Prints an event. It is called in the thread, and may block.
            closed: Is called in the thread, once, when an event cannot be printed any more.
        """
        self._report, self._closed = report, closed
        self._events: queue.Queue[Event | None] = queue.Queue(MAX_EVENTS)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def __call__(self, event: Event) -> None:
        """Take an event; it is dropped if too many wait."""
        if not self._events.full():
            self._events.put_nowait(event)

    def close(self) -> None:
        """Print what waits, for as long as its reader reads it."""
        try:
            self._events.put(None, timeout=LAST_S)
        except queue.Full:
            return
        self._thread.join(LAST_S)

    def _run(self) -> None:
        while (event := self._events.get()) is not None:
            try:
                self._report(event)
            except OSError:
                self._closed()
                break
        # The output is closed: drop the others.
        while event is not None:
            event = self._events.get()

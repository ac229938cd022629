"""Messages that wait until the run arrives at the tick that it is seeking."""

from collections import deque

from msgspec.structs import replace

from agent_economy.types.page import (
    Change,
    ChooseVersion,
    PageMessage,
    Play,
    Redo,
    Seek,
    Step,
    Undo,
)

MAX_PENDING = 256
"""The number of messages that can wait; a page that sends more is not read until there is room."""


class PendingQueue:
    """Deferred messages, in the order in which they were received."""

    def __init__(self) -> None:
        """Begin empty."""
        self._messages: deque[PageMessage] = deque()

    def __bool__(self) -> bool:
        """Whether a message is waiting."""
        return bool(self._messages)

    @property
    def is_full(self) -> bool:
        """Whether no other message can wait."""
        return len(self._messages) >= MAX_PENDING

    def waits(self, message: PageMessage) -> bool:
        """Return whether a message has to wait while the run is seeking.

        A change is made, and playback continues, at the tick that the run is seeking. Another seek
        replaces the current one, and another version is displayed at once, unless a message is
        already waiting.
        """
        moves = isinstance(message, Step | Seek | Undo | Redo | ChooseVersion)
        return isinstance(message, Change | Play) or (moves and bool(self))

    def put(self, message: PageMessage) -> None:
        """Add a message; of changes that replace each other only the last is kept."""
        match (self._messages[-1] if self._messages else None), message:
            case Change(path=path) as last, Change(replaces_last=True) if path == message.path:
                self._messages[-1] = replace(message, replaces_last=last.replaces_last)
            case _:
                self._messages.append(message)

    def take(self) -> PageMessage:
        """Remove and return the first message."""
        return self._messages.popleft()

    def remove_plays(self) -> None:
        """Remove the requests to play: the run was paused since."""
        self._messages = deque(each for each in self._messages if not isinstance(each, Play))

    def clear(self) -> None:
        """Remove all messages."""
        self._messages.clear()

"""What is said to a run that is on its way somewhere, and is done when it is there."""

from collections import deque
from dataclasses import replace

from agent_economy.server.messages import Go, Message, Play, Put, Step, Undo

MOST = 256
"""So much is kept, at most: a page that says more waits."""


class PendingQueue:
    """Messages that wait, in their order."""

    def __init__(self) -> None:
        """Begin with none."""
        self._said: deque[Message] = deque()

    def __bool__(self) -> bool:
        """Whether any waits."""
        return bool(self._said)

    @property
    def is_full(self) -> bool:
        """Whether no more can wait."""
        return len(self._said) >= MOST

    def waits(self, said: Message, *, has_changes: bool) -> bool:
        """Return whether a message waits for a run that is on its way, before changes or not.

        A change is made, and the run goes on, where the way leads to. One that is to go elsewhere
        goes there at once, and the last change is taken back at once, if nothing waits before that.
        """
        if isinstance(said, Undo):
            return has_changes or bool(self)
        return isinstance(said, Put | Play) or (isinstance(said, Step | Go) and bool(self))

    def put(self, said: Message) -> None:
        """Have a message wait; of values instead of each other the last is enough."""
        match (self._said[-1] if self._said else None), said:
            case Put(path=path, instead=instead), Put(instead=True) if path == said.path:
                self._said[-1] = replace(said, instead=instead)
            case _:
                self._said.append(said)

    def take(self) -> Message:
        """Return what is done next."""
        return self._said.popleft()

    def pause(self) -> None:
        """Have the run not go on after all."""
        self._said = deque(each for each in self._said if not isinstance(each, Play))

    def clear(self) -> None:
        """Forget all."""
        self._said.clear()

"""One brain for all robots of a kind: a function on arrays.

Arrays have the names and units of the percept and command of a single brain (see
`agent_economy.runs.brain`), with one entry per robot whose brain steps. Missing numbers are NaN,
with the age NaN; missing integers are -1, and missing booleans False. The range of a ray without
a return is `math.inf`. Enumerations, such as the kind of an act, are numbers in their order.

Lists of different lengths, such as contacts, are concatenated: `row` holds the index of the robot
of each entry in the arrays of robots. Messages are dicts as in the percept and command of a single
brain, each with its `row`; a received one is made when it is read.

`agent_economy.types.arrays` documents each array.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, overload

from agent_economy.scenario import validation
from agent_economy.types.arrays import Commands, Percepts, RowReceived

__all__ = ["Batch", "Commands", "Percepts"]


@dataclass(frozen=True)
class Batch:
    """One brain for all robots of a kind.

    Attributes:
        function: It is called in each step with the percepts of the robots that step, and with a
            dict for its memory, which is empty at the start of a run. It returns their commands.

    Example:
        >>> from agent_economy import Batch, run
        >>> def circles(percepts, memory):
        ...     return {"motion": {"speed_m_s": 0.5, "turn_rate_rad_s": 0.2}}
        >>> run("search", brains={"rover": Batch(circles)}).status
        'incomplete'
    """

    function: Callable[[Percepts, dict[str, Any]], Commands]

    def __post_init__(self) -> None:
        """Check that it can be called.

        Raises:
            InputError: If it cannot.
        """
        validation.check(callable(self.function), "Batch", self.function, "a function on arrays")


class Inbox(Sequence[RowReceived]):
    """Received messages, each of which becomes a dict when it is read."""

    def __init__(self, received: Sequence[RowReceived]) -> None:
        """Take them as the simulation holds them."""
        self._received = received

    def __len__(self) -> int:
        """Return their number."""
        return len(self._received)

    @overload
    def __getitem__(self, index: int) -> RowReceived: ...
    @overload
    def __getitem__(self, index: slice) -> list[RowReceived]: ...
    def __getitem__(self, index: int | slice) -> RowReceived | list[RowReceived]:
        """Return the dict of a message, or a list of several."""
        found = range(len(self))[index]
        if isinstance(found, range):
            return [self._received[each] for each in found]
        return self._received[found]

    def __repr__(self) -> str:
        """Return the dicts of all messages."""
        return repr(list(self))

    def __reduce__(self) -> tuple[type, tuple[list[RowReceived]]]:
        """Return what makes a copy: a list."""
        return list, (list(self),)

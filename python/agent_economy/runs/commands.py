"""Commands of a `Batch`, seen to where they come in, as the compiled part takes them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy.runs import batch
from agent_economy.runs.batch import Floats, Truths, Whole
from agent_economy.scenario import validation

S = TypeVar("S", bound=np.generic)
Shape: TypeAlias = tuple[int, ...]

MOST = 2**16 - 1
"""Of the numbers of sensors, and of kinds of items."""

SENDER = -1
"""In place of an item's kind where a message is about its sender."""

GOAL = -2
"""In place of an item's kind where a message is about a place where its sender wants to be."""

ACTIVE, RELEASED = 0, 2
"""The least and the greatest of what can have become of such a place."""

MAX_OBSERVATIONS = 2**32 - 1


@dataclass(frozen=True)
class Requests:
    """As in `batch.Requests`."""

    row: Whole
    sensor: NDArray[np.uint16]
    on: Truths


@dataclass(frozen=True)
class Outbox:
    """As in `batch.Outbox`."""

    row: Whole
    confidence: Floats
    item_kind: Whole
    at: Floats
    heading_rad: Floats
    observations: NDArray[np.uint32]
    status: NDArray[np.uint8]


@dataclass(frozen=True)
class Commands:
    """As in `batch.Commands`, with an entry for each robot that steps, or for each row."""

    speed_m_s: Floats
    turn_rate_rad_s: Floats
    requests: Requests
    outbox: Outbox


class Table:
    """Arrays by their names, as a function on arrays returned them."""

    def __init__(self, path: str, told: object, names: Mapping[str, object]) -> None:
        """Take what is told; `path` is how faults name it.

        Raises:
            InputError: If it is no dict, or has other names.
        """
        known = ", ".join(names)
        if not isinstance(told, Mapping):
            raise _core.refusal(path, told, f"a dict with {known}")
        for name in told:
            validation.check(
                name in names, f"{path}.{name}", told[name], f"one of the known: {known}"
            )
        self.path, self.told = path, told

    def __contains__(self, name: str) -> bool:
        """Whether there is something of a name."""
        return name in self.told

    def part(self, name: str, names: Mapping[str, object]) -> "Table":
        """Return a table in this one; one that is left out is empty."""
        return Table(f"{self.path}.{name}", self.told.get(name, {}), names)

    def row(self, robots: int) -> Whole:
        """Return the places of the robots that entries are of."""
        shape = (np.size(self.told.get("row", ())),)
        return self.whole("row", shape, (0, robots - 1))

    def whole(self, name: str, shape: Shape, bounds: tuple[int, int]) -> Whole:
        """Return whole numbers within bounds."""
        least, most = bounds
        numbers = self.array(name, shape, np.dtype(np.float64))
        is_allowed = (numbers == np.floor(numbers)) & (numbers >= least) & (numbers <= most)
        self.see(name, numbers, is_allowed, f"a whole number from {least} to {most}")
        return numbers.astype(np.int64)

    def numbers(self, name: str, shape: Shape) -> Floats:
        """Return finite numbers."""
        numbers = self.array(name, shape, np.dtype(np.float64))
        self.see(name, numbers, np.isfinite(numbers), "a finite number")
        return numbers

    def array(self, name: str, shape: Shape, kind: np.dtype[S]) -> NDArray[S]:
        """Return an array with a shape; what is told may be one value for all."""
        told = self.told.get(name)
        if 0 in shape and told is None:
            return np.zeros(shape, kind)
        path, allowed = f"{self.path}.{name}", f"one value for all, or an array of shape {shape}"
        validation.check(told is not None, path, told, allowed)
        try:
            return np.broadcast_to(np.asarray(told, dtype=kind), shape)
        except (OverflowError, TypeError, ValueError):
            raise _core.refusal(path, told, allowed) from None

    def see(self, name: str, array: Floats, is_allowed: Truths, allowed: str) -> None:
        """See to it that all values are allowed; the first that is not is told."""
        if not is_allowed.all():
            place = tuple(np.argwhere(~is_allowed)[0].tolist())
            at = f"{self.path}.{name}{list(place)}"
            raise _core.refusal(at, array[place].item(), allowed)


def commands(path: str, told: object, robots: int) -> Commands:
    """Return what a function on arrays told so many robots to do.

    Raises:
        InputError: If anything in it is wrong; `path` is how that is named.
    """
    table = Table(path, told, batch.Commands.__annotations__)
    motion = table.part("motion", batch.WantedMotion.__annotations__)
    return Commands(
        motion.numbers("speed_m_s", (robots,)),
        motion.numbers("turn_rate_rad_s", (robots,)),
        requests(table, robots) if "requests" in table else NO_REQUESTS,
        outbox(table, robots) if "outbox" in table else NO_MESSAGES,
    )


def requests(commands: Table, robots: int) -> Requests:
    """Return sensors to switch."""
    table = commands.part("requests", batch.Requests.__annotations__)
    row = table.row(robots)
    sensor = table.whole("sensor", row.shape, (0, MOST)).astype(np.uint16)
    return Requests(row, sensor, table.array("on", row.shape, np.dtype(np.bool_)))


def outbox(commands: Table, robots: int) -> Outbox:
    """Return messages to be sent."""
    table = commands.part("outbox", batch.Outbox.__annotations__)
    row = table.row(robots)
    confidence = table.numbers("confidence", row.shape)
    item_kind = table.whole("item_kind", row.shape, (GOAL, MOST))
    at = table.numbers("at", (len(row), 2))
    has_course = np.any(item_kind == SENDER)
    heading_rad = table.numbers("heading_rad", row.shape) if has_course else np.zeros(row.shape)
    observations = np.zeros(row.shape, np.uint32)
    if "observations" in table:
        observations = table.whole("observations", row.shape, (0, MAX_OBSERVATIONS)).astype(
            np.uint32
        )
    status = np.zeros(row.shape, np.uint8)
    if "status" in table:
        status = table.whole("status", row.shape, (ACTIVE, RELEASED)).astype(np.uint8)
    return Outbox(row, confidence, item_kind, at, heading_rad, observations, status)


NOTHING = Table("commands", {}, batch.Commands.__annotations__)
NO_REQUESTS, NO_MESSAGES = requests(NOTHING, 0), outbox(NOTHING, 0)
"""Of most functions, in every step: to make them anew would take as long as all the rest."""

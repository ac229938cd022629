"""Commands of a `Batch`: checked, and as arrays of the types that the compiled part takes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy.runs import batch
from agent_economy.runs.batch import Booleans, Floats, Integers
from agent_economy.scenario import validation

S = TypeVar("S", bound=np.generic)
Shape: TypeAlias = tuple[int, ...]

MAX_INDEX = 2**16 - 1
"""Maximum index of sensors."""

SENDER, DESTINATION = -1, -2
"""Values of `item_kind` in messages about their sender, and about its destination."""

ACTIVE, RELEASED = 0, 2
"""The first and the last commitment status."""

MAX_KIND, MAX_COUNT = 2**8 - 1, 2**32 - 1
"""Maximum kind of an id, and maximum index, number and count of observations."""


@dataclass(frozen=True)
class Requests:
    """As in `batch.Requests`."""

    row: Integers
    sensor: NDArray[np.uint16]
    on: Booleans


@dataclass(frozen=True)
class Outbox:
    """As in `batch.Outbox`."""

    row: Integers
    confidence: Floats
    item_kind: Integers
    at: Floats
    heading_rad: Floats
    observations: NDArray[np.uint32]
    issuer_kind: NDArray[np.uint8]
    issuer_index: NDArray[np.uint32]
    goal_number: NDArray[np.uint32]
    status: NDArray[np.uint8]


@dataclass(frozen=True)
class Commands:
    """As in `batch.Commands`, with one entry per robot that steps, or per row."""

    speed_m_s: Floats
    turn_rate_rad_s: Floats
    requests: Requests
    outbox: Outbox


class Table:
    """Arrays by name, as a function returned them.

    Args:
        path: Path of the table in errors.
        arrays: The returned value.
        names: The allowed names.

    Raises:
        InputError: If it is not a dict, or has other names.
    """

    def __init__(self, path: str, arrays: object, names: Mapping[str, object]) -> None:
        """Check the names."""
        known = ", ".join(names)
        if not isinstance(arrays, Mapping):
            raise _core.refusal(path, arrays, f"a dict with {known}")
        for name in arrays:
            validation.check(name in names, f"{path}.{name}", arrays[name], f"one of {known}")
        self.path, self.arrays = path, arrays

    def __contains__(self, name: str) -> bool:
        """Whether there is an array or table with a name."""
        return name in self.arrays

    def part(self, name: str, names: Mapping[str, object]) -> "Table":
        """Return a table within this one; an omitted one is empty."""
        return Table(f"{self.path}.{name}", self.arrays.get(name, {}), names)

    def row(self, robots: int) -> Integers:
        """Return the indices of the robots of the entries."""
        shape = (np.size(self.arrays.get("row", ())),)
        return self.integers("row", shape, (0, robots - 1))

    def integers(self, name: str, shape: Shape, bounds: tuple[int, int]) -> Integers:
        """Return whole numbers within bounds."""
        low, high = bounds
        numbers = self.array(name, shape, np.dtype(np.float64))
        is_allowed = (numbers == np.floor(numbers)) & (numbers >= low) & (numbers <= high)
        self.check(name, numbers, is_allowed, f"a whole number from {low} to {high}")
        return numbers.astype(np.int64)

    def probabilities(self, name: str, shape: Shape) -> Floats:
        """Return numbers from 0 to 1."""
        numbers = self.array(name, shape, np.dtype(np.float64))
        self.check(name, numbers, (numbers >= 0) & (numbers <= 1), "a number from 0 to 1")
        return numbers

    def numbers(self, name: str, shape: Shape) -> Floats:
        """Return finite numbers."""
        numbers = self.array(name, shape, np.dtype(np.float64))
        self.check(name, numbers, np.isfinite(numbers), "a finite number")
        return numbers

    def array(self, name: str, shape: Shape, kind: np.dtype[S]) -> NDArray[S]:
        """Return an array of a shape; a single value is repeated."""
        value = self.arrays.get(name)
        if 0 in shape and value is None:
            return np.zeros(shape, kind)
        path, allowed = f"{self.path}.{name}", f"one value for all, or an array of shape {shape}"
        validation.check(value is not None, path, value, allowed)
        try:
            return np.broadcast_to(np.asarray(value, dtype=kind), shape)
        except (OverflowError, TypeError, ValueError):
            raise _core.refusal(path, value, allowed) from None

    def check(self, name: str, array: Floats, is_allowed: Booleans, allowed: str) -> None:
        """Raise an error for the first value that is not allowed.

        Raises:
            InputError: If there is one.
        """
        if not is_allowed.all():
            index = tuple(np.argwhere(~is_allowed)[0].tolist())
            at = f"{self.path}.{name}{list(index)}"
            raise _core.refusal(at, array[index].item(), allowed)


def commands(path: str, returned: object, robots: int, item_kinds: int) -> Commands:
    """Return the commands that a function on arrays returned for the robots that step.

    Args:
        path: Path of the commands in errors.
        returned: The returned value.
        robots: Number of robots that step.
        item_kinds: Number of item kinds of the scenario.

    Raises:
        InputError: If the value is not allowed.
    """
    table = Table(path, returned, batch.Commands.__annotations__)
    motion = table.part("motion", batch.MotionCommands.__annotations__)
    return Commands(
        motion.numbers("speed_m_s", (robots,)),
        motion.numbers("turn_rate_rad_s", (robots,)),
        requests(table, robots) if "requests" in table else NO_REQUESTS,
        outbox(table, robots, item_kinds) if "outbox" in table else NO_MESSAGES,
    )


def requests(commands: Table, robots: int) -> Requests:
    """Return the sensors to switch."""
    table = commands.part("requests", batch.Requests.__annotations__)
    row = table.row(robots)
    sensor = table.integers("sensor", row.shape, (0, MAX_INDEX)).astype(np.uint16)
    return Requests(row, sensor, table.array("on", row.shape, np.dtype(np.bool_)))


def outbox(commands: Table, robots: int, item_kinds: int) -> Outbox:
    """Return the messages to send."""
    table = commands.part("outbox", batch.Outbox.__annotations__)
    row = table.row(robots)
    confidence = table.probabilities("confidence", row.shape)
    item_kind = table.integers("item_kind", row.shape, (DESTINATION, item_kinds - 1))
    at = table.numbers("at", (len(row), 2))
    has_heading = np.any(item_kind == SENDER)
    heading_rad = table.numbers("heading_rad", row.shape) if has_heading else np.zeros(row.shape)
    observations = np.zeros(row.shape, np.uint32)
    if "observations" in table:
        observations = table.integers("observations", row.shape, (0, MAX_COUNT)).astype(np.uint32)
    status = np.zeros(row.shape, np.uint8)
    if "status" in table:
        status = table.integers("status", row.shape, (ACTIVE, RELEASED)).astype(np.uint8)
    has_goals = np.any(item_kind == DESTINATION)
    ids = goal_ids(table, row.shape) if has_goals else no_ids(row.shape)
    return Outbox(row, confidence, item_kind, at, heading_rad, observations, *ids, status)


GoalIds: TypeAlias = tuple[NDArray[np.uint8], NDArray[np.uint32], NDArray[np.uint32]]
"""Ids of goals: kinds and indices of their issuers, and their numbers."""


def goal_ids(table: Table, shape: Shape) -> GoalIds:
    """Return the ids of the goals that messages are about."""
    kind = table.integers("issuer_kind", shape, (0, MAX_KIND)).astype(np.uint8)
    index = table.integers("issuer_index", shape, (0, MAX_COUNT)).astype(np.uint32)
    return kind, index, table.integers("goal_number", shape, (0, MAX_COUNT)).astype(np.uint32)


def no_ids(shape: Shape) -> GoalIds:
    """Return the ids of messages that are not about a goal."""
    zeros = np.zeros(shape, np.uint32)
    return zeros.astype(np.uint8), zeros, zeros


EMPTY = Table("commands", {}, batch.Commands.__annotations__)
NO_REQUESTS, NO_MESSAGES = requests(EMPTY, 0), outbox(EMPTY, 0, 0)
"""Most functions return neither. Making them in each step would take as long as the rest."""

"""The passage of a mined lane by vehicles, and the share of its mines that are cleared."""

from typing import Any, Literal, NamedTuple

from agent_economy.types.brain import Point


class ClearedShare(NamedTuple):
    """The share of the mines of a kind that are cleared, as a controller believes it to be.

    Attributes:
        kind: The kind of items.
        cleared: Expected number of mines that have been neutralised.
        left: Expected number of mines that are left.
        share: Mean of the share that is cleared, 0 to 1. A lane without a mine is cleared.
        low: Lower end of the interval that contains the share with a probability of at least 95%.
        high: Its upper end.
    """

    kind: str
    cleared: float
    left: float
    share: float
    low: float
    high: float


class Passage(NamedTuple):
    """A path through a lane, and the risk of the vehicles that drive on it, as stated.

    Attributes:
        path_m: The corners of its middle line, from one short side of the lane to the other.
        width_m: Its width, in metres.
        length_m: Its length, in metres.
        mines: Expected number of mines within its width.
        risks: The probability that each vehicle is destroyed, in their order.
    """

    path_m: list[Point]
    width_m: float
    length_m: float
    mines: float
    risks: list[float]


class Vehicle(NamedTuple):
    """A vehicle that passes a lane.

    Attributes:
        name: vehicle/INDEX; the one with index 0 is ahead.
        at_m: Its position in the world, x and y in metres; the beginning of the path before it has
            entered the lane.
        has_entered: Whether it has entered the lane.
        status: "driving", "passed", or "lost" if a mine has destroyed it.
    """

    name: str
    at_m: Point
    has_entered: bool
    status: Literal["driving", "passed", "lost"]


def stated_passage(passage: dict[str, Any] | None) -> Passage | None:
    """Return a passage as the compiled part returns it, with types."""
    return None if passage is None else Passage(**passage)


def vehicle(values: dict[str, Any]) -> Vehicle:
    """Return a vehicle as the compiled part returns it, with types."""
    values = dict(values)
    return Vehicle(at_m=(values.pop("x_m"), values.pop("y_m")), **values)

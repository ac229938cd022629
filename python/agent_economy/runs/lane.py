"""What controllers believe of the mined lane that they are to clear."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from agent_economy.runs.passage import ClearedShare, Passage, stated_passage
from agent_economy.types.brain import MarkVerdict, Point

Floats = NDArray[np.float64]


class LaneMark(NamedTuple):
    """A place that robots have marked.

    Attributes:
        number: Its number, which never changes.
        at_m: Its position in the world, x and y in metres.
        deviation_m: Standard deviation of the position along each axis, in metres.
        probabilities: Probability of each kind of items there, by kind; the rest is that of
            nothing.
        mine: Probability that it holds a mine that has not been neutralised, 0 to 1.
        verdict: The last statement about it: "confirmed", "rejected", "isolated", "neutralised" or
            "missed" (by a charge); None if there is none.
        failed_charges: Number of charges that have gone off there and destroyed nothing.
    """

    number: int
    at_m: Point
    deviation_m: float
    probabilities: dict[str, float]
    mine: float
    verdict: MarkVerdict | None
    failed_charges: int


class LaneRisk(NamedTuple):
    """The remaining risk of a lane.

    Attributes:
        unmarked: Expected number of mines without a mark.
        marked: Expected number of mines at marks.
        probability: Probability that at least one mine is left in the lane, 0 to 1.
    """

    unmarked: float
    marked: float
    probability: float


class LaneStatement(NamedTuple):
    """What a controller has stated about a lane. It states it once.

    Attributes:
        is_clear: Whether it has declared the lane clear; otherwise it has given it up.
        risk: The probability that at least one mine is left, at that time.
        at_s: That time on its clock, in seconds.
    """

    is_clear: bool
    risk: float
    at_s: float


class BelievedLane(NamedTuple):
    """What a controller believes of a lane.

    Attributes:
        controller: Name of the controller, KIND/INDEX.
        corners_m: The lower left and the upper right corner of the lane, in metres.
        cell_m: Side of a cell, in metres. The last cells of rows and columns may reach beyond the
            lane.
        unmarked: Expected number of mines without a mark in each cell, shape (rows, columns), the
            lowest row first.
        expected: The same with the mines at marks, distributed as their positions are.
        marks: The places that robots have marked, by number.
        risk: The remaining risk.
        declare_below: The lane is declared clear when the probability that at least one mine is
            left is below this.
        cleared_below_per_m2: Expected number of mines per square metre below which a place is
            cleared: with that density everywhere, the lane would just be declared clear.
        statement: What the controller has stated about the lane; None until then.
        clearance: The share of the mines that are cleared, for each kind that makes the lane
            unsafe.
        passage: The path on which vehicles are to pass; None until the controller has stated one.
    """

    controller: str
    corners_m: tuple[Point, Point]
    cell_m: float
    unmarked: Floats
    expected: Floats
    marks: list[LaneMark]
    risk: LaneRisk
    declare_below: float
    cleared_below_per_m2: float
    statement: LaneStatement | None
    clearance: list[ClearedShare]
    passage: Passage | None

    @property
    def area_m2(self) -> Floats:
        """Area of each cell that is in the lane, shape (rows, columns), in square metres."""
        rows, columns = self.expected.shape
        (left, low), (right, high) = self.corners_m
        widths = np.diff(np.minimum(left + self.cell_m * np.arange(columns + 1), right))
        heights = np.diff(np.minimum(low + self.cell_m * np.arange(rows + 1), high))
        area_m2: Floats = np.outer(heights, widths)
        return area_m2

    @property
    def cleared(self) -> NDArray[np.bool_]:
        """Whether each cell is cleared, shape (rows, columns): see `cleared_below_per_m2`."""
        cleared: NDArray[np.bool_] = self.expected < self.cleared_below_per_m2 * self.area_m2
        return cleared


def believed_lane(lane: dict[str, Any]) -> BelievedLane:
    """Return a lane as the compiled part returns it, with types."""
    statement = lane["statement"]
    return BelievedLane(
        **{
            **lane,
            "corners_m": tuple(lane["corners_m"]),
            "marks": [lane_mark(mark) for mark in lane["marks"]],
            "risk": LaneRisk(**lane["risk"]),
            "statement": None if statement is None else LaneStatement(**statement),
            "clearance": [ClearedShare(**share) for share in lane["clearance"]],
            "passage": stated_passage(lane["passage"]),
        }
    )


def lane_mark(mark: dict[str, Any]) -> LaneMark:
    """Return a mark as the compiled part returns it, with types."""
    values = dict(mark)
    return LaneMark(at_m=(values.pop("x_m"), values.pop("y_m")), **values)

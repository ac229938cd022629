"""What robots with minds believe and want."""

from typing import Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from agent_economy.runs.robots import Point, RobotId


class Pose(TypedDict):
    """Where a robot believes itself to be.

    Attributes:
        at: In the world.
        heading_rad: 0 along x, anticlockwise, from -pi to pi.
        deviation_m: Standard deviation of its position along each axis.
        deviation_rad: Standard deviation of its course.
        age_s: Time since the last position came in.
    """

    at: Point
    heading_rad: float
    deviation_m: float
    deviation_rad: float
    age_s: float


class BelievedItem(TypedDict):
    """An item, as it is believed to be.

    Attributes:
        kind: Place of its kind in `Body.item_kinds`.
        at: Where in the world.
        deviation_m: Standard deviation of that along each axis.
        confidence: How surely it is there, 0 to 1.
    """

    kind: int
    at: Point
    deviation_m: float
    confidence: float


class BelievedRobot(TypedDict):
    """A robot, or what else moves, as it is believed to be.

    Attributes:
        id: Which, if it is known for one.
        at: From the robot's front, in metres.
        velocity_m_s: Over ground, along the robot's front and left.
        age_s: Time since it was last seen.
    """

    id: RobotId | None
    at: Point
    velocity_m_s: Point
    age_s: float


class GoalState(TypedDict):
    """A goal.

    Attributes:
        behaviour: Place in the brain's list of the behaviour that wants it.
        to: Where in the world.
        precedence: Its utility now: value x likely / (1 + time / 10 s).
        value: What it is worth to be there.
        likely: How likely the battery lasts for it, 0 to 1.
        time_s: Time that the straight way there takes.
        within_m: Nearer than this it is there.
        verdict: What has become of it.
        left_m: The way left in the last step.
        best_m: The least that was left so far.
        stuck_s: It has not come nearer for so long.
        rests_s: It counts as impossible for so long, so that others have their turn.
        is_pursued: Whether the robot goes there now.
    """

    behaviour: int
    to: Point
    precedence: float
    value: float
    likely: float
    time_s: float
    within_m: float
    verdict: Literal["complete", "impossible", "approaching", "receding"]
    left_m: float
    best_m: float
    stuck_s: float
    rests_s: float
    is_pursued: bool


class HeadingOption(TypedDict):
    """A course that a robot looked along, and what it is worth.

    Attributes:
        bearing_rad: From the robot's front, from -pi to pi.
        free_m: It is free so far, as far as the robot looks ahead.
        at: The place that it would get to, from the robot's front.
        utility: Of that place: minus the distance left from there, minus the cost of turning
            there, in metres.
    """

    bearing_rad: float
    free_m: float
    at: Point
    utility: float


class HeadingOptions(TypedDict):
    """The courses that a robot looked along, and which of them it took.

    Attributes:
        to: The next place on its way, from the robot's front.
        taken: Place in `courses` of the one that it took.
        courses: All around, the first ahead, anticlockwise.
    """

    to: Point
    taken: int
    courses: list[HeadingOption]


class BeliefState(TypedDict):
    """What a robot believes and wants at one moment.

    Attributes:
        pose: Where it believes itself to be, once it knows.
        items: Items that it believes in, in the order in which it came to.
        robots: Robots, and what else moves, nearby.
        goals: What it wants, the highest precedence first.
        reach: What the places around it were worth; None if it took no way in its last step.
    """

    pose: Pose | None
    items: list[BelievedItem]
    robots: list[BelievedRobot]
    goals: list[GoalState]
    reach: HeadingOptions | None


class BelievedMap(TypedDict):
    """What a robot believes to fill its mission's field, and where it has not looked.

    Attributes:
        corner: Where the first cell's least corner is, in the world.
        cell_m: Width of a cell.
        occupancy: How likely each cell is filled, in percent; -1 where nothing says either. Shape
            (rows, columns), the lowest row first.
        unseen: How likely an item in each cell would not have been seen, in percent; same shape.
    """

    corner: Point
    cell_m: float
    occupancy: NDArray[np.int8]
    unseen: NDArray[np.uint8]

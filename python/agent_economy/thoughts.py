"""What robots with minds believe and want."""

from typing import Literal, TypedDict

from agent_economy.robots import Point, RobotId


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


class Wanted(TypedDict):
    """A goal.

    Attributes:
        behaviour: Place in the brain's list of the behaviour that wants it.
        to: Where in the world.
        precedence: Its utility now.
        verdict: What has become of it.
    """

    behaviour: int
    to: Point
    precedence: float
    verdict: Literal["complete", "impossible", "approaching", "receding"]


class Thoughts(TypedDict):
    """What a robot believes and wants at one moment.

    Attributes:
        pose: Where it believes itself to be, once it knows.
        items: Items that it believes in, in the order in which it came to.
        robots: Robots, and what else moves, nearby.
        goals: What it wants, the highest precedence first.
    """

    pose: Pose | None
    items: list[BelievedItem]
    robots: list[BelievedRobot]
    goals: list[Wanted]

"""Which robot, and where."""

from collections.abc import Sequence
from typing import TypeAlias, TypedDict

Point: TypeAlias = Sequence[float]
"""[x, y] in metres: in the world, or from a robot's front, as is said there."""


class RobotId(TypedDict):
    """Which robot: the `index`-th of the `kind`-th kind, both counted from 0."""

    kind: int
    index: int

"""Polygons that are larger by a distance."""

import math
from collections.abc import Iterator, Sequence

from agent_economy.types.brain import Point

ARC_RAD = math.radians(15)
"""Outer corners become arcs, of segments of at most this angle."""


def grown(corners: Sequence[Point], by_m: float) -> list[Point]:
    """Return the outline of what is within a distance of an anticlockwise polygon."""
    different = [at for number, at in enumerate(corners) if at != corners[number - 1]]
    rounded = (
        around(different[number - 1], at, different[(number + 1) % len(different)], by_m)
        for number, at in enumerate(different)
    )
    return [point for points in rounded for point in points]


def around(before: Point, at: Point, after: Point, by_m: float) -> Iterator[Point]:
    """Yield the outline at a corner: an arc around an outer one, a corner at an inner one."""
    from_rad, to_rad = direction(before, at), direction(at, after)
    turn_rad = math.remainder(to_rad - from_rad, math.tau)
    if turn_rad < 0:
        # Where the sides that were moved outwards meet; not far away in a notch.
        by_m /= max(math.cos(turn_rad / 2), 0.5)
        from_rad, turn_rad = from_rad + turn_rad / 2, 0.0
    parts = math.ceil(turn_rad / ARC_RAD)
    for part in range(parts + 1):
        right_rad = from_rad + turn_rad * part / max(parts, 1) - math.pi / 2
        yield at[0] + by_m * math.cos(right_rad), at[1] + by_m * math.sin(right_rad)


def direction(start: Point, end: Point) -> float:
    """Return the direction from a point to another."""
    return math.atan2(end[1] - start[1], end[0] - start[0])

"""Whether a point is inside a polygon."""

from collections.abc import Sequence

from agent_economy.live.plan import Point


def is_inside(point: Point, corners: Sequence[Point]) -> bool:
    """Return whether a point is inside a polygon: a ray to the right crosses its edges oddly."""
    x, y = point
    inside = False
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], *corners[:1]], strict=True):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            inside = not inside
    return inside

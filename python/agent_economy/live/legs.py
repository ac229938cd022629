"""Straight ways between waypoints: whether they leave a fence, or come too near to walls.

Only the standard library is used, because the warden checks orders with it.
"""

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from agent_economy.live.plan import Point, Wall

Leg = tuple[Point, Point]
"""Where it begins and ends."""

EDGE_M = 1e-6
"""What is at most this far from the edge of a fence is on it, and therefore inside."""

Box = tuple[float, float, float, float]


def exit_of(leg: Leg, fence: Sequence[Point]) -> Point | None:
    """Return where a leg that begins inside a fence leaves it; None if it stays inside.

    Between two places at which the leg meets an edge, it is either inside or outside. All of these
    parts are judged together, because a fence may have many edges and a leg may meet many of them.
    """
    length_m = math.dist(*leg)
    if length_m == 0.0:
        return None
    edges = list(_edges([_seen_from(leg, length_m, corner) for corner in fence]))
    cuts = sorted({0.0, length_m, *(at for at in _zeros(edges) if 0.0 < at < length_m)})
    parts = list(pairwise(cuts))
    is_in = _are_in([(before + after) / 2 for before, after in parts], edges)
    for (before, after), is_part_in in zip(parts, is_in, strict=True):
        # What is shorter is due to rounding.
        if not is_part_in and after - before > EDGE_M:
            return _place(leg, before / length_m)
    return None


def _seen_from(leg: Leg, length_m: float, point: Point) -> Point:
    """Return a point in the frame of a leg: along it from its begin, and to its left."""
    (x, y), (end_x, end_y) = leg
    along, across = (end_x - x) / length_m, (end_y - y) / length_m
    dx, dy = point[0] - x, point[1] - y
    return dx * along + dy * across, dy * along - dx * across


def _zeros(edges: Iterable[Leg]) -> Iterator[float]:
    """Yield where edges in the frame of a leg meet it."""
    for (u, v), (next_u, next_v) in edges:
        if abs(v) <= EDGE_M:
            yield u
        if (v > 0.0) != (next_v > 0.0):
            yield u + v / (v - next_v) * (next_u - u)


def _are_in(places: Sequence[float], edges: Iterable[Leg]) -> list[bool]:
    """Return whether places on a leg, in order, are inside a fence or on its edge.

    A place is inside if the number of edges to its left is odd.
    """
    is_odd, is_on_edge = [False] * len(places), [False] * len(places)
    for (u, v), (next_u, next_v) in edges:
        low, high = sorted((u, next_u))
        for index in range(bisect_left(places, low), bisect_left(places, high)):
            left_m = v + (places[index] - u) / (next_u - u) * (next_v - v)
            is_on_edge[index] |= abs(left_m) <= EDGE_M
            is_odd[index] ^= left_m > 0.0
    return [odd or on_edge for odd, on_edge in zip(is_odd, is_on_edge, strict=True)]


def is_within(point: Point, fence: Sequence[Point]) -> bool:
    """Return whether a point is inside a fence or on its edge."""
    is_on_edge = any(_distance_m(point, edge) <= EDGE_M for edge in _edges(fence))
    return is_on_edge or is_inside(point, fence)


class Walls:
    """The walls of a world, for questions about many points and legs."""

    def __init__(self, walls: Iterable[Wall]) -> None:
        """Prepare them: most are far from a leg, which their boxes show."""
        self._walls = [(_box(wall.corners_m, wall.radius_m), wall) for wall in walls]

    def near(self, point: Point, margin_m: float) -> tuple[Wall, float] | None:
        """Return the first wall that is nearer to a point than a margin, and its distance."""
        return self.crossed((point, point), margin_m)

    def crossed(self, leg: Leg, margin_m: float) -> tuple[Wall, float] | None:
        """Return the first wall that is nearer to a leg than a margin, and its distance."""
        around = _box(leg, margin_m)
        for box, wall in self._walls:
            if _is_overlapping(around, box) and _is_along(leg, margin_m, box):
                distance_m = _clearance_m(leg, wall)
                if distance_m < margin_m - EDGE_M or distance_m == 0.0:
                    return wall, distance_m
        return None


def _clearance_m(leg: Leg, wall: Wall) -> float:
    """Return the distance of a leg from a wall; 0 inside."""
    if is_inside(leg[0], wall.corners_m):
        return 0.0
    nearest_m = min(_gap_m(leg, edge) for edge in _edges(wall.corners_m))
    return max(0.0, nearest_m - wall.radius_m)


def _gap_m(leg: Leg, edge: Leg) -> float:
    """Return the distance of two lines; parallel ones that overlap have an end on the other."""
    if _is_crossing(leg, edge):
        return 0.0
    (start, end), (corner, next_corner) = leg, edge
    ends = ((start, edge), (end, edge), (corner, leg), (next_corner, leg))
    return min(_distance_m(point, line) for point, line in ends)


def _is_crossing(leg: Leg, edge: Leg) -> bool:
    (x, y), (end_x, end_y) = leg
    (x1, y1), (x2, y2) = edge
    along, across, edge_x, edge_y = end_x - x, end_y - y, x2 - x1, y2 - y1
    turn = along * edge_y - across * edge_x
    if turn == 0.0:
        return False
    at_leg = ((x1 - x) * edge_y - (y1 - y) * edge_x) / turn
    at_edge = ((x1 - x) * across - (y1 - y) * along) / turn
    return 0.0 <= at_leg <= 1.0 and 0.0 <= at_edge <= 1.0


def _distance_m(point: Point, line: Leg) -> float:
    (x, y), (x1, y1), (x2, y2) = point, *line
    along, across = x2 - x1, y2 - y1
    length = along * along + across * across
    share = 0.0
    if length > 0.0:
        share = min(1.0, max(0.0, ((x - x1) * along + (y - y1) * across) / length))
    return math.hypot(x - x1 - share * along, y - y1 - share * across)


def is_inside(point: Point, corners: Sequence[Point]) -> bool:
    """Return whether a point is inside a polygon: a ray to the right crosses its edges oddly."""
    x, y = point
    inside = False
    for (x1, y1), (x2, y2) in _edges(corners):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            inside = not inside
    return inside


def _edges(corners: Sequence[Point]) -> Iterator[Leg]:
    return zip(corners, (*corners[1:], *corners[:1]), strict=True)


def _place(leg: Leg, share: float) -> Point:
    (x, y), (end_x, end_y) = leg
    return x + share * (end_x - x), y + share * (end_y - y)


def _box(points: Sequence[Point], margin_m: float) -> Box:
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return min(xs) - margin_m, min(ys) - margin_m, max(xs) + margin_m, max(ys) + margin_m


def _is_overlapping(one: Box, other: Box) -> bool:
    return one[0] <= other[2] and other[0] <= one[2] and one[1] <= other[3] and other[1] <= one[3]


def _is_along(leg: Leg, margin_m: float, box: Box) -> bool:
    """Return whether a leg passes the circle around a box: long oblique legs overlap many boxes."""
    low_x, low_y, high_x, high_y = box
    reach_m = math.hypot(high_x - low_x, high_y - low_y) / 2
    return _distance_m(((low_x + high_x) / 2, (low_y + high_y) / 2), leg) <= reach_m + margin_m

"""Straight ways against fences and walls."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy import _core
from agent_economy.live.legs import Leg, Walls, exit_of, is_within
from agent_economy.live.plan import Point, Wall

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
NOTCHED = (
    (0.0, 0.0),
    (10.0, 0.0),
    (10.0, 10.0),
    (6.0, 10.0),
    (6.0, 4.0),
    (4.0, 4.0),
    (4.0, 10.0),
    (0.0, 10.0),
)
"""A square with a notch from above, 4 to 6 wide, down to 4."""


@pytest.mark.parametrize(
    ("leg", "left_m"),
    [
        (((1, 8), (9, 8)), (4, 8)),
        (((9, 8), (1, 8)), (6, 8)),
        (((1, 2), (9, 2)), None),
        # Along an edge of the notch, and through two of its corners.
        (((1, 4), (9, 4)), None),
        (((4, 10), (4, 0)), None),
        (((4, 10), (6, 10)), (4, 10)),
        (((2, 2), (2, 2)), None),
        (((2, 2), (12, 2)), (10, 2)),
    ],
)
def test_a_leg_leaves_a_concave_fence_where_it_is_outside_first(
    leg: Leg, left_m: Point | None
) -> None:
    found = exit_of(leg, NOTCHED)
    assert found == (None if left_m is None else pytest.approx(left_m))


COORDINATES = st.floats(0, 10, allow_nan=False) | st.integers(0, 20).map(lambda each: each / 2)
PLACES = st.tuples(COORDINATES, COORDINATES)
"""Halves are often on edges and corners."""


@given(PLACES, PLACES)
def test_legs_between_places_of_a_convex_fence_stay_inside(start: Point, end: Point) -> None:
    assert exit_of((start, end), SQUARE) is None


@given(PLACES, PLACES)
def test_a_leg_that_stays_inside_has_no_place_outside(start: Point, end: Point) -> None:
    if not (is_within(start, NOTCHED) and is_within(end, NOTCHED)):
        return
    (x, y), (end_x, end_y) = start, end
    shares = [index / 200 for index in range(201)]
    places = [(x + share * (end_x - x), y + share * (end_y - y)) for share in shares]
    # What is a millionth outside is on the edge.
    outside = [
        place
        for place, is_in in zip(places, _core.polygon_contains(NOTCHED, places), strict=True)
        if not is_in and not is_within(place, NOTCHED)
    ]
    assert not (outside and exit_of((start, end), NOTCHED) is None)


def test_a_leg_that_touches_many_corners_of_a_fence_takes_the_warden_some_milliseconds() -> None:
    teeth = [(float(x), 100.0 if x % 2 else 1.0) for x in range(1, 999)]
    began_s = time.monotonic()
    assert exit_of(((0.5, 1.0), (998.0, 1.0)), [(0.0, 0.0), *teeth, (999.0, 0.0)]) is None
    assert time.monotonic() - began_s < 0.2


BOX = Wall("box", ((4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0)))
POLE = Wall("pole", ((5.0, 5.0),), 1.0)


@pytest.mark.parametrize(
    ("wall", "point", "distance_m"),
    [
        (BOX, (5, 5), 0.0),
        (BOX, (4, 4), 0.0),
        (BOX, (3.7, 5), 0.3),
        (BOX, (3.5, 5), None),
        (POLE, (5.5, 5), 0.0),
        (POLE, (5, 6.25), 0.25),
        (POLE, (5, 6.5), None),
    ],
)
def test_a_point_nearer_to_a_wall_than_the_margin_is_near_it(
    wall: Wall, point: Point, distance_m: float | None
) -> None:
    found = Walls([wall]).near(point, 0.5)
    if distance_m is None:
        assert found is None
    else:
        assert found is not None
        assert found[0] == wall
        assert found[1] == pytest.approx(distance_m)


@pytest.mark.parametrize(
    ("leg", "is_crossed"),
    [
        (((0, 5), (10, 5)), True),
        (((0, 6.3), (10, 6.3)), True),
        (((0, 6.6), (10, 6.6)), False),
        (((0, 5), (3, 5)), False),
        (((4.5, 5), (5.5, 5)), True),
    ],
)
@pytest.mark.parametrize("wall", [BOX, POLE])
def test_a_leg_crosses_what_it_passes_nearer_than_the_margin(
    wall: Wall, leg: Leg, *, is_crossed: bool
) -> None:
    assert (Walls([wall]).crossed(leg, 0.5) is not None) == is_crossed

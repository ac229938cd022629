"""Designs: which configurations a study compares."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy import InputError
from agent_economy.scenario import Factor
from agent_economy.study import design

TEAM = Factor("robots.wanderer.count", (1, 2, 4))
CONTACT = Factor("contact", ("touch", "ahead"))
RATE = Factor("clock.paints_per_s", (), (41.0, 57.0))


def test_a_factorial_has_all_combinations_and_the_first_factor_varies_slowest() -> None:
    rows = [tuple(point.values()) for point in design.points([TEAM, CONTACT])]
    assert rows == [
        (1, "touch"),
        (1, "ahead"),
        (2, "touch"),
        (2, "ahead"),
        (4, "touch"),
        (4, "ahead"),
    ]
    assert list(design.points([TEAM, CONTACT])[0]) == [TEAM.path, CONTACT.path]


@pytest.mark.parametrize("name", ["factorial", "lhs:5", "sobol:8"])
def test_a_design_without_factors_has_one_configuration(name: str) -> None:
    assert design.points([], name) == [{}]


@pytest.mark.parametrize("name", ["lhs:64", "sobol:64"])
def test_points_fill_a_range_evenly_and_stay_within(name: str) -> None:
    points = design.points([RATE, TEAM], name, seed=3)
    rates = np.array([point[RATE.path] for point in points], dtype=float)
    assert len(points) == 64
    assert rates.min() >= 41
    assert rates.max() <= 57
    # Both designs put equally many points into each half, each quarter, ... of every factor.
    assert np.histogram(rates, bins=8, range=(41, 57))[0].tolist() == [8] * 8
    assert {point[TEAM.path] for point in points} == {1, 2, 4}


@pytest.mark.parametrize("name", ["lhs:100", "sobol:128"])
def test_equal_points_are_one_configuration(name: str) -> None:
    points = design.points([TEAM, CONTACT], name)
    assert len(points) == 6
    assert {tuple(point.values()) for point in points} == {
        (team, contact) for team in TEAM.values for contact in CONTACT.values
    }
    drawn = name.partition(":")[2]
    text = f"{name}: 6 configurations ({drawn} points, some with the same values)"
    assert design.describe(name, len(points)) == text


def test_a_design_is_described_with_its_number_of_distinct_points() -> None:
    assert design.describe("factorial", len(design.points([TEAM]))) == "factorial: 3 configurations"
    assert (
        design.describe("lhs:7", len(design.points([RATE], "lhs:7"))) == "lhs:7: 7 configurations"
    )


@given(st.sampled_from(["lhs:20", "sobol:16"]), st.integers(0, 2**64 - 1))
def test_the_same_factors_design_and_seed_give_the_same_points(name: str, seed: int) -> None:
    factors = [TEAM, RATE, CONTACT]
    points = design.points(factors, name, seed)
    assert points == design.points(factors, name, seed)
    assert points != design.points(factors, name, (seed + 1) % 2**64)


def test_values_keep_their_types() -> None:
    # A whole number that became a float would be rejected as a team size.
    for point in design.points([TEAM, RATE, CONTACT], "lhs:9"):
        assert [type(value) for value in point.values()] == [int, float, str]


def test_too_many_configurations_are_an_error() -> None:
    many = Factor("clock.time_limit_s", tuple(range(1000)))
    with pytest.raises(InputError, match=r"1000 x 1000 values = 1000000 configurations: must be"):
        design.points([many, many])
    assert len(design.points([Factor("clock.time_limit_s", tuple(range(100_000)))])) == 100_000


def test_a_range_in_a_factorial_is_an_error() -> None:
    with pytest.raises(InputError, match="clock.paints_per_s: must be a list of values"):
        design.points([TEAM, RATE])


BASES = Factor("controllers.base.count", (0, 1, 2))
RULE = Factor("controllers.base.allocation", ("nearest", "auction"))
SPEED = Factor("robots.rover.drive.max_speed_m_s", (), (1.0, 2.0))
ROVERS = Factor("robots.rover.count", (0, 3))


def test_without_controllers_or_robots_their_other_factors_are_one_configuration() -> None:
    rows = [tuple(point.values()) for point in design.points([BASES, RULE])]
    assert rows == [(0, "nearest"), (1, "nearest"), (1, "auction"), (2, "nearest"), (2, "auction")]
    # Also where the number varies fastest, and of points that fill a space.
    assert len(design.points([RULE, BASES])) == 5
    points = design.points([ROVERS, SPEED], "lhs:32", seed=1)
    assert [point[SPEED.path] for point in points if point[ROVERS.path] == 0] == [1.0]
    assert len(points) == 17


def test_factors_of_other_kinds_stay_where_a_kind_is_absent() -> None:
    mast = Factor("controllers.mast.allocation", ("nearest", "auction"))
    assert len(design.points([BASES, mast])) == 6

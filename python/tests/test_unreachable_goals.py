"""Goals that a robot cannot reach are given up in time and tried again; others are not given up."""

from itertools import pairwise

import pytest
from goal_attempts import PERIOD_S, outcome
from goal_worlds import CHANGING, REACHABLE, TIME_LIMIT_S, UNREACHABLE

MAX_PATIENCE_S = 120.0
"""A goal is given up within this time after the last cell that made its path longer."""


@pytest.mark.parametrize("family", UNREACHABLE)
def test_a_goal_that_cannot_be_reached_is_given_up_in_time_and_the_next_one_is_reached(
    family: str,
) -> None:
    outcomes = [outcome(family, number) for number in range(6)]
    attempts = [attempt for each in outcomes for attempt in each.impossible]
    assert max(attempt.patience_s for attempt in attempts) <= MAX_PATIENCE_S
    assert sum(attempt.unfounded_restarts for attempt in attempts) == 0
    assert all(attempt.reached_s is not None for each in outcomes for attempt in each.possible)


@pytest.mark.parametrize("family", REACHABLE)
def test_a_goal_that_can_be_reached_by_a_detour_is_not_given_up(family: str) -> None:
    outcomes = [outcome(family, number) for number in range(4)]
    attempts = [attempt for each in outcomes for attempt in each.possible]
    assert all(attempt.reached_s is not None for attempt in attempts)
    assert sum(len(attempt.given_up_s) for attempt in attempts) == 0


def test_a_goal_that_was_given_up_is_tried_again_at_longer_and_longer_intervals() -> None:
    [goal] = outcome("inside a block", 0, to_the_end=True).impossible
    rests_s = [
        tried_s - given_up_s
        for given_up_s, tried_s in zip(goal.given_up_s, goal.tried_s[1:], strict=False)
    ]
    # The first rest ends while the robot still drives to the next waypoint.
    assert all(before < after for before, after in pairwise(rests_s[1:]))
    min_rests_s = [10 * 2.0**failure - PERIOD_S for failure in range(5)]
    assert len(rests_s) == len(min_rests_s)
    assert all(rest_s > min_s for rest_s, min_s in zip(rests_s, min_rests_s, strict=True))


@pytest.mark.parametrize("family", CHANGING)
def test_a_goal_is_reached_after_a_change_that_the_robot_cannot_see_from_where_it_waits(
    family: str,
) -> None:
    outcomes = [outcome(family, number) for number in range(2)]
    assert all(each.possible[0].reached_s is not None for each in outcomes)


def test_a_parked_robot_in_a_wide_aisle_does_not_restart_the_clock_again_and_again() -> None:
    outcomes = [outcome("wide aisle with parked robots", number) for number in range(16)]
    # In this time, the robot also looks for another way around the solid blocks.
    assert max(each.impossible[0].given_up_s[0] for each in outcomes) <= MAX_PATIENCE_S


def test_a_robot_waits_for_most_of_the_time_if_a_goal_cannot_be_reached() -> None:
    [goal] = outcome("closed room", 0, to_the_end=True).impossible
    attempts_s = goal.attempts_s(TIME_LIMIT_S)
    assert len(attempts_s) >= 5
    assert max(attempts_s) <= 120.0
    # All of the walls are observed again each time.
    assert min(attempts_s[1:]) >= 5.0
    assert sum(attempts_s) <= 0.5 * TIME_LIMIT_S

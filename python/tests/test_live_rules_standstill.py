"""A standstill is confirmed only as far as the inputs show it, in fake time."""

import math
from dataclasses import replace

import pytest
from live_cases import forks
from live_story import LEAP_S, PERIODS_S, PLAN, Story

from agent_economy.live.plan import FleetPlan, InputPlan
from agent_economy.live.readings import STOP, Motion, Quantity
from agent_economy.live.rules import Action, Mode, Requests, Sample, faults
from agent_economy.live.rules.standstill import NO_STANDSTILL, observed

GPS = InputPlan("gps", Quantity.POSITION, 3.0, 0.4)


def noisy(noise_m: float) -> FleetPlan:
    """Return the plan with another noise of positions."""
    robot = PLAN.robots[0]
    inputs = tuple(
        replace(each, noise=noise_m) if each.port == "gps" else each for each in robot.inputs
    )
    return replace(PLAN, robots=(replace(robot, inputs=inputs),))


class Field(Story):
    """A robot in open ground, with noise of its positions: only they show a motion straight on."""

    noise_m = 0.4

    def _values(self, port: str) -> tuple[float | None, ...]:
        if port == "sonar":
            return (math.inf,) * 6
        if port == "gps":
            x, y, _ = self.pose
            noise = self.random.gauss
            return (x + noise(0.0, self.noise_m), y + noise(0.0, self.noise_m))
        return super()._values(port)


def stopped(seed: int, noise_m: float, pushed: Motion | None) -> Field:
    """Return a robot that has been stopped and moves all the same, or stands."""
    field = Field(seed, plan=noisy(noise_m))
    field.noise_m = noise_m
    field.started()
    field.pushed = pushed
    field.step(Requests(stop=True))
    return field


def test_a_standstill_is_confirmed_by_positions_of_ten_seconds_with_the_speed_that_they_miss() -> (
    None
):
    for story in forks(Mode.AUTO, 30):
        story.step(Requests(stop=True))
        settled_s = story.time_s + 1.0
        while not story.now.is_confirmed:
            assert story.time_s <= settled_s + 10.0 + 3 * PERIODS_S["gps"]
            story.step(elapsed_s=0.1)
        assert story.time_s >= settled_s + 10.0
        assert story.now.unseen is not None
        # 6.5 standard deviations of the slope of 11 positions with a noise of 0.1 m, and the drift.
        slope = 0.1 / math.sqrt(sum((second - 5) ** 2 for second in range(11)))
        assert story.now.unseen.speed_m_s == pytest.approx(6.5 * slope + 0.1, rel=0.25)
        assert story.now.unseen.turn_rate_rad_s == pytest.approx(math.radians(1.3), rel=0.3)
        assert faults.MOVES_WHILE_STOPPED not in story.now.latched


@pytest.mark.parametrize("speed_m_s", [0.15, 0.25, 0.35, 0.5, 1.0, -0.25])
@pytest.mark.parametrize("noise_m", [0.05, 0.4, 1.0])
def test_no_standstill_is_confirmed_above_the_speed_that_is_stated_beside_it(
    speed_m_s: float, noise_m: float
) -> None:
    for seed in range(12):
        field = stopped(seed, noise_m, Motion(speed_m_s, 0.0))
        for _ in range(400):
            unseen = field.step(elapsed_s=0.1).unseen
            assert unseen is None or unseen.speed_m_s > abs(speed_m_s)


@pytest.mark.parametrize(("speed_m_s", "within_s"), [(0.25, 24.0), (0.35, 17.0), (0.5, 13.0)])
def test_a_runaway_in_open_ground_is_found_and_latched(speed_m_s: float, within_s: float) -> None:
    for seed in range(20):
        field = stopped(seed, 0.4, Motion(speed_m_s, 0.0))
        field.run(1.0 + within_s, LEAP_S)
        assert faults.MOVES_WHILE_STOPPED in field.now.latched, field.pose


def test_a_runaway_after_a_long_standstill_is_found_and_latched() -> None:
    for seed in range(20):
        field = stopped(seed, 0.4, None)
        field.run(60.0, LEAP_S)
        field.pushed = Motion(0.4, 0.0)
        field.run(14.0, LEAP_S)
        assert faults.MOVES_WHILE_STOPPED in field.now.latched


def test_a_held_robot_that_runs_away_is_found_too() -> None:
    field = Field(3, plan=noisy(0.4)).started()
    field.step(Requests(hold=True))
    field.pushed = Motion(0.5, 0.0)
    field.run(11.0, LEAP_S)
    assert faults.MOVES_WHILE_STOPPED in field.now.latched


def test_a_slow_turn_on_the_spot_is_found_by_the_compass() -> None:
    field = stopped(4, 0.4, Motion(0.0, math.radians(3.0)))
    field.run(12.0, LEAP_S)
    assert faults.MOVES_WHILE_STOPPED in field.now.latched


def test_noise_and_drift_of_a_robot_that_stands_are_no_motion() -> None:
    """One in 10 million slopes of noise alone exceeds the limit: none of an hour here."""
    for seed in range(4):
        field = stopped(seed, 0.4, Motion(0.05, 0.0))
        for _ in range(3600):
            assert faults.MOVES_WHILE_STOPPED not in field.step(elapsed_s=LEAP_S).latched


def test_positions_that_cannot_tell_a_slow_motion_confirm_nothing() -> None:
    field = stopped(5, 3.0, None)
    for _ in range(200):
        assert not field.step(elapsed_s=LEAP_S).is_confirmed


def test_without_positions_no_standstill_is_confirmed() -> None:
    robot = PLAN.robots[0]
    inputs = tuple(each for each in robot.inputs if each.port != "gps")
    story = Story(1, plan=replace(PLAN, robots=(replace(robot, inputs=inputs, fence_m=None),)))
    story.started().setpoint = STOP
    for _ in range(100):
        assert not story.step(elapsed_s=LEAP_S).is_confirmed


def test_a_robot_that_moves_again_has_no_confirmed_standstill() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.setpoint = STOP
    story.run(15.0, LEAP_S)
    assert story.now.is_confirmed
    story.setpoint = Motion(0.5, 0.0)
    assert story.step().action is Action.MOVE
    assert not story.now.is_confirmed


def test_headings_around_a_half_turn_have_no_slope() -> None:
    compass = InputPlan("compass", Quantity.HEADING, 1.0, math.radians(0.5))
    standstill = NO_STANDSTILL
    for number in range(300):
        heading_rad = math.remainder(math.radians(179.9 + 0.2 * (number % 2)), math.tau)
        standstill = observed(standstill, Sample(0.1 * number, (heading_rad,)), compass)
        assert not standstill.moves
    assert standstill.unseen == pytest.approx(math.radians(1.0), abs=math.radians(0.4))


def test_positions_before_a_gap_do_not_count() -> None:
    standstill = NO_STANDSTILL
    for second in [*range(20), *range(100, 109)]:
        standstill = observed(standstill, Sample(float(second), (0.01 * second, 0.0)), GPS)
    assert standstill.unseen is None
    assert len(standstill.means) == 9

"""Hold, navigation and the controls of an operator: stories in fake time."""

from dataclasses import replace

import pytest
from live_cases import BOTH, forks
from live_story import DRIVE, LEAP_S, ROBOT, STEP_S, Story

from agent_economy.live.drivers import DRIVERS
from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules import Action, Mode, Requests, Setpoint, faults, update

HOLD, RESUME = Requests(hold=True), Requests(resume=True)


@BOTH
def test_held_robots_stand_at_once_and_move_one_second_after_the_resume(mode: Mode) -> None:
    for story in forks(mode, 20):
        assert story.step(HOLD).motion == STOP
        assert story.now.faults == (faults.HELD,)
        assert story.now.is_armed
        story.controls_neutral().run(0.9)
        story.step(RESUME)
        resumed_s = story.time_s
        while story.now.action is not Action.MOVE:
            assert story.step().is_armed
            assert story.time_s <= resumed_s + 1.0 + 2 * STEP_S
        story.setpoint = DRIVE
        assert story.step().motion == DRIVE


@BOTH
def test_a_hold_of_a_minute_is_no_long_stop(mode: Mode) -> None:
    story = forks(mode, 1)[0]
    story.step(HOLD)
    story.controls_neutral().run(60.0, LEAP_S)
    assert story.now.latched == ()
    story.step(RESUME)
    story.run(1.1)
    assert story.now.action is Action.MOVE


def test_another_fault_during_a_hold_is_a_long_stop_after_five_seconds_as_ever() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.step(HOLD)
    story.run(10.0, LEAP_S)
    story.silent.add("sonar")
    story.run(5.0, LEAP_S)
    assert story.now.is_armed
    story.run(2.0, LEAP_S)
    assert story.now.latched == (faults.LONG_STOP,)


def test_a_hold_wins_over_a_resume_and_a_stop_over_a_hold() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.step(Requests(hold=True, resume=True))
    story.run(2.0)
    assert story.now.action is Action.STOP
    assert story.step(Requests(stop=True, resume=True)).action is Action.LATCHED_STOP
    story.run(3.0)
    assert story.now.latched == (faults.EMERGENCY_STOP,)


def test_a_held_robot_is_not_armed() -> None:
    story = Story(1)
    story.step(HOLD)
    story.run(5.0)
    assert story.arm().blockers == (faults.HELD,)
    assert not story.now.is_armed


def test_without_navigation_a_robot_stands_in_automatic_mode_and_drives_in_manual_mode() -> None:
    off, on = (Requests(navigate={ROBOT: is_on}) for is_on in (False, True))
    story = forks(Mode.AUTO, 1)[0]
    assert story.step(off).motion == STOP
    assert not story.now.navigates
    story.run(60.0, LEAP_S)
    assert story.now.is_armed
    story.step(on)
    story.run(1.1)
    assert story.now.action is Action.MOVE
    by_hand = forks(Mode.MANUAL, 1)[0]
    by_hand.step(off)
    by_hand.run(3.0)
    assert by_hand.now.action is Action.MOVE


def given_by_hand(story: Story, age_s: float, motion: Motion) -> Action:
    """Return what a robot in manual mode does with a setpoint of an age."""
    setpoint = Setpoint(motion, 0, story.time_s - age_s, lifetime_s=10.0)
    story.step()
    memory, robot = story.memory, story.plan.robots[0]
    known = replace(story.known, manual=setpoint)
    inputs = replace(story.inputs, robots={robot.name: known})
    _, outputs = update(memory, story.plan, story.time_s, inputs, Requests())
    return outputs.robots[robot.name].action


def test_a_control_that_is_silent_for_more_than_04_s_stops_the_robot() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    assert given_by_hand(story, 0.37, Motion(0.5)) is Action.MOVE
    assert given_by_hand(story, 0.41, Motion(0.5)) is Action.STOP


def test_values_of_tracks_pass_unchanged_until_an_input_is_stale() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    story.setpoint = Motion(2.0, 0.0, tracks=(200, 200))
    assert story.step().motion.tracks == (200, 200)
    story.silent.add("sonar")
    story.run(1.0)
    assert story.now.motion == Motion(0.2, 0.0)


def settings(**changes: object) -> dict[str, object]:
    defaults = {key: each.default for key, each in DRIVERS["bender"].settings.items()}
    return defaults | changes


@pytest.mark.parametrize(
    ("left", "right", "lines"),
    [
        (150, 150, b"x,3,\n"),
        (175, 175, b"x,2,175,\n"),
        (100, 100, b"x,2,100,\n"),
        (200, 100, b"x,0,200,\nx,1,100,\n"),
        (155, 150, b"x,0,155,\nx,1,150,\n"),
    ],
)
def test_sliders_send_what_they_show(left: int, right: int, lines: bytes) -> None:
    driver = DRIVERS["bender"]
    uneven = settings(reverse_m_s_per_unit=0.013, track_width_m=0.37)
    motion = driver.tracks(left, right, uneven)
    assert motion.is_stop == (left == right == 150)
    sent = driver.stop(uneven) if motion.is_stop else driver.move(motion, uneven)
    assert b"".join(line.data for line in sent) == lines


def test_the_limits_of_the_motors_apply_to_sliders() -> None:
    driver = DRIVERS["bender"]
    limited = settings(max_forward_value=175)
    motion = driver.tracks(200, 150, limited)
    assert b"".join(line.data for line in driver.move(motion, limited)) == b"x,0,175,\nx,1,150,\n"
    assert motion.speed_m_s == pytest.approx(0.25)
    for value in (99, 201):
        with pytest.raises(ValueError, match="whole numbers from 100 to 200"):
            driver.tracks(value, 150, limited)


def test_the_estimate_of_the_battery_falls_faster_while_the_robot_drives() -> None:
    driver = DRIVERS["bender"]
    hours = settings(battery_standing_h=8.0, battery_driving_h=2.0)
    assert driver.used_charge(3600.0, 0.0, hours) == pytest.approx(1 / 8)
    assert driver.used_charge(0.0, 3600.0, hours) == pytest.approx(1 / 2)
    assert driver.used_charge(1e9, 1e9, hours) == 1.0


def test_a_robot_is_not_armed_while_its_controls_are_deflected() -> None:
    story = Story(1, Mode.MANUAL)
    story.step(Requests(mode={ROBOT: Mode.MANUAL}))
    story.run(5.0)
    assert story.arm().blockers == (faults.CONTROLS_DEFLECTED,)
    story.controls_neutral().run(1.1)
    assert story.arm().action is Action.MOVE
    story.setpoint = DRIVE
    assert story.step().motion == DRIVE


@pytest.mark.parametrize("requests", [HOLD, Requests(stop=True), Requests()])
def test_deflected_controls_move_nothing_before_they_have_been_neutral(requests: Requests) -> None:
    """After a hold, a stop and an interruption, the same deflection has no effect any more."""
    for story in forks(Mode.MANUAL, 10):
        if requests == Requests():
            story.setpoint = None
            story.run(1.0)
            story.setpoint = DRIVE
        story.step(requests)
        for _ in range(3):
            story.step(replace(RESUME, release=True))
            story.run(2.0, LEAP_S)
            assert story.arm().action is not Action.MOVE
        story.controls_neutral().run(1.1)
        story.arm()
        assert story.step().action is Action.MOVE
        story.setpoint = DRIVE
        assert story.step().motion == DRIVE


def test_deflected_controls_are_no_long_stop() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    story.setpoint = None
    story.run(1.0)
    story.setpoint = DRIVE
    story.run(20.0, LEAP_S)
    assert story.now.faults == (faults.CONTROLS_DEFLECTED,)
    assert story.now.is_armed

"""The safety rules, in fake time: no robot moves when it must not, and every stop has a reason."""

import math
from dataclasses import replace

import pytest
from live_cases import (
    BOTH,
    CASES,
    FAR_FENCE,
    PHASES,
    SWITCHED,
    forks,
    freezes,
    with_fence,
)
from live_story import DRIVE, LEAP_S, PLAN, ROBOT, STEP_S, Story

from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules import (
    FAULTS,
    Action,
    Inputs,
    Link,
    LoopInputs,
    Mode,
    Requests,
    faults,
    initial,
    update,
)


@pytest.mark.parametrize("port", ["sonar", "compass", "gps", None])
def test_a_short_stop_ends_one_second_after_its_cause(port: str | None) -> None:
    for story in forks(Mode.AUTO):
        if port is None:
            case = next(each for each in CASES if each.fault is faults.NO_SETPOINT)
        else:
            case = next(
                each for each in CASES if (each.fault, each.name) == (faults.STALE_INPUT, port)
            )
        case.react(story)
        story.heal()
        fresh_s = story.time_s if port is None else story.due_s[port]
        for until_s in (fresh_s, fresh_s + 1.0):
            assert all(each.action is Action.STOP for each in story.leaps(until_s - STEP_S / 2))
            story.run(2 * STEP_S)
        while story.now.action is Action.STOP:
            assert story.time_s <= fresh_s + 1.0 + 2 * STEP_S
            story.step()
        assert story.now.action is Action.MOVE
        assert story.time_s >= fresh_s + 1.0


@BOTH
def test_nothing_moves_until_it_is_armed(mode: Mode) -> None:
    for seed in range(PHASES):
        story = Story(seed, mode).controls_neutral()
        story.step(Requests(mode={ROBOT: mode}, release=True))
        for _ in range(16):
            assert story.step(elapsed_s=LEAP_S).action is Action.LATCHED_STOP
        assert story.now.latched[-1] == faults.NOT_ARMED
        assert story.arm().action is Action.MOVE


@BOTH
def test_a_robot_is_not_armed_before_every_input_has_been_fresh_for_a_second(mode: Mode) -> None:
    for seed in range(PHASES):
        story = Story(seed, mode).controls_neutral()
        complete_s = story.time_s if mode is Mode.MANUAL else max(story.due_s.values())
        story.step(Requests(mode={ROBOT: mode}))
        arming = Requests(arm=frozenset({ROBOT}))
        for until_s in (complete_s, complete_s + 1.0):
            for decision in story.leaps(until_s - STEP_S / 2, arming):
                assert decision.action is Action.LATCHED_STOP
                assert decision.blockers
            story.run(2 * STEP_S)
        while story.arm().action is Action.LATCHED_STOP:
            assert story.time_s <= complete_s + 1.0 + 2 * STEP_S
        assert story.time_s >= complete_s + 1.0


def test_an_input_that_never_came_blocks_arming_and_is_named() -> None:
    story = Story(1)
    story.silent.add("gps")
    story.run(3.0)
    decision = story.arm()
    assert decision.action is Action.LATCHED_STOP
    assert [(each.name, each.reason) for each in decision.blockers] == [
        ("missing_input", "gps: no line yet")
    ]


def test_a_robot_whose_gps_never_came_is_driven_slowly_by_hand() -> None:
    story = Story(1, Mode.MANUAL).controls_neutral()
    story.silent.add("gps")
    story.step(Requests(mode={ROBOT: Mode.MANUAL}))
    story.run(3.0)
    assert story.arm().action is Action.MOVE
    story.setpoint = DRIVE
    assert story.step().motion == Motion(0.2, 0.3)
    assert story.now.warnings == (faults.MISSING_INPUT,)


def test_a_refused_arm_request_does_nothing_later() -> None:
    for story in forks(Mode.AUTO, 10):
        story.links["gps"] = lambda _: Link(is_up=False)
        story.step()
        assert story.arm().blockers == (faults.LOST_LINK,)
        story.heal()
        assert story.run(5.0, LEAP_S).now.action is Action.LATCHED_STOP


@BOTH
def test_switching_modes_stops_and_never_moves_by_itself(mode: Mode) -> None:
    for story in forks(mode):
        other = SWITCHED[mode]
        story.mode = other
        story.controls_neutral()
        request = Requests(mode={ROBOT: other}, arm=frozenset({ROBOT}))
        assert story.step(request).action is Action.LATCHED_STOP
        assert story.now.faults == (faults.MODE_CHANGED,)
        assert story.run(2.0, LEAP_S).now.action is Action.LATCHED_STOP
        assert story.now.mode is other
        assert story.arm().action is Action.MOVE


def test_a_switch_to_the_same_mode_changes_nothing() -> None:
    story = forks(Mode.AUTO, 1)[0]
    assert story.step(Requests(mode={ROBOT: Mode.AUTO})).action is Action.MOVE


@BOTH
def test_emergency_stop_wins_over_every_other_request(mode: Mode) -> None:
    for story in forks(mode, 10):
        story.setpoint = STOP
        everything = Requests(
            stop=True, release=True, arm=frozenset({ROBOT}), mode={ROBOT: Mode.MANUAL}
        )
        story.mode = Mode.MANUAL
        assert story.step(everything).action is Action.LATCHED_STOP
        assert story.now.latched[0] == faults.EMERGENCY_STOP
        assert story.run(3.0, LEAP_S).now.blockers == (faults.EMERGENCY_STOP,)


@BOTH
def test_release_together_with_arming_does_not_move(mode: Mode) -> None:
    for story in forks(mode, 10):
        story.step(Requests(stop=True))
        story.run(2.0, LEAP_S)
        both = Requests(release=True, arm=frozenset({ROBOT}))
        assert story.step(both).action is Action.LATCHED_STOP
        assert story.run(3.0, LEAP_S).now.latched == (faults.NOT_ARMED,)


def test_the_graver_action_wins_and_reasons_are_listed_gravest_first() -> None:
    order = [fault.name for fault in FAULTS]
    story = forks(Mode.AUTO, 1)[0]
    story.silent.add("sonar")
    story.setpoint = None
    assert story.run(1.0).now.action is Action.STOP
    assert [each.name for each in story.now.faults] == ["stale_input", "no_setpoint"]
    story.loop.update(is_alive=False, lateness_s=3.0, recording_error="disk full")
    story.links["gps"] = lambda _: Link(is_up=False)
    story.altered["compass"] = lambda _: (math.nan,)
    story.plan = with_fence(FAR_FENCE)
    story.gap_s = 2.0
    story.step(Requests(stop=True))
    assert story.run(0.2).now.action is Action.LATCHED_STOP
    for listed in (story.now.faults, story.now.latched):
        found = [fault.name for fault in listed]
        assert found == sorted(found, key=order.index)
        assert found[0] == "emergency_stop"
        assert len(found) >= 8


def test_a_dead_loop_does_not_stop_a_robot_that_is_driven_by_hand() -> None:
    for story in forks(Mode.MANUAL, 10):
        story.loop["is_alive"] = False
        story.is_loop_silent = True
        assert story.run(10.0, LEAP_S).now.action is Action.MOVE
        assert story.now.warnings == (faults.LOOP_DEAD, faults.LOOP_SILENT)


def test_a_robot_that_leaves_the_fence_stops_at_the_first_line_outside() -> None:
    for story in forks(Mode.AUTO, 10):
        x, y, _ = story.pose
        story.plan = with_fence(((x - 1, y - 1), (x + 1, y - 1), (x + 1, y + 1), (x - 1, y + 1)))
        story.setpoint = Motion(0.5, 0.0)
        while story.step().action is Action.MOVE:
            gps_x, gps_y = (value or 0.0 for value in story.samples["gps"].values)
            assert max(abs(gps_x - x), abs(gps_y - y)) <= 1.0
        assert story.now.faults == (faults.OUTSIDE_FENCE,)


def test_outside_the_fence_only_manual_mode_drives_back() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.plan = with_fence(FAR_FENCE)
    story.run(2.0)
    assert story.arm().action is Action.LATCHED_STOP
    story.mode = Mode.MANUAL
    story.controls_neutral()
    story.step(Requests(mode={ROBOT: Mode.MANUAL}))
    story.run(2.0)
    assert story.arm().action is Action.MOVE
    story.setpoint = DRIVE
    assert story.step().motion == Motion(0.2, 0.3)
    story.plan = PLAN
    assert story.run(2.0).now.motion == Motion(0.5, 0.3)


def test_a_fence_without_an_input_for_positions_is_never_inside() -> None:
    story = Story(1)
    robot = PLAN.robots[0]
    inputs = tuple(each for each in robot.inputs if each.port != "gps")
    story.plan = replace(PLAN, robots=(replace(robot, inputs=inputs),))
    assert story.run(3.0).now.blockers == (faults.OUTSIDE_FENCE,)


@BOTH
def test_a_clock_that_goes_backwards_latches(mode: Mode) -> None:
    for back_s in (0.001, 1.0, 50.0, 1e6):
        for story in forks(mode, 5):
            assert story.step(elapsed_s=-back_s).action is Action.LATCHED_STOP
            assert faults.EVENT_LOOP_GAP in story.now.latched
            story.due_s = dict.fromkeys(story.due_s, story.time_s)
            story.controls_neutral()
            assert story.run(4.0, LEAP_S).now.action is Action.LATCHED_STOP
            assert story.arm().action is Action.MOVE


@BOTH
def test_an_update_after_a_sleep_of_the_machine_latches(mode: Mode) -> None:
    for story in forks(mode, 10):
        assert story.step(elapsed_s=1.01).action is Action.LATCHED_STOP
        assert faults.EVENT_LOOP_GAP in story.now.faults


@BOTH
def test_a_healthy_robot_drives_for_minutes_without_a_fault(mode: Mode) -> None:
    for seed in range(3):
        story = Story(seed, mode).started()
        for motion in (Motion(0.5, 0.3), Motion(1.0, 0.0), Motion(-0.3, -1.0), STOP) * 2:
            story.setpoint = motion
            for _ in range(80):
                story.step(elapsed_s=0.09)
                assert not story.active(), story.now
                assert story.now.motion == motion


@pytest.mark.parametrize("pushed", [Motion(0.5, 0.0), Motion(0.0, 0.3), Motion(-0.2, 0.1)])
def test_a_robot_that_moves_although_stop_is_commanded_is_never_confirmed(pushed: Motion) -> None:
    for story in forks(Mode.AUTO, 10):
        story.pushed = pushed
        story.step(Requests(stop=True))
        for _ in range(50):
            assert not story.step(elapsed_s=LEAP_S).is_confirmed
        assert faults.MOVES_WHILE_STOPPED in story.now.latched


def test_coasting_while_it_settles_is_no_fault() -> None:
    for story in forks(Mode.AUTO, 20):
        story.pushed = Motion(0.5, 0.5)
        story.setpoint = STOP
        story.run(0.9)
        story.pushed = None
        assert story.run(3.0).now.faults == ()


def test_a_standstill_is_not_confirmed_by_inputs_that_do_not_come() -> None:
    for port in ("compass", "gps", "sonar"):
        story = forks(Mode.AUTO, 1)[0]
        story.step(Requests(stop=True))
        story.silent.add(port)
        story.run(PLAN.robots[0].inputs[1].max_age_s + 2.0, LEAP_S)
        assert not story.now.is_confirmed


def test_a_person_passing_one_sonar_is_no_motion() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.step(Requests(stop=True))
    story.run(2.0)
    story.altered["sonar"] = lambda true: (0.5, *true[1:])
    story.run(3.0)
    assert faults.MOVES_WHILE_STOPPED not in story.now.latched


def test_a_standing_robot_has_no_frozen_inputs() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.setpoint = STOP
    for port in ("compass", "gps", "sonar"):
        freezes(port)(story)
    assert story.run(20.0, LEAP_S).now.faults == ()


def test_a_constant_heading_is_not_frozen_while_the_robot_drives_straight_on() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.setpoint = Motion(0.5, 0.0)
    freezes("compass")(story)
    assert story.run(20.0, LEAP_S).now.faults == ()


def test_sonars_that_see_nothing_are_not_frozen() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.altered["sonar"] = lambda _: (math.inf,) * 6
    assert story.run(20.0, LEAP_S).now.faults == ()


def turns_with_pauses_of(pause_s: float) -> Story:
    story = forks(Mode.AUTO, 1)[0]
    for _ in range(4):
        story.setpoint = Motion(heading_rad=1.0)
        story.run(8.0, LEAP_S)
        story.setpoint = Motion(0.5, 0.0)
        story.run(pause_s, LEAP_S)
    return story


def test_turns_that_end_in_time_can_follow_one_another() -> None:
    assert turns_with_pauses_of(1.5).now.action is Action.MOVE


def test_a_turn_that_the_brain_repeats_at_once_has_not_ended() -> None:
    assert faults.TURN_DOES_NOT_END in turns_with_pauses_of(0.2).now.latched


def test_motions_are_limited_to_the_speed_and_turn_rate_of_the_robot() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.setpoint = Motion(7.0, -9.0)
    assert story.step().motion == Motion(1.0, -1.0)


@pytest.mark.parametrize("lifetime_s", [math.nan, math.inf, 1e9, -1.0])
def test_no_setpoint_outlives_the_lifetime_of_the_plan(lifetime_s: float) -> None:
    story = forks(Mode.AUTO, 1)[0]
    assert story.given is not None
    story.given = replace(story.given, lifetime_s=lifetime_s)
    story.setpoint = None
    assert story.run(0.34).now.action is Action.STOP


def test_an_update_changes_no_memory_and_repeats_itself() -> None:
    story = forks(Mode.AUTO, 1)[0]
    before = story.memory
    again = story.fork(0)
    first, second = story.step(Requests(stop=True)), again.fork(0).step(Requests(stop=True))
    assert first == second
    assert again.memory is before
    assert story.memory != before


def test_robots_do_not_affect_one_another() -> None:
    robot = PLAN.robots[0]
    plan = replace(PLAN, robots=(robot, replace(robot, name="rover/1")))
    memory, outputs = update(
        initial(plan),
        plan,
        0.0,
        Inputs({}, LoopInputs(is_alive=True, last_message_s=0.0)),
        Requests(),
    )
    assert set(outputs.robots) == set(memory.robots) == {ROBOT, "rover/1"}
    story = forks(Mode.AUTO, 1)[0]
    story.plan = plan
    assert story.step(Requests(arm=frozenset({"rover/1", "unknown"}))).action is Action.MOVE

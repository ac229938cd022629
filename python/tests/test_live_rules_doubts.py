"""A robot is not armed where it must not be, nor with inputs that cannot be believed."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import pytest
from live_cases import BOTH, CASES, forks
from live_story import DRIVE, FENCE_M, LEAP_S, PLAN, ROBOT, START_M, Story, Values

from agent_economy.live.rules import Action, Mode, Requests, faults

TURNED = {"compass": lambda true: (math.remainder(true[0] + math.pi / 2, math.tau),)}


def shifted(by_m: float) -> dict[str, Callable[[Values], Values]]:
    """Return what alters positions by a distance to the east."""
    return {"gps": lambda true: (float(true[0] or 0.0) + by_m, true[1])}


MOVED = shifted(40.0)


def confirm(port: str) -> Requests:
    return Requests(confirm={ROBOT: {port}})


def arms(story: Story) -> bool:
    """Return whether a robot whose controls are neutral can be armed after some time."""
    story.controls_neutral().run(10.0, LEAP_S)
    return story.arm().action is Action.MOVE


@BOTH
@pytest.mark.parametrize("fence_m", [None, FENCE_M])
@pytest.mark.parametrize("at_m", [(1e7, 9e6), (-1_290_213.0, 141_660.0), (-2.0, 50.0)])
def test_no_robot_is_armed_outside_the_world(
    mode: Mode, fence_m: tuple[tuple[float, float], ...] | None, at_m: tuple[float, float]
) -> None:
    robot = replace(PLAN.robots[0], fence_m=fence_m)
    story = Story(1, mode, plan=replace(PLAN, robots=(robot,)))
    story.altered["gps"] = lambda _: at_m
    story.step(Requests(mode={ROBOT: mode}))
    assert not arms(story)
    reasons = {each.name: each.reason for each in story.now.blockers}
    distance_m = math.hypot(*at_m)
    shown = f"{distance_m / 1000:,.0f} km" if distance_m > 1000 else f"{distance_m:.1f} m"
    assert f"{shown} from the origin of the scenario" in reasons["outside_world"]


def test_noise_at_the_border_of_the_world_is_not_outside() -> None:
    story = Story(1)
    story.plan = replace(PLAN, robots=(replace(PLAN.robots[0], fence_m=None),))
    story.pose = (0.0, START_M[1], 0.0)
    assert arms(story)


def test_a_robot_that_is_driven_out_of_the_world_by_hand_is_driven_back_slowly() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    story.plan = replace(PLAN, size_m=(100.0, 100.0))
    story.run(2.0)
    assert story.now.action is Action.MOVE
    assert story.now.motion.speed_m_s == 0.2
    assert story.now.blockers == (faults.OUTSIDE_WORLD,)


def broken(mode: Mode, fault: faults.Fault, name: str) -> Story:
    """Return a robot after a fault of an input that lasts."""
    story = forks(mode, 1)[0]
    next(each for each in CASES if (each.fault, each.name) == (fault, name)).react(story)
    return story


@pytest.mark.parametrize("port", ["compass", "gps", "sonar"])
def test_a_frozen_input_blocks_arming_until_it_has_changed(port: str) -> None:
    story = broken(Mode.AUTO, faults.FROZEN, port)
    assert not arms(story)
    assert story.now.blockers == (faults.FROZEN,)
    assert story.now.doubted == (port,)
    story.altered.clear()
    assert arms(story)


@pytest.mark.parametrize("altered", [TURNED, MOVED])
def test_a_lasting_jump_blocks_arming_until_it_is_back(altered: dict[str, object]) -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.altered.update(altered)  # type: ignore[arg-type]
    story.run(2.0)
    assert not arms(story)
    assert story.now.blockers == (faults.JUMP,)
    assert story.now.doubted == tuple(altered)
    story.altered.clear()
    assert arms(story)


@pytest.mark.parametrize("altered", [TURNED, MOVED])
def test_an_operator_confirms_a_value_after_a_jump_by_hand(altered: dict[str, object]) -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.altered.update(altered)  # type: ignore[arg-type]
    story.run(2.0)
    for port in {"compass", "gps"} - set(altered):
        story.step(confirm(port))
    assert not arms(story)
    story.step(confirm(next(iter(altered))))
    assert story.now.doubted == ()
    assert arms(story)


def test_an_operator_confirms_a_frozen_value_by_hand() -> None:
    story = broken(Mode.AUTO, faults.FROZEN, "gps")
    story.step(confirm("gps"))
    assert arms(story)


def test_a_spike_of_one_line_is_over_after_a_second() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.altered.update(TURNED)
    while story.now.action is Action.MOVE:
        story.step()
    story.altered.clear()
    story.run(2.0)
    assert story.now.doubted == ()
    assert story.arm().action is Action.MOVE


def test_a_robot_with_a_doubted_input_is_driven_slowly_by_hand() -> None:
    story = forks(Mode.AUTO, 1)[0]
    story.altered.update(TURNED)
    story.run(2.0)
    story.mode = Mode.MANUAL
    story.controls_neutral().step(Requests(mode={ROBOT: Mode.MANUAL}))
    story.run(2.0)
    assert story.arm().action is Action.MOVE
    story.setpoint = DRIVE
    assert story.step().motion.speed_m_s == 0.2
    story.run(30.0, LEAP_S)
    # Driving by hand does not show where north is.
    assert story.now.warnings == (faults.JUMP,)


def test_a_confirmation_of_what_is_not_doubted_changes_nothing() -> None:
    story = forks(Mode.AUTO, 1)[0]
    again = story.fork(0)
    requests = Requests(confirm={ROBOT: {"gps", "nothing"}, "unknown": {"gps"}})
    assert story.fork(0).step(requests) == again.step()


def test_a_frozen_input_that_changes_by_more_than_was_commanded_has_jumped() -> None:
    story = broken(Mode.AUTO, faults.FROZEN, "gps")
    story.altered.update(shifted(80.0))
    assert not arms(story)
    assert story.now.blockers == (faults.JUMP,)


@BOTH
def test_doubts_survive_a_clock_that_goes_backwards(mode: Mode) -> None:
    story = forks(mode, 1)[0]
    story.altered.update(MOVED)
    story.run(2.0)
    story.step(elapsed_s=-0.05)
    story.due_s = dict.fromkeys(story.due_s, story.time_s)
    story.mode = Mode.AUTO
    story.step(Requests(mode={ROBOT: Mode.AUTO}))
    assert not arms(story)
    story.step(confirm("gps"))
    assert arms(story)


def test_repeated_spikes_do_not_make_the_place_before_them_evidence() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    at_m = story.samples["gps"].values
    lines = iter(range(10_000))
    story.altered["gps"] = lambda true: (float(true[0] or 0) + 40.0 * (next(lines) % 2), true[1])
    story.setpoint = replace(DRIVE, turn_rate_rad_s=0.0)
    story.run(30.0, LEAP_S)
    story.altered["gps"] = lambda _: at_m
    story.run(5.0, LEAP_S)
    assert story.now.warnings == (faults.JUMP,)


def test_a_spike_of_a_precise_receiver_is_over_although_the_robot_has_driven_on() -> None:
    robot = PLAN.robots[0]
    inputs = tuple(
        replace(each, noise=0.02) if each.port == "gps" else each for each in robot.inputs
    )
    for seed in range(10):
        story = Story(seed, plan=replace(PLAN, robots=(replace(robot, inputs=inputs),)))
        exact = partial(place, story)
        story.altered["gps"] = exact
        story.started()
        before_s = story.samples["gps"].time_s
        story.altered.update(shifted(30.0))
        while story.samples["gps"].time_s == before_s:
            story.step()
        story.altered["gps"] = exact
        story.run(4.0)
        assert story.now.doubted == ()


def place(story: Story, _: object) -> tuple[float, float]:
    """Return the exact position of a robot."""
    return story.pose[:2]


def test_a_confirmation_of_a_frozen_value_lasts_until_it_is_found_frozen_again() -> None:
    story = broken(Mode.MANUAL, faults.FROZEN, "gps")
    story.controls_neutral().run(1.0)
    story.step(confirm("gps"))
    story.run(10.0, LEAP_S)
    assert story.now.doubted == ()


def test_a_receiver_that_dies_outside_the_world_lets_a_robot_be_driven_home() -> None:
    story = Story(1, Mode.MANUAL)
    story.altered["gps"] = lambda _: (1e7, 9e6)
    story.step(Requests(mode={ROBOT: Mode.MANUAL}))
    assert not arms(story)
    story.silent.add("gps")
    assert arms(story)


def test_the_controls_of_a_new_operator_have_to_be_neutral_first() -> None:
    story = forks(Mode.MANUAL, 1)[0]
    assert story.given is not None
    story.operator += 1
    assert story.step().action is Action.STOP
    assert story.now.faults == (faults.CONTROLS_DEFLECTED,)
    story.controls_neutral().run(1.1)
    story.setpoint = DRIVE
    assert story.step().motion == DRIVE

"""The emulated Bender in its world, stepped without sockets and without waiting."""

import asyncio
import itertools
import math

import pytest
from bender_client import placed, step, stepped

import agent_economy as ae
from agent_economy._core import InputError
from agent_economy.live.emulator import Emulator, Settings
from agent_economy.scenario import Override, Scenario


def visits(simulation: ae.Simulation) -> int:
    """Return the number of waypoints that the robot reaches, in order, as far as it can measure."""
    spec = simulation.scenario.to_dict()["robots"]["bender"]["brain"]["behaviours"][1]
    waypoints, reached = spec["waypoints_m"], 0
    while not simulation.is_over and reached < len(waypoints):
        simulation.step()
        distance_m = math.dist(simulation.poses[0, :2], waypoints[reached])
        reached += distance_m <= spec["within_m"] + 0.6  # three deviations of a fix
    return reached


def test_in_simulation_bender_reaches_both_waypoints_with_each_of_twenty_seeds() -> None:
    assert [visits(ae.Simulation("bender", seed)) for seed in range(20)] == [2] * 20


def pose(emulator: Emulator, robot: int = 0) -> dict[str, float]:
    found: dict[str, float] = emulator.state()["robots"][robot]["pose"]
    return found


def test_a_command_is_latched_until_the_next_and_the_body_limits_its_speed() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    emulator.robots[0].obey("motors", b"x,2,175,", 0)
    step(emulator, 4)
    assert pose(emulator)["x_m"] == pytest.approx(21.9, abs=0.1)
    emulator.robots[0].obey("motors", b"x,2,75,", 0)
    step(emulator, 4)
    assert pose(emulator)["speed_m_s"] == -0.6
    emulator.robots[0].obey("motors", b"x,3,75,", 0)
    step(emulator, 1)
    assert pose(emulator)["speed_m_s"] == 0


def test_between_the_two_lines_of_a_turn_one_track_has_its_old_value() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    robot = emulator.robots[0]
    robot.obey("motors", b"x,2,175,", 0)
    robot.obey("motors", b"x,0,75,", 0)
    assert (robot.tracks.left, robot.tracks.right) == (75, 175)
    robot.obey("motors", b"x,3,", 0)
    robot.obey("motors", b"x,0,75,", 0)
    assert (robot.tracks.left, robot.tracks.right) == (75, 150)
    step(emulator, 1)
    assert pose(emulator)["heading_rad"] > 0.3


def test_each_sonar_measures_in_its_own_direction() -> None:
    # West of the wall, facing north: it is on the right at 1 m, and a border behind.
    settings = {"range_unit_m": 1, "no_echo": "range"}
    emulator = stepped(settings, scenario=placed([[13, 15]], [90]))
    line = emulator.robots[0].line("sonar")
    assert line is not None
    values = [float(each) for each in line.split(b",")]
    expected = [6, 1 / math.sin(math.radians(20)), 1 / math.sin(math.radians(40)), 6, 1, 6]
    assert values == pytest.approx(expected, abs=0.01)


def test_ranges_are_in_feet_and_a_sonar_without_an_echo_has_a_value_of_the_settings() -> None:
    emulator = stepped(scenario=placed([[13, 15]], [90]))
    assert emulator.robots[0].line("sonar") == b"99.00,9.59,5.10,99.00,3.28,99.00"
    emulator.set({"no_echo": "range"})
    assert emulator.robots[0].line("sonar") == b"19.69,9.59,5.10,19.69,3.28,19.69"
    emulator.set({"no_echo": math.inf})
    assert emulator.settings_as_dict()["no_echo"] == "inf"
    assert emulator.robots[0].line("sonar") == b"inf,9.59,5.10,inf,3.28,inf"


def test_robots_in_one_world_see_each_other_by_sonar() -> None:
    scenario = placed([[20, 5], [23, 5]], [90, 180])
    emulator = stepped({"range_unit_m": 1}, scenario=scenario, robots=2)
    first = emulator.robots[0].line("sonar")
    assert first is not None
    assert first.split(b",")[4] == b"2.60"
    emulator.robots[1].obey("motors", b"x,2,175,", 0)
    step(emulator, 3)
    nearer = emulator.robots[0].line("sonar")
    assert nearer is not None
    assert float(nearer.split(b",")[4]) == pytest.approx(2.6 - 1.4, abs=0.1)


def test_the_compass_shows_magnetic_bearings_with_the_mounting_offset() -> None:
    for heading_deg, raw in ((0, b"85.5"), (90, b"355.5"), (180, b"265.5"), (-90, b"175.5")):
        emulator = stepped(scenario=placed([[20, 5]], [heading_deg]))
        assert emulator.robots[0].line("compass") == raw
    emulator.set({"compass_offset_deg": 0})
    assert emulator.robots[0].line("compass") == b"165.5"


@pytest.mark.parametrize("desired_deg", [5.0, 90.0, 200.0, 359.0])
@pytest.mark.parametrize(("frame", "off_deg"), [("raw", -10), ("corrected", 0)])
def test_the_coprocessor_turns_to_a_heading_that_is_10_degrees_off_in_the_raw_frame(
    frame: str, off_deg: float, desired_deg: float
) -> None:
    emulator = stepped({"heading_frame": frame, "turn_tolerance_deg": 0.5}, scenario="bender")
    robot = emulator.robots[0]
    robot.obey("motors", b"x,2,175,", 0)
    assert robot.obey("compass", f"{desired_deg}".encode(), 0) == "obeyed"
    step(emulator, 12)
    raw_deg = robot.raw_compass_deg()
    assert raw_deg is not None
    error_deg = (raw_deg - 10 - desired_deg + 180) % 360 - 180
    assert error_deg == pytest.approx(off_deg, abs=0.6)
    assert robot.coprocessor.desired_deg is None
    assert pose(emulator)["speed_m_s"] == 0


def test_any_motor_line_cancels_a_turn_of_the_coprocessor() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    robot = emulator.robots[0]
    robot.obey("compass", b"270.0", 0)
    step(emulator, 1)
    before = pose(emulator)["heading_rad"]
    robot.obey("motors", b"x,3,", 0)
    step(emulator, 2)
    assert before != 0
    assert pose(emulator)["heading_rad"] == pytest.approx(before, abs=0.05)


def test_noise_can_be_set_while_the_robot_keeps_its_place() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    exact = emulator.robots[0].line("gps")
    emulator.set({"gps_noise_m": 5})
    fixes = set()
    for _ in range(5):
        step(emulator, 0.05)
        fixes.add(emulator.robots[0].line("gps"))
    assert len(fixes - {exact}) == 5
    emulator.set({"gps_noise_m": 0})
    step(emulator, 0.05)
    assert emulator.robots[0].line("gps") == exact


def test_by_default_the_robot_follows_its_motor_lines_late_and_unequally() -> None:
    settings = Settings()
    errors = {name: getattr(settings, name) for name in ("lag_s", "delay_s", "gain_left_right")}
    emulator = stepped(errors, scenario=placed([[5, 5]], [0]))
    emulator.robots[0].obey("motors", b"x,2,175,", 0)
    step(emulator, 0.05)
    assert pose(emulator)["speed_m_s"] == 0
    step(emulator, 3.95)
    # 0.5 m/s after a delay and a lag, along the circle of tracks with a ratio of 1.03.
    skew = 0.03 / 2.03
    length_m = 0.5 * (4 - settings.delay_s - settings.lag_s)
    turned_rad = -2 * skew / settings.track_width_m * length_m
    assert pose(emulator)["heading_rad"] == pytest.approx(turned_rad, abs=1e-3)
    # The limited acceleration of the scenario loses some more.
    chord_m = math.sin(turned_rad / 2) / (turned_rad / 2) * (length_m - 0.03)
    expected_m = 5 + chord_m * math.cos(turned_rad / 2)
    assert pose(emulator)["x_m"] == pytest.approx(expected_m, abs=0.005)


def test_errors_of_the_drive_can_be_set_while_the_robot_keeps_its_motion() -> None:
    emulator = stepped(scenario=placed([[5, 5]], [0]))
    emulator.robots[0].obey("motors", b"x,2,170,", 0)
    step(emulator, 1)
    assert pose(emulator)["speed_m_s"] == pytest.approx(0.4)
    emulator.set({"gain": 1.25, "lag_s": 0.5})
    before = pose(emulator)
    step(emulator, 0.05)
    assert before["speed_m_s"] < pose(emulator)["speed_m_s"] < 0.42
    step(emulator, 5)
    assert pose(emulator)["speed_m_s"] == pytest.approx(0.5, abs=1e-3)
    emulator.set({"lag_s": 0, "gain_left_right": 2, "track_width_m": 1})
    step(emulator, 1)
    turned_rad = -2 / 3 * 0.5
    assert pose(emulator)["heading_rad"] == pytest.approx(turned_rad, abs=0.01)


def test_fixes_drift_slowly_and_far() -> None:
    settings = {"gps_drift_m": 5, "gps_drift_s": 10, "gps_digits": 8}
    emulator = stepped(settings, scenario=placed([[20, 5]], [0]))
    places = []
    for _ in range(1200):
        step(emulator, 0.05)
        at_m = emulator.robots[0].senses.at_m
        assert at_m is not None
        places.append(at_m)
    steps_m = [math.dist(*pair) for pair in itertools.pairwise(places)]
    off_m = [math.dist(place, (20, 5)) for place in places]
    assert max(steps_m) < 0.5
    assert max(off_m) > 5
    emulator.set({"gps_drift_m": 0})
    step(emulator, 0.05)
    assert emulator.robots[0].senses.at_m == pytest.approx((20, 5))


def test_a_setting_that_the_scenario_does_not_allow_changes_nothing() -> None:
    scenario = Scenario.load("bender").changed(
        (Override.at("robots.bender.drive.max_turn_rate_deg_s", 1800, "test"),)
    )
    emulator = stepped(scenario=scenario)
    before = emulator.settings
    with pytest.raises(InputError, match="gain_left_right = 1.5: must be nearer to 1"):
        emulator.set({"gps_drift_m": 1, "gain": 2, "gain_left_right": 1.5})
    assert emulator.settings == before


def test_a_runaway_drives_when_it_is_to_stop_and_otherwise_obeys() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    robot = emulator.robots[0]
    asyncio.run(emulator.fault(0, "motors", "runaway", 0.4))
    assert robot.obey("motors", b"x,3,", 0) == "obeyed"
    assert robot.motion() == (0.4, 0.0)
    robot.obey("motors", b"x,2,160,", 0)
    assert robot.motion() == pytest.approx((0.2, 0.0))


def test_lines_without_effect_are_logged_as_ignored() -> None:
    emulator = stepped()
    robot = emulator.robots[0]
    robot.obey("motors", b"x,2,175,", 0)
    asyncio.run(emulator.fault(0, "motors", "ignore_stop"))
    assert robot.obey("motors", b"x,3,", 0) == "ignored"
    assert robot.tracks.left == 175
    asyncio.run(emulator.fault(0, "motors", "ignore_stop", on=False))
    asyncio.run(emulator.fault(0, "motors", "obey_nothing"))
    assert robot.obey("motors", b"x,2,100,", 0) == "ignored"
    assert robot.tracks.left == 175


@pytest.mark.parametrize(
    ("port", "fault", "value", "line"),
    [
        ("sonar", "nan", None, b"NaN,NaN,NaN,NaN,NaN,NaN"),
        ("gps", "nan", None, b"NaN,NaN,N,NaN,NaN,W"),
        ("compass", "nan", None, b"NaN"),
        ("sonar", "short", 2, b"99.00,9.59"),
        ("gps", "short", None, b"36,35.7241,N"),
        ("sonar", "seven", None, b"99.00,9.59,5.10,99.00,3.28,99.00,99.00"),
        ("compass", "one_digit", 7, b"7"),
        ("compass", "jump", None, b"85.5"),
        ("gps", "jump", 1852, b"36,36.7241,N,121,52.4915,W"),
        ("sonar", "jump", 1, b"99.00,12.87,8.38,99.00,6.56,99.00"),
    ],
)
def test_wrong_values_are_sent_until_they_are_switched_off(
    port: str, fault: str, value: float | None, line: bytes
) -> None:
    emulator = stepped(scenario=placed([[13, 15]], [90]))
    healthy = emulator.robots[0].line(port)
    asyncio.run(emulator.fault(0, port, fault, value))
    changed = emulator.robots[0].line(port)
    assert changed == line != healthy
    asyncio.run(emulator.fault(0, port, fault, on=False))
    assert emulator.robots[0].line(port) == healthy


def test_a_frozen_port_repeats_its_last_line_while_the_robot_moves() -> None:
    emulator = stepped(scenario=placed([[20, 5]], [0]))
    robot = emulator.robots[0]
    first = robot.line("gps")
    asyncio.run(emulator.fault(0, "gps", "freeze"))
    robot.obey("motors", b"x,2,175,", 0)
    step(emulator, 4)
    assert robot.line("gps") == first
    asyncio.run(emulator.fault(0, "gps", "freeze", on=False))
    assert robot.line("gps") != first

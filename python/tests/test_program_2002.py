"""The program of 2002 with its faults, and this program without them, for the same lines."""

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from agent_economy.cli import app
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin, RobotPlan
from agent_economy.live.program_2002 import (
    Control,
    Readings,
    UncaughtError,
    Waypoint,
    bearing_deg,
    compare,
)

ROOT = Path(__file__).resolve().parents[2]
M_PER_MINUTE = 1852.0
HERE = Waypoint(36, 35.716, 121, 52.5002)
SETTINGS = {key: each.default for key, each in DRIVERS["bender"].settings.items()}
PLAN = RobotPlan("bender/0", "bender", "", {}, SETTINGS, (), 0.6, 1.0, 0.2)
ORIGIN = Origin(36.595267, -121.875003)

CLEAR, NEAR_LEFT, NEAR_BOTH = "9,9,9,9,9,9", "2,9,9,9,9,9", "2,2,9,9,9,9"
GPS = "36,35.716,N,121,52.5002,W"

LEFT, RIGHT = ["x,0,75,", "x,1,175,"], ["x,1,75,", "x,0,175,"]

LINES = st.text(st.characters(codec="latin-1"), max_size=20)
"""Lines as recordings have them."""

Lines = list[tuple[str, str]]


def drive(control: Control, lines: Lines) -> Lines:
    """Return what it writes for lines that come in this order; those of a port wait until read."""
    waiting: dict[str, list[str]] = {}
    reads = control.run()
    port = next(reads)
    for source, line in lines:
        waiting.setdefault(source, []).append(line)
        while waiting.get(port):
            port = reads.send(waiting[port].pop(0))
    return control.written


def one_pass(sonar: str = CLEAR, compass: str = "10", gps: str = GPS) -> Lines:
    """Return the lines of one pass of the loop: it reads the GPS twice."""
    return [("gps", gps), ("sonar", sonar), ("compass", compass), ("gps", gps)]


def written(lines: Lines, *, steers: bool = False) -> list[str]:
    """Return what the program writes after its first compass line."""
    sent = drive(Control(Waypoint(), steers=steers), [("compass", "10"), *lines])
    return [line for _, line in sent]


def at_distance(bearing: float, distance_m: float) -> Waypoint:
    """Return a waypoint in a direction from the built-in one."""
    north = distance_m * math.cos(math.radians(bearing)) / M_PER_MINUTE
    east = distance_m * math.sin(math.radians(bearing)) / (M_PER_MINUTE * math.cos(0.628))
    return Waypoint(36, HERE.latitude_min + north, 121, HERE.longitude_min - east)


@given(st.floats(0.5, 359.5))
def test_a_bearing_is_right_except_to_the_south_west_where_it_is_mirrored(bearing: float) -> None:
    if min(bearing % 90, 90 - bearing % 90) < 0.5:
        return
    expected = 450 - bearing if 180 < bearing < 270 else bearing
    assert bearing_deg(HERE, at_distance(bearing, 2000)) == pytest.approx(expected, abs=0.5)


def test_setting_a_waypoint_stores_the_minutes_of_the_longitude_as_degrees() -> None:
    typed = Waypoint().set(36, 35.7, 121, 52.5)
    assert (typed.longitude_deg, typed.longitude_min) == (52.5, 52.5002)
    assert bearing_deg(HERE, typed) == pytest.approx(90, abs=0.1)


def test_waypoint_steering_never_runs() -> None:
    far_off = one_pass(compass="200")
    assert written(far_off * 5) == ["x,2,175,"]
    assert written(far_off, steers=True)[0] == "x,3,"


def test_a_course_error_across_north_is_not_wrapped() -> None:
    # The heading is 358 degrees, the bearing 2: four degrees apart, and taken as 356.
    control = Control(at_distance(2, 1000))
    drive(control, [("compass", "8.0"), *one_pass(compass="8.0")])
    assert control.difference_deg == pytest.approx(356, abs=0.6)


def avoidance(sonar: str, then: str | None = None) -> Lines:
    """Return the lines of a pass that calls for an avoidance, and of the choice of its side."""
    return [*one_pass(sonar), ("sonar", then or sonar)]


def test_one_clear_side_ends_an_avoidance() -> None:
    still_near = [("sonar", NEAR_LEFT), *one_pass()]
    assert written(avoidance(NEAR_BOTH) + still_near) == [
        "x,3,",
        "x,1,75,",
        "x,0,175,",
        "x,2,175,",
    ]


def test_the_direction_of_an_avoidance_is_chosen_once() -> None:
    better_left = [("sonar", "2,1,9,9,1,2")] * 5
    assert written(avoidance(NEAR_BOTH) + better_left) == ["x,3,", "x,1,75,", "x,0,175,"]


@pytest.mark.parametrize("sonar", ["1,9,9,9,9,9", "9,1,9,9,9,9"])
def test_what_is_near_on_either_side_is_avoided(sonar: str) -> None:
    turn = ["x,1,75,", "x,0,175,"] if sonar.startswith("1") else ["x,0,75,", "x,1,175,"]
    assert written(avoidance(sonar)) == ["x,3,", *turn]


@pytest.mark.parametrize("before", ["2,9,9,9,9,5", "9,2,9,9,9,5", "2,2,9,9,1,2", "2,2,9,9,2,1"])
@pytest.mark.parametrize(
    ("sonar", "turn"),
    [("2.5,2,9,9,9,5", LEFT), ("2,2.5,9,9,9,5", RIGHT), ("2,2,9,9,4,5", LEFT), (CLEAR, RIGHT)],
)
def test_the_side_of_an_avoidance_is_chosen_from_the_line_after_the_one_that_calls_for_it(
    before: str, sonar: str, turn: list[str]
) -> None:
    assert written(one_pass(before)) == ["x,3,"]
    assert written(avoidance(before, sonar)) == ["x,3,", *turn]


def test_an_avoidance_that_is_clear_at_once_still_turns_until_the_line_after_that() -> None:
    assert written([*avoidance(NEAR_BOTH, CLEAR), *one_pass()])[-1] == "x,0,175,"
    assert written([*avoidance(NEAR_BOTH, CLEAR), ("sonar", CLEAR), *one_pass()])[-1] == "x,2,175,"


def test_the_heading_that_is_sent_is_the_bearing_from_another_fix() -> None:
    moved = "36,35.73,N,121,52.49,W"
    control = Control(Waypoint(), steers=True)
    sent = drive(control, [("compass", "100"), *one_pass(compass="100")])
    assert sent == [("motors", "x,3,")]  # it stops, and waits for the fix
    there = Readings()
    there.take("gps", moved)
    desired_deg = bearing_deg(there.position, Waypoint())
    control = Control(Waypoint(), steers=True)
    sent = drive(control, [("compass", "100"), *one_pass(compass="100"), ("gps", moved)])
    assert sent == [("motors", "x,3,"), ("compass", f"{desired_deg:.2f}")]
    assert control.bearing_deg == desired_deg
    assert control.difference_deg == pytest.approx(abs(90 - desired_deg))


def test_a_turn_ends_at_the_bearing_from_the_other_fix() -> None:
    aligned = [("gps", GPS), ("compass", "10"), ("compass", "55")]
    lines = [("compass", "200"), *one_pass(compass="200", gps="36,35.73,N,121,52.49,W"), *aligned]
    sent = drive(Control(Waypoint(), steers=True), lines)
    assert sent == [("motors", "x,3,"), ("compass", "45.00"), ("motors", "x,3,")]


def test_what_was_written_before_a_read_stays_in_force_after_it() -> None:
    lines = [("compass", "10"), *avoidance(NEAR_BOTH)]
    stamped = [(float(place), port, line) for place, (port, line) in enumerate(lines)]
    compared = compare(PLAN, ORIGIN, None, messages(stamped))
    turn = [("motors", line) for line in ("x,3,", "x,1,75,", "x,0,175,")]
    assert [list(row.sent_2002) for row in compared.rows] == [[], turn[:1], turn]
    assert compared.waits_for == "sonar"


def test_without_sonar_lines_the_robot_drives_on() -> None:
    without = [("gps", GPS), ("compass", "10")] * 50
    assert written(one_pass() + without) == ["x,2,175,"]


def test_compass_lines_pile_up_when_they_are_faster_than_the_loop() -> None:
    stamped = [(place / 10, port, line) for place, (port, line) in enumerate(compass_at_10_hz(60))]
    compared = compare(PLAN, ORIGIN, None, messages(stamped))
    assert compared.unread["compass"] > 250
    assert compared.waits_for == "gps"


def compass_at_10_hz(seconds: int) -> Lines:
    """Return lines of which the compass sends ten a second and the GPS one."""
    second: Lines = [("compass", "10")] * 5 + [("gps", GPS), ("sonar", CLEAR)]
    return second * seconds


def messages(stamped: list[tuple[float, str, str]]) -> list[dict[str, Any]]:
    """Return lines as a recording has them."""
    return [
        {"type": "line", "robot": "bender/0", "port": port, "t": time_s, "line": line}
        for time_s, port, line in stamped
    ]


@pytest.mark.parametrize(
    ("port", "line"),
    [
        ("gps", "36,35.7,N,121"),
        ("gps", "36,,N,121,52.5"),
        ("gps", "x,35.7,N,121,52.5,W"),
        ("sonar", "1,2,3,4,5,6,7"),
        ("sonar", "1,two"),
    ],
)
def test_a_line_with_an_error_ends_the_control_thread(port: str, line: str) -> None:
    with pytest.raises(UncaughtError):
        Readings().take(port, line)
    frame = frame_of(Origin(36.6, -121.9))
    assert DRIVERS["bender"].parse(port, line.encode(), SETTINGS, frame) is None


def test_a_place_is_always_north_and_west() -> None:
    readings = Readings()
    readings.take("gps", "33,51.0,S,151,12.0,E")
    assert readings.position.position_deg == pytest.approx((33.85, -151.2))


def test_headings_are_reduced_at_the_lower_end_only() -> None:
    readings = Readings()
    headings = []
    for line in ("0.0", "5.0", "10", "359", "375", "north", "7"):
        readings.take("compass", line)
        headings.append(readings.heading_deg)
    assert headings == [350, 355, 0, 349, 365, 365, 365]


def test_a_turn_also_drives_backwards() -> None:
    values = [int(line.split(",")[2]) for line in written(avoidance(NEAR_BOTH))[1:]]
    assert sum(values) / 2 == 125


@given(st.lists(st.tuples(st.sampled_from(["compass", "gps", "sonar"]), LINES)))
def test_any_lines_are_compared_without_an_error(lines: Lines) -> None:
    stamped = [(float(place), port, line) for place, (port, line) in enumerate(lines)]
    compared = compare(PLAN, ORIGIN, (10.0, -5.0), messages(stamped))
    assert all(one.time_s <= other.time_s for one, other in pairwise(compared.rows))


def test_the_course_of_this_program_is_right_and_wrapped_for_the_same_lines() -> None:
    south_west = (-100.0, -100.0)
    lines = [("compass", "10"), *one_pass(compass="350"), *one_pass(compass="350")]
    stamped = [(float(place), port, line) for place, (port, line) in enumerate(lines)]
    (row,) = compare(PLAN, ORIGIN, south_west, messages(stamped)).rows[-1:]
    assert row.course is not None
    assert row.course.bearing_deg == pytest.approx(225, abs=0.5)
    assert row.course.difference_deg == pytest.approx(115, abs=0.5)


def test_a_file_that_is_no_drive_and_steering_alone_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "none.mcap"
    file.write_bytes(b"")
    assert CliRunner().invoke(app, ["replay", str(file), "--as-2002"]).exit_code == 2
    assert CliRunner().invoke(app, ["replay", str(file), "--steering"]).exit_code == 2


def test_the_table_of_faults_names_tests_that_exist() -> None:
    page = (ROOT / "docs" / "replication.md").read_text(encoding="utf-8")
    table = page.partition("## Faults of the control program")[2].partition("\n## ")[0]
    assert re.findall(r"^\| (\d+) \|", table, re.MULTILINE) == [str(n) for n in range(1, 19)]
    tests = {
        *(ROOT / "python" / "tests").glob("test_*.py"),
        *(ROOT / "web" / "tests").glob("*.ts"),
        *(ROOT / "web" / "src").rglob("*.test.ts"),
        *(ROOT / "crates").rglob("*.rs"),
    }
    source = "\n".join(file.read_text(encoding="utf-8") for file in sorted(tests))
    named = re.findall(r"`([^`]+)`", table)
    assert len(named) >= 18
    assert [name for name in named if name not in source] == []

"""Drivers of real robots: the lines that they read and write."""

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy.live.drivers import DRIVERS, LineSplitter
from agent_economy.live.drivers.lines import MAX_LINE_BYTES
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin
from agent_economy.live.readings import STOP, Motion, Quantity, Reading, reading_of

BENDER = DRIVERS["bender"]
ORIGIN = Origin(36.6, -121.9, rotation_deg=20.0, declination_deg=14.5)
FRAME = frame_of(ORIGIN)
DEFAULTS = {key: setting.default for key, setting in BENDER.settings.items()}


def settings(**changes: Any) -> dict[str, Any]:
    """Return the default settings with changes."""
    return DEFAULTS | changes


def read(port: str, line: bytes, **changes: Any) -> Reading | None:
    """Return the reading of a line."""
    return BENDER.parse(port, line, settings(**changes), FRAME)


def heading_deg(line: bytes, **changes: Any) -> float:
    """Return the magnetic bearing of a compass line, without the mounting offset."""
    (heading_rad,) = values("compass", line, **changes)
    assert heading_rad is not None
    return FRAME.magnetic_bearing_deg(heading_rad)


def values(port: str, line: bytes, **changes: Any) -> tuple[float | None, ...]:
    """Return the values of a valid line."""
    reading = read(port, line, **changes)
    assert reading is not None, line
    return reading.values


def sent(motion: Motion, **changes: Any) -> list[bytes]:
    """Return the motor lines of a motion."""
    lines = BENDER.move(motion, settings(**changes))
    assert all(line.port == "motors" for line in lines)
    return [line.data for line in lines]


# Lines


LINES = [b"227.5", b"36,35.716,N,121,52.5002,W", b"1.0,2.0", b"x"]


@pytest.mark.parametrize("end", [b"\n", b"\r", b"\r\n"])
@pytest.mark.parametrize("size", range(1, 60))
def test_lines_are_the_same_in_pieces_of_any_size(end: bytes, size: int) -> None:
    data = b"".join(line + end for line in LINES)
    splitter = LineSplitter()
    pieces = [data[at : at + size] for at in range(0, len(data), size)]
    assert [line for piece in pieces for line in splitter.feed(piece)] == LINES


def test_a_line_without_its_end_is_not_returned_yet() -> None:
    splitter = LineSplitter()
    assert splitter.feed(b"12\n34") == [b"12"]
    assert splitter.feed(b"5") == []
    assert splitter.feed(b"\r\n\n\r6\r") == [b"345", b"6"]


@given(st.lists(st.binary(max_size=80) | st.just(b"0" * 3000), max_size=20))
def test_lines_do_not_depend_on_how_they_are_received(pieces: list[bytes]) -> None:
    splitter, whole = LineSplitter(max_lines=10_000), LineSplitter(max_lines=10_000)
    found = [line for piece in pieces for line in splitter.feed(piece)]
    assert found == whole.feed(b"".join(pieces))
    assert all(0 < len(line) <= MAX_LINE_BYTES for line in found)


@pytest.mark.parametrize("size", [1000, 10**6])
def test_a_line_that_is_too_long_is_dropped_up_to_its_end(size: int) -> None:
    splitter = LineSplitter()
    data = b"1\n" + b"9" * 1500 + b"\n2\n" + b"8" * MAX_LINE_BYTES + b"\n"
    pieces = [data[at : at + size] for at in range(0, len(data), size)]
    found = [line for piece in pieces for line in splitter.feed(piece)]
    assert found == [b"1", b"2", b"8" * MAX_LINE_BYTES]


def test_a_robot_that_sends_no_line_ends_takes_no_memory() -> None:
    splitter = LineSplitter()
    for _ in range(1000):
        assert splitter.feed(b"7" * 1000) == []
    assert len(splitter._rest) <= MAX_LINE_BYTES


# Readings


@pytest.mark.parametrize(
    ("line", "bearing_deg"),
    [
        (b"0", 350.0),
        (b"5", 355.0),
        (b"10", 0.0),
        (b"359", 349.0),
        (b"375", 5.0),
        (b" 227.35 ", 217.35),
        (b"+1e2", 90.0),
        (b".5", 350.5),
    ],
)
def test_a_heading_is_read_without_the_mounting_offset(line: bytes, bearing_deg: float) -> None:
    reading = read("compass", line)
    assert reading is not None
    assert reading.quantity is Quantity.HEADING
    assert math.cos(math.radians(heading_deg(line) - bearing_deg)) == pytest.approx(1.0)
    raw_deg = heading_deg(line, compass_offset_deg=0.0)
    assert math.cos(math.radians(raw_deg - bearing_deg - 10)) == pytest.approx(1.0)


def test_a_heading_is_in_radians_anticlockwise_from_the_x_axis_of_the_world() -> None:
    # The y axis has the true bearing 20, magnetic north 14.5, and the compass is off by 10.
    for turned_deg in (-170, -90, 0, 30, 90, 180):
        line = b"%.1f" % ((90 + 20 - 14.5 + 10 - turned_deg) % 360)
        assert values("compass", line) == pytest.approx((math.radians(turned_deg),))


@pytest.mark.parametrize("line", [b"NaN", b"inf", b"-inf", b"1e999", b"721", b"-361", b"1e30"])
def test_a_bearing_far_outside_the_scale_is_no_heading(line: bytes) -> None:
    (heading_rad,) = values("compass", line)
    assert heading_rad is not None
    assert math.isnan(heading_rad)


@pytest.mark.parametrize(
    ("line", "latitude", "longitude"),
    [
        (b"36,35.716,N,121,52.5002,W", 36.5952667, -121.8750033),
        (b"36,35.716,N,121,52.5002,E", 36.5952667, 121.8750033),
        (b"36,35.716,S,121,52.5002,W", -36.5952667, -121.8750033),
        (b"36,35.716,S,121,52.5002,e", -36.5952667, 121.8750033),
        (b"0,0,N,0,0", 0.0, 0.0),
        (b"36, 35.716, n, 121, 52.5002, w, 9, sats", 36.5952667, -121.8750033),
        (b"36,35.716,N,121,52.5002,9", 36.5952667, -121.8750033),
    ],
)
def test_a_position_is_read_in_all_quadrants(
    line: bytes, latitude: float, longitude: float
) -> None:
    frame = frame_of(Origin(latitude, longitude))
    reading = BENDER.parse("gps", line, settings(), frame)
    assert reading is not None
    assert reading.quantity is Quantity.POSITION
    assert reading.values == pytest.approx((0.0, 0.0), abs=0.01)


def test_a_position_is_in_metres_of_the_world() -> None:
    x_m, y_m = values("gps", b"36,36.6,N,121,54.0,W")  # 0.6 minutes to the north
    assert x_m is not None
    assert y_m is not None
    assert math.hypot(x_m, y_m) == pytest.approx(1109.8, abs=0.5)
    assert math.degrees(math.atan2(x_m, y_m)) == pytest.approx(-20.0, abs=0.01)


@pytest.mark.parametrize(
    "line",
    [
        b"91,0,N,121,52.5,W",
        b"90,0.1,S,121,52.5,W",
        b"36,35.7,N,360,0.1,W",
        b"36,35.7,N,1e9,0,E",
        b"inf,35.7,N,121,52.5,W",
        b"36,35.7,N,NaN,52.5,W",
        b"36,NaN,N,121,52.5,W",
    ],
)
def test_what_is_no_place_on_the_earth_has_no_position(line: bytes) -> None:
    assert all(math.isnan(value) for value in values("gps", line) if value is not None)


def test_a_longitude_may_be_written_up_to_a_full_turn() -> None:
    west = values("gps", b"36,35.7,N,121,52.5,W")
    assert values("gps", b"36,35.7,N,238,7.5,E") == pytest.approx(west, abs=1e-6)


def test_the_hemisphere_of_a_longitude_without_a_letter_is_a_setting() -> None:
    line = b"36,35.716,N,121,52.5002"
    west, east = (values("gps", line + letter) for letter in (b",W", b",E"))
    assert west != east
    assert values("gps", line) == west
    assert values("gps", line, hemisphere="E") == east
    assert values("gps", line + b",W", hemisphere="E") == west


def test_six_ranges_are_in_metres() -> None:
    assert values("sonar", b"1,2,3.5,4,5,0") == pytest.approx(
        (0.3048, 0.6096, 1.0668, 1.2192, 1.524, 0.0)
    )
    assert values("sonar", b"1,2,3,4,5,6", range_unit_m=1) == (1, 2, 3, 4, 5, 6)
    assert values("sonar", b"1,2,3,4,5,6,", range_unit_m=1) == (1, 2, 3, 4, 5, 6)


def test_a_short_line_of_ranges_has_none_for_the_others() -> None:
    assert values("sonar", b"1,2", range_unit_m=1) == (1, 2, None, None, None, None)


@pytest.mark.parametrize(("no_echo", "line"), [(0, b"0.0"), (-1, b"-1"), ("inf", b"Infinity")])
def test_the_value_of_nothing_seen_is_infinite_and_not_a_wall(no_echo: Any, line: bytes) -> None:
    ranges = values("sonar", line + b",2,3,4,5,6", no_echo=no_echo, range_unit_m=1)
    assert ranges == (math.inf, 2, 3, 4, 5, 6)


def test_a_range_that_is_too_large_for_a_number_is_not_nothing_seen() -> None:
    first = values("sonar", b"1e308,2,3,4,5,6", range_unit_m=10)[0]
    assert first is not None
    assert math.isnan(first)


@pytest.mark.parametrize("word", [b"Infinity", b"inf", b"NaN", b"-Infinity", b"1e999"])
def test_a_number_that_is_not_finite_is_no_range_unless_a_setting_names_it(word: bytes) -> None:
    first, *others = values("sonar", word + b",2,3,4,5,6", range_unit_m=1, no_echo=0)
    assert first is not None
    assert math.isnan(first)
    assert others == [2, 3, 4, 5, 6]


MALFORMED = {
    "compass": [b"", b"abc", b"12,", b"1 2", b"1.2.3", b"0x1F", b"1_0", b"--1", b"12\0", b"\xff"],
    "gps": [
        b"",
        b"36,35.7,N,121",
        b"36,35.7,,121,52.5,W",
        b"36,35.7,121,52.5,W",
        b"36,35.7,X,121,52.5,W",
        b"36,abc,N,121,52.5,W",
        b"-36,35.7,N,121,52.5,W",
        b"36,-35.7,N,121,52.5,W",
        b"36,60,N,121,52.5,W",
        b"36,35.7,N,121,99.5,W",
        b"36;35.7;N;121;52.5;W",
    ],
    "sonar": [b"", b"1,2,3,4,5,6,7", b"1,,3,4,5,6", b"1,2,3,4,5,six", b",", b"1,2,3,4,5,6,,"],
    "motors": [b"x,3,", b"1", b""],
}


@pytest.mark.parametrize(
    ("port", "line"), [(port, x) for port in MALFORMED for x in MALFORMED[port]]
)
def test_a_malformed_line_has_no_reading(port: str, line: bytes) -> None:
    assert read(port, line) is None


FIELDS = st.sampled_from(
    [
        b"1",
        b"-2.5",
        b"36",
        b"N",
        b"S",
        b"W",
        b"NaN",
        b"inf",
        b"1e999",
        b"",
        b" ",
        b"x",
        b"\xff",
        b"60",
    ]
)
ANY_LINE = st.binary(max_size=60) | st.lists(FIELDS, max_size=9).map(b",".join)


@given(st.sampled_from([port.name for port in BENDER.ports]), ANY_LINE)
def test_any_bytes_are_a_reading_of_the_port_or_none(port: str, line: bytes) -> None:
    reading = read(port, line)
    if reading is not None:
        expected = next(each for each in BENDER.ports if each.name == port)
        assert reading.quantity is expected.quantity
        assert len(reading.values) == expected.values
        text = json.dumps(reading.message("bender/0", port, 1.0), allow_nan=False)
        assert repr(reading_of(json.loads(text))) == repr(reading)


# Motor lines


def test_the_lines_of_the_program_of_2002_are_sent_byte_by_byte() -> None:
    assert [line.data for line in BENDER.stop(DEFAULTS)] == [b"x,3,\n"]
    assert sent(STOP) == [b"x,3,\n"]
    assert sent(Motion(0.5)) == [b"x,2,175,\n"]
    assert sent(Motion(-1.5)) == [b"x,2,75,\n"]


def test_a_turn_is_two_lines_for_the_left_and_the_right_track() -> None:
    assert sent(Motion(0.0, 1.0)) == [b"x,0,138,\n", b"x,1,162,\n"]
    assert sent(Motion(0.0, -1.0)) == [b"x,0,162,\n", b"x,1,138,\n"]
    assert sent(Motion(0.5, 0.4)) == [b"x,0,170,\n", b"x,1,180,\n"]


def test_motor_values_stay_within_the_settings() -> None:
    assert sent(Motion(9.0)) == [b"x,2,200,\n"]
    assert sent(Motion(-9.0)) == [b"x,2,75,\n"]
    assert sent(Motion(9.0), max_forward_value=175) == [b"x,2,175,\n"]
    assert sent(Motion(-9.0), min_reverse_value=100) == [b"x,2,100,\n"]
    assert sent(Motion(0.0, 50.0)) == [b"x,0,75,\n", b"x,1,200,\n"]


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf])
def test_a_motion_that_is_no_number_stops(wrong: float) -> None:
    assert sent(Motion(wrong)) == [b"x,3,\n"]
    assert sent(Motion(0.0, wrong)) == [b"x,3,\n"]


def test_forward_and_reverse_have_their_own_speeds() -> None:
    uneven = {"forward_m_s_per_unit": 0.01, "reverse_m_s_per_unit": 0.05}
    assert sent(Motion(0.2), **uneven) == [b"x,2,170,\n"]
    assert sent(Motion(-0.2), **uneven) == [b"x,2,146,\n"]


SPEEDS = st.floats(-3, 3)


@given(SPEEDS, SPEEDS, st.sampled_from([0.02, 0.007]), st.floats(0.05, 5))
def test_the_motion_of_the_lines_of_a_motion_has_the_same_lines(
    speed: float, rate: float, reverse: float, width: float
) -> None:
    set_to = settings(reverse_m_s_per_unit=reverse, track_width_m=width)
    motion = Motion(speed, rate)
    caused = BENDER.motion(motion, set_to)
    assert BENDER.move(caused, set_to) == BENDER.move(motion, set_to)


@given(st.floats(-0.4, 0.4), st.floats(-1, 1))
def test_a_motion_within_the_limits_is_made_up_to_rounding(speed: float, rate: float) -> None:
    caused = BENDER.motion(Motion(speed, rate), DEFAULTS)
    assert caused.speed_m_s == pytest.approx(speed, abs=0.0101)
    assert caused.turn_rate_rad_s == pytest.approx(rate, abs=0.0401)


@pytest.mark.parametrize(
    ("bearing_deg", "data"),
    [
        (227.35, b"227.35\n"),
        (0.0, b"0.00\n"),
        (359.999, b"0.00\n"),
        (-90.0, b"270.00\n"),
        (725, b"5.00\n"),
    ],
)
def test_the_coprocessor_receives_a_stop_and_then_a_bearing(
    bearing_deg: float, data: bytes
) -> None:
    lines = BENDER.turn_to(bearing_deg, settings(turn="coprocessor"))
    assert [(line.port, line.data) for line in lines] == [
        ("motors", b"x,3,\n"),
        ("compass", data),
    ]


def test_a_coprocessor_that_knows_its_raw_compass_receives_the_mounting_offset() -> None:
    raw = settings(turn="coprocessor", heading_frame="raw")
    assert BENDER.turn_to(227.35, raw)[-1].data == b"237.35\n"
    assert BENDER.turn_to(355.0, raw)[-1].data == b"5.00\n"


def test_a_robot_that_turns_by_its_motors_receives_no_bearing() -> None:
    assert BENDER.turn_to(90.0, DEFAULTS) == ()

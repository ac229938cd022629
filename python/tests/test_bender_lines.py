"""The lines of the emulated Bender, its tracks, and what happens to lines on the network."""

import math
import re
from typing import Any

import numpy as np
import pytest

from agent_economy.live.emulator import Settings
from agent_economy.live.emulator.lines import (
    LineReader,
    MotorCommand,
    compass_fields,
    desired_heading_deg,
    gps_fields,
    motor_command,
)
from agent_economy.live.emulator.tracks import Tracks
from agent_economy.live.emulator.transport import pieces


@pytest.mark.parametrize(
    ("line", "command"),
    [
        (b"x,3,", MotorCommand(3)),
        (b"x,3,75,", MotorCommand(3)),
        (b"x,2,175,", MotorCommand(2, 175)),
        (b"x,0,75,", MotorCommand(0, 75)),
        (b"x,1,0,", MotorCommand(1, 0)),
        (b"x,2,175", None),
        (b"x,2,", None),
        (b"x,4,175,", None),
        (b"x,2,256,", None),
        (b"x,2,-5,", None),
        (b"x,2,1e2,", None),
        (b"y,2,175,", None),
        (b"x,2,175,x,3,", None),
        (b"", None),
        (b"\xff\xfe", None),
    ],
)
def test_a_motor_line_has_a_channel_a_value_and_a_comma_after_each(
    line: bytes, command: MotorCommand | None
) -> None:
    assert motor_command(line) == command


@pytest.mark.parametrize(
    ("line", "heading_deg"),
    [
        (b"227.35", 227.35),
        (b"360", 360.0),
        (b"0.0", 0.0),
        (b"5", None),  # one character was no data in 2002
        (b"360.1", None),
        (b"-1.0", None),
        (b"NaN", None),
        (b"90,", None),
    ],
)
def test_a_desired_heading_is_one_number_of_degrees(line: bytes, heading_deg: float | None) -> None:
    assert desired_heading_deg(line) == heading_deg


@pytest.mark.parametrize(
    ("at", "line"),
    [
        ((36.595266667, -121.87500333), "36,35.7160,N,121,52.5002,W"),
        ((-33.5, 151.25), "33,30.0000,S,151,15.0000,E"),
        ((-0.00001, 0.00001), "0,0.0006,S,0,0.0006,E"),
        ((1.9999999999, -179.9999999999), "2,0.0000,N,180,0.0000,W"),
        ((0.0, 180.5), "0,0.0000,N,179,30.0000,W"),
    ],
)
def test_a_fix_has_decimal_minutes_and_the_hemisphere_of_each_quadrant(
    at: tuple[float, float], line: str
) -> None:
    assert ",".join(gps_fields(*at, 4)) == line


def test_a_fix_has_the_digits_of_the_settings_and_its_last_letter_can_be_omitted() -> None:
    fields = gps_fields(36.595266667, -121.87500333, 2, has_longitude_letter=False)
    assert fields == ["36", "35.72", "N", "121", "52.50"]


def test_a_heading_is_below_360() -> None:
    assert [compass_fields(each) for each in (0.0, 359.94, 359.96, 375)] == [
        ["0.0"],
        ["359.9"],
        ["0.0"],
        ["15.0"],
    ]


@pytest.mark.parametrize("size", [1, 2, 3, 7, 100])
def test_lines_are_read_in_pieces_of_any_size_with_any_line_end(size: int) -> None:
    data = b"x,0,75,\nx,1,175,\r\nx,3,\rx,2,1"
    reader = LineReader()
    chunks = [data[at : at + size] for at in range(0, len(data), size)]
    lines = [line for chunk in chunks for line in reader.feed(chunk)]
    assert lines == [b"x,0,75,", b"x,1,175,", b"x,3,"]


# Tracks


def motion(*lines: bytes, **settings: Any) -> tuple[float, float]:
    tracks = Tracks()
    for line in lines:
        command = motor_command(line)
        assert command is not None
        tracks.obey(command)
    return tracks.motion(Settings().changed(settings))


def test_values_are_relative_to_150_so_that_reverse_is_three_times_as_fast_as_forward() -> None:
    assert motion(b"x,2,175,") == pytest.approx((0.5, 0))
    assert motion(b"x,2,75,") == pytest.approx((-1.5, 0))
    assert motion(b"x,2,150,") == (0, 0)


def test_a_turn_on_the_spot_also_moves_backwards_because_the_values_are_uneven() -> None:
    left = motion(b"x,0,75,", b"x,1,175,")
    assert left == pytest.approx((-0.5, 4.0))
    assert motion(b"x,1,75,", b"x,0,175,") == pytest.approx((left[0], -left[1]))


def test_slip_makes_turns_slower_and_reverse_has_its_own_unit() -> None:
    assert motion(b"x,0,125,", b"x,1,175,", turn_slip=0.5) == pytest.approx((0, 1.0))
    assert motion(b"x,2,50,", reverse_m_s_per_unit=0.005) == pytest.approx((-0.5, 0))


# Faults of lines


def parts(**faults: Any) -> list[tuple[float, bytes]]:
    return pieces(b"12345678", b"\n", faults, np.random.default_rng(1))


def test_lines_can_be_lost_late_doubled_and_cut() -> None:
    assert parts() == [(0, b"12345678\n")]
    assert parts(drop=1.0) == parts(stall=None) == []
    assert parts(delay=2.5) == [(2.5, b"12345678\n")]
    assert parts(duplicate=1.0) == [(0, b"12345678\n")] * 2
    assert parts(half=None) == [(0, b"1234")]
    assert parts(half=0.5, delay=1) == [(1, b"1234"), (1.5, b"5678\n")]


def test_a_garbled_line_is_random_bytes_and_one_line() -> None:
    ((_, data),) = parts(garble=1.0)
    assert data[:-1] != b"12345678"
    assert len(data) == 9
    assert re.fullmatch(rb"[^\r\n]+\n", data)


def test_a_share_of_the_lines_is_dropped() -> None:
    random = np.random.default_rng(2)
    lost = sum(not pieces(b"1", b"\n", {"drop": 0.3}, random) for _ in range(1000))
    # Binomial: five standard deviations.
    assert abs(lost - 300) < 5 * math.sqrt(1000 * 0.3 * 0.7)

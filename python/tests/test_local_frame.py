"""The place of a world on the earth."""

import math
from collections.abc import Callable

import pytest

from agent_economy import InputError, Scenario, Simulation
from agent_economy._core import LocalFrame

ZURICH = {"latitude_deg": 47.3977, "longitude_deg": 8.5456}


def test_the_origin_of_a_scenario_makes_its_frame() -> None:
    origin = {**ZURICH, "rotation_deg": 30.0, "declination_deg": 3.5}
    scenario = Scenario.load("search").replace("world.origin", origin)
    assert scenario.to_dict()["world"]["origin"] == origin
    frame = LocalFrame(**scenario.to_dict()["world"]["origin"])
    assert frame.to_local(**ZURICH) == (0.0, 0.0)


def test_an_origin_changes_no_run() -> None:
    scenario = Scenario.load("search")
    placed = scenario.replace("world.origin", ZURICH)
    assert Simulation(placed, seed=3).finish() == Simulation(scenario, seed=3).finish()


def test_places_and_points_are_converted_both_ways() -> None:
    frame = LocalFrame(**ZURICH)
    # A place 1 km from the origin at a true bearing of 63.2 degrees, computed by pyproj 3.7.2.
    x_m, y_m = frame.to_local(47.401754823502, 8.557424832909)
    assert x_m == pytest.approx(1000 * math.sin(math.radians(63.2)), abs=1e-4)
    assert y_m == pytest.approx(1000 * math.cos(math.radians(63.2)), abs=1e-4)
    assert frame.to_geographic(x_m, y_m) == pytest.approx((47.401754823502, 8.557424832909))


def test_a_compass_reading_becomes_a_heading_of_the_world() -> None:
    # The y axis points east, and magnetic north is 3 degrees east of true north.
    frame = LocalFrame(**ZURICH, rotation_deg=90, declination_deg=3)
    assert frame.heading_rad(87.0) == pytest.approx(math.pi / 2)
    assert frame.heading_rad(97.0, mounting_deg=10) == pytest.approx(math.pi / 2)
    assert frame.magnetic_bearing_deg(math.pi / 2) == pytest.approx(87.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e9, "1", None, True])
def test_a_number_that_is_not_finite_or_out_of_range_is_refused(bad: float) -> None:
    frame = LocalFrame(**ZURICH)
    calls: list[tuple[str, Callable[[], object]]] = [
        ("longitude_deg", lambda: LocalFrame(47.0, bad)),
        ("latitude_deg", lambda: frame.to_local(bad, 8.5)),
        ("y_m", lambda: frame.to_geographic(0.0, bad)),
        ("magnetic_bearing_deg", lambda: frame.heading_rad(bad)),
        ("heading_rad", lambda: frame.magnetic_bearing_deg(bad)),
    ]
    for name, call in calls:
        with pytest.raises(InputError, match=f"^{name} = .*: must be a number from "):
            call()


def test_all_errors_of_a_frame_are_reported_at_once() -> None:
    with pytest.raises(InputError) as raised:
        LocalFrame(90, -200, rotation_deg=400, declination_deg=math.nan)
    assert [error["path"] for error in raised.value.errors] == [
        "latitude_deg",
        "longitude_deg",
        "rotation_deg",
        "declination_deg",
    ]

"""Fleet files: the ways between waypoints, the walls of the world, and where the world is."""

from pathlib import Path

import numpy as np
import pytest
from command_line import run
from fleet_files import FLEET, SCENARIO, errors, load, swapped, with_key

from agent_economy.live import fleet
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.emulator.lines import gps_fields
from agent_economy.live.fleet_file import walls
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin, Wall

NOTCHED = "fence_m = [[1, 1], [39, 1], [39, 29], [22, 29], [22, 10], [18, 10], [18, 29], [1, 29]]\n"
"""A notch from above between x = 18 and 22: the way at y = 15 from the start leaves the fence."""

NEAR = swapped("waypoints_m = [[30, 15]]", "waypoints_m = [[8, 15]]", SCENARIO)
WALL = "[[14, 11], [15, 11], [15, 19], [14, 19]]"


def walled(scenario: str, obstacles: str = f"{{ polygon_m = {WALL} }}") -> str:
    """Return a scenario with obstacles."""
    return swapped("size_m = [40, 30]", f"size_m = [40, 30]\nobstacles = [{obstacles}]", scenario)


def sharing(scenario: str, waypoints: str) -> str:
    """Return a scenario whose team shares waypoints by radio."""
    old = '{ kind = "correct", waypoints_m = [[30, 15]], within_m = 1 }'
    new = f'{{ kind = "navigate", assignment = "shared", waypoints_m = {waypoints} }}'
    return swapped(old, new, scenario) + "[robots.crawler.radio]\nrange_m = 100\n"


def warned(folder: Path, text: str, scenario: str) -> list[str]:
    """Return the warnings about ways and places of a valid fleet, without the folder."""
    (folder / "crawlers.toml").write_text(scenario)
    found = [str(each).removeprefix(f"{folder}/") for each in load(folder, text).warnings]
    return [each for each in found if "deadman_s" not in each and "guesses" not in each]


# Fences


def test_a_leg_between_two_waypoints_that_leaves_the_fence_is_an_error(tmp_path: Path) -> None:
    text = with_key(NOTCHED + "waypoints_m = [[10, 20], [30, 20], [30, 5]]")
    (error,) = errors(tmp_path, text, NEAR)
    assert error == (
        'fleet.toml:6: robots."crawler/0".waypoints_m[1] = [30, 20]: must be a waypoint that is '
        "reached inside the fence: the leg from [10, 20] to [30, 20] leaves the fence at [18, 20]"
    )


def test_a_leg_from_the_waypoints_of_the_brain_that_leaves_the_fence_is_an_error(
    tmp_path: Path,
) -> None:
    text = swapped('host = "10.0.0.2"\n', f'host = "10.0.0.2"\n{NOTCHED}waypoints_m = [[30, 15]]\n')
    (error,) = errors(tmp_path, text, NEAR)
    assert error.startswith('fleet.toml:19: robots."crawler/1".waypoints_m[0] = [30, 15]')
    assert error.endswith("the leg from [8, 15] to [30, 15] leaves the fence at [18, 15]")


def test_a_leg_to_a_waypoint_of_the_brain_that_leaves_the_fence_is_an_error(
    tmp_path: Path,
) -> None:
    text = swapped('host = "10.0.0.2"\n', f'host = "10.0.0.2"\n{NOTCHED}')
    (error,) = errors(tmp_path, text)
    assert error.startswith('fleet.toml:18: robots."crawler/1".fence_m')
    assert error.endswith(
        "must be the corners of an area with the leg from [5, 15] to [30, 15], a waypoint of the "
        "scenario's brain: it leaves the fence at [18, 15]"
    )


def test_a_leg_of_a_brain_that_navigates_is_checked_too(tmp_path: Path) -> None:
    text = swapped('host = "10.0.0.2"\n', f'host = "10.0.0.2"\n{NOTCHED}')
    scenario = swapped('kind = "correct"', 'kind = "navigate"', SCENARIO)
    (error,) = errors(tmp_path, text, scenario)
    assert "the leg from [5, 15] to [30, 15]" in error


def test_without_a_fixed_start_the_way_to_the_first_waypoint_is_not_known(tmp_path: Path) -> None:
    start = 'start = { kind = "fixed", at_m = [[5, 5], [5, 15], [5, 25]] }'
    scenario = swapped(start, 'start = { kind = "uniform" }', SCENARIO)
    assert warned(tmp_path, with_key(NOTCHED + "waypoints_m = [[30, 20]]"), scenario) == []


def test_shared_waypoints_on_both_sides_of_a_notch_are_warned_of_once(tmp_path: Path) -> None:
    scenario = sharing(SCENARIO, "[[10, 20], [30, 20], [30, 25]]")
    (warning,) = warned(tmp_path, with_key(NOTCHED), scenario)
    assert warning.startswith('fleet.toml:5: robots."crawler/0".fence_m')
    assert warning.endswith(
        "4 of the 6 straight ways between shared waypoints leave the fence, as from [5, 5] to "
        "[30, 20] at [18, 12.8]; a robot that goes one is stopped"
    )


# Walls


@pytest.mark.parametrize(
    ("obstacle", "where"),
    [
        (f"{{ polygon_m = {WALL} }}", "inside"),
        ("{ rectangle = { at_m = [14.5, 15], size_m = [1, 8] } }", "inside"),
        ("{ circle = { at_m = [14.5, 15], radius_m = 1 } }", "inside"),
        ("{ circle = { at_m = [12.5, 12], radius_m = 1 } }", None),
        ("{ circle = { at_m = [12.5, 15], radius_m = 1.75 } }", "0.25 m from"),
        (
            "{ circle = { at_m = [4.5, 15], radius_m = 0.1 }, "
            "repeat = { columns = 2, rows = 1, spacing_m = [10, 1] } }",
            "inside",
        ),
    ],
)
def test_a_waypoint_at_which_the_robot_touches_a_wall_is_an_error(
    tmp_path: Path, obstacle: str, where: str | None
) -> None:
    text, scenario = with_key("waypoints_m = [[14.5, 15]]"), walled(NEAR, obstacle)
    if where is None:
        warned(tmp_path, text, scenario)
        return
    (error,) = errors(tmp_path, text, scenario)
    assert error == (
        'fleet.toml:5: robots."crawler/0".waypoints_m[0] = [14.5, 15]: must be a point at least '
        f"0.4 m, the radius of the robot, from each obstacle: it is {where} world.obstacles[0]"
    )


def test_a_waypoint_of_the_brain_inside_a_wall_is_one_error_for_all_robots(tmp_path: Path) -> None:
    scenario = walled(SCENARIO, "{ circle = { at_m = [30, 15], radius_m = 1 } }")
    (error,) = errors(tmp_path, FLEET, scenario)
    assert error.startswith(
        "crawlers.toml:20: robots.crawler.brain.behaviours[1].waypoints_m[0] = [30, 15]: must be"
    )


def test_robots_that_fly_have_no_walls(tmp_path: Path) -> None:
    scenario = walled(swapped("radius_m = 0.4", 'radius_m = 0.4\nlayer = "air"', NEAR))
    assert warned(tmp_path, with_key("waypoints_m = [[14.5, 15]]"), scenario) == []
    assert load(tmp_path).plan.robots[0].radius_m is None


def test_ways_that_cross_walls_are_warned_of_once_for_each_list(tmp_path: Path) -> None:
    text = with_key("waypoints_m = [[5, 15]]")
    of_file, of_brain = sorted(warned(tmp_path, text, walled(SCENARIO)), reverse=True)
    assert of_file == (
        'fleet.toml:5: robots."crawler/0".waypoints_m = [[5, 15]]: the straight way from [30, 15] '
        "to [5, 15] crosses world.obstacles[0]: the robot has to find a way around"
    )
    assert of_brain.startswith("crawlers.toml:20: robots.crawler.brain.behaviours[1].waypoints_m")
    assert "the straight way from [5, 15] to [30, 15] crosses world.obstacles[0]" in of_brain


def test_ways_between_shared_waypoints_that_cross_walls_are_one_warning(tmp_path: Path) -> None:
    scenario = walled(sharing(SCENARIO, "[[10, 15], [20, 15], [20, 25]]"))
    (warning,) = warned(tmp_path, FLEET, scenario)
    assert warning.startswith("crawlers.toml:20: robots.crawler.brain.behaviours[1].waypoints_m")
    assert warning.endswith(
        "6 of 12 straight ways cross obstacles, as from [5, 5] to [20, 15] (world.obstacles[0]): "
        "the robots have to find ways around"
    )


def test_bundled_fleets_have_one_warning_of_walls() -> None:
    for name in ("bender", "bender-team"):
        found = [str(each) for each in fleet.load(name).warnings]
        assert sum("world.obstacles[0]" in each for each in found) == 1


def test_the_occupied_cells_of_a_map_are_walls(tmp_path: Path) -> None:
    # Rows from above: free, a wall of three cells, unknown. Cells of 1 m, from [10, 10] on.
    cells = np.array([[254] * 5, [254, 0, 0, 0, 254], [205] * 5], np.uint8)
    (tmp_path / "room.pgm").write_bytes(b"P5 5 3 255\n" + cells.tobytes())
    (tmp_path / "room.yaml").write_text(
        "image: room.pgm\nresolution: 1.0\norigin: [10, 10, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    (tmp_path / "crawlers.toml").write_text(walled(NEAR, '{ map = "room.yaml" }'))
    (wall,) = load(tmp_path).plan.walls or ()
    assert wall == Wall(
        "world.obstacles[0]", ((11.0, 11.0), (14.0, 11.0), (14.0, 12.0), (11.0, 12.0))
    )
    unknown = walled(NEAR, '{ map = "room.yaml", unknown_is_occupied = true }')
    (error,) = errors(tmp_path, with_key("waypoints_m = [[12, 10.5]]"), unknown)
    assert "it is inside world.obstacles[0]" in error


def test_a_plan_has_a_bounded_number_of_corners(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "crawlers.toml").write_text(walled(SCENARIO))
    assert load(tmp_path).plan.walls == (
        Wall("world.obstacles[0]", ((14.0, 11.0), (15.0, 11.0), (15.0, 19.0), (14.0, 19.0))),
    )
    monkeypatch.setattr(walls, "MAX_CORNERS", 3)
    assert load(tmp_path).plan.walls is None


# The place of the world

ZURICH = swapped(
    "latitude_deg = 36.6, longitude_deg = -121.9",
    "latitude_deg = 47.4, longitude_deg = 8.5",
    SCENARIO,
)
SETTINGS = '[robots."crawler/0".settings]\n'


def test_a_hemisphere_that_contradicts_the_origin_is_warned_of(tmp_path: Path) -> None:
    text = FLEET[: FLEET.index('[robots."crawler/1"]')]
    given = swapped(SETTINGS, SETTINGS + 'hemisphere = "W"\n', text)
    *_, warning = warned(tmp_path, given, ZURICH)
    effect = (
        "the origin of the scenario is at 8.5 E: a receiver that sends no letter is taken to be at "
        '8.5 W, 1,277 km from the origin; set hemisphere = "E"'
    )
    assert warning == f'fleet.toml:7: robots."crawler/0".settings.hemisphere = "W": {effect}'
    *_, warning = warned(tmp_path, text, ZURICH)
    assert warning == (
        f'fleet.toml:6: robots."crawler/0".settings.hemisphere: without it, it is "W"; {effect}'
    )


def test_a_hemisphere_that_agrees_with_the_origin_is_not_warned_of(tmp_path: Path) -> None:
    east = FLEET.replace(".settings]\n", '.settings]\nhemisphere = "E"\n')
    for text, scenario in ((FLEET, SCENARIO), (east, ZURICH)):
        found = [each for each in warned(tmp_path, text, scenario) if "crawler/0" in each]
        assert not any("hemisphere" in each for each in found)
    bender = DRIVERS["bender"]
    for letter in "WE":
        assert not list(bender.contradictions({"hemisphere": letter}, 10.0, 0.0))
    assert list(bender.contradictions({"hemisphere": "W"}, 10.0, 181.0)) == []


def test_a_receiver_without_a_letter_is_at_its_place_in_both_hemispheres() -> None:
    for longitude_deg, letter in ((8.5, "E"), (-121.9, "W")):
        fields = gps_fields(47.4, longitude_deg, 5, has_longitude_letter=False)
        driver = DRIVERS["bender"]
        settings = {key: each.default for key, each in driver.settings.items()}
        line = ",".join(fields).encode()
        frame = frame_of(Origin(47.4, longitude_deg))
        reading = driver.parse("gps", line, settings | {"hemisphere": letter}, frame)
        assert reading is not None
        assert reading.values == pytest.approx((0.0, 0.0), abs=0.1)


def test_check_prints_errors_of_legs(tmp_path: Path) -> None:
    (tmp_path / "crawlers.toml").write_text(NEAR)
    text = with_key(NOTCHED + "waypoints_m = [[10, 20], [30, 20]]")
    (tmp_path / "fleet.toml").write_text(text)
    given = run("check", "fleet.toml", cwd=tmp_path)
    assert given.returncode == 2
    assert "leaves the fence at [18, 20]" in given.stderr

"""Errors of fleet files: all at once, with lines and suggestions."""

from pathlib import Path

import pytest
from fleet_files import FLEET, SCENARIO, errors, load, swapped, with_key

from agent_economy import InputError
from agent_economy.live import fleet


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the scenario."""
    (tmp_path / "crawlers.toml").write_text(SCENARIO)
    return tmp_path


# Errors of the schema


def test_all_errors_of_a_file_and_its_scenario_are_reported_at_once(folder: Path) -> None:
    text = """scenario = "crawlers.toml"
setpoint_lifetime_s = "short"
max_lateness = 1
[robots."crawler/0"]
driver = "bendr"
host = "10.0.0.1"
[robots."crawler/1"]
driver = "bender"
hst = "10.0.0.2"
ports = { motor = 2000, gps = 0 }
max_age_s = { motors = 1 }
[robots."crawler/2"]
driver = "bender"
host = "http://robot"
[robots."crawler/2".settings]
range_unit_m = 0
hemisphere = "X"
no_echo = inf
[robots."crawler/7"]
driver = "bender"
host = "a"
"""
    found = errors(folder, text, swapped("wdth", "wdth", SCENARIO + "# wdth"))
    for start in [
        'fleet.toml:2: setpoint_lifetime_s = "short": must be a number from 0.01 to 10 (seconds)',
        "fleet.toml:3: max_lateness is not a known key: expected one of",
        'fleet.toml:5: robots."crawler/0".driver = "bendr": must be one of "bender"; did you mean',
        'fleet.toml:9: robots."crawler/1".hst is not a known key',
        'fleet.toml:7: robots."crawler/1".host is missing: expected a non-empty string',
        'fleet.toml:10: robots."crawler/1".ports.motor is not a known key',
        'fleet.toml:10: robots."crawler/1".ports.gps = 0: must be a whole number from 1 to 65535',
        'fleet.toml:11: robots."crawler/1".max_age_s.motors is not a known key: expected one of '
        "compass, gps, sonar",
        'fleet.toml:16: robots."crawler/2".settings.range_unit_m = 0: must be a number from 0.001',
        'fleet.toml:17: robots."crawler/2".settings.hemisphere = "X": must be one of "E", "W"',
        'fleet.toml:18: robots."crawler/2".settings.no_echo = inf: must be a number from -1000000 '
        "to 1000000",
        'fleet.toml:19: robots."crawler/7" is not a known key: expected a robot of the scenario: '
        "crawler/0 to crawler/2; did you mean crawler/0?",
    ]:
        assert sum(each.startswith(start) for each in found) == 1, (start, found)
    assert len(found) == 12


def test_errors_of_the_scenario_are_reported_with_those_of_the_fleet(folder: Path) -> None:
    scenario = swapped("radius_m = 0.4", "radus_m = 0.4", SCENARIO)
    found = errors(folder, swapped('driver = "bender"', "driver = 3"), scenario)
    assert [each.split(":")[0] for each in found] == [
        "fleet.toml",
        "crawlers.toml",
        "crawlers.toml",
    ]
    assert found[1].startswith("crawlers.toml:12: robots.crawler.radus_m is not a known key")


def test_an_error_has_all_details(folder: Path) -> None:
    with pytest.raises(InputError) as error:
        load(folder, swapped('"bender"', '"bendr"'))
    assert error.value.errors == [
        {
            "origin": f"{folder}/fleet.toml:3",
            "file": f"{folder}/fleet.toml",
            "line": 3,
            "path": 'robots."crawler/0".driver',
            "value": '"bendr"',
            "allowed": 'one of "bender"',
            "suggestion": '"bender"',
            "message": f'{folder}/fleet.toml:3: robots."crawler/0".driver = "bendr": must be one '
            'of "bender"; did you mean "bender"?',
        }
    ]


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ("", "fleet.toml: robots is missing: expected a table"),
        ("", "fleet.toml: scenario is missing: expected a non-empty string"),
        ("robots = 3", "fleet.toml:1: robots = 3: must be a table"),
        ("scenario = 3", "fleet.toml:1: scenario = 3: must be a non-empty string"),
        ("scenario = ", "fleet.toml:1: not valid TOML"),
        (
            'scenario = "crawlers.toml"\nrobots = {}',
            "fleet.toml:2: robots = {...}: must be a table with at least one robot",
        ),
        (
            'scenario = "crawlers.toml"\n[robots]\n"crawler/0" = 1',
            'fleet.toml:3: robots."crawler/0" = 1: must be a table',
        ),
        (
            'scenario = "crawlers.toml"\n[robots."crawler/0"]',
            'fleet.toml:2: robots."crawler/0".driver is missing: expected one of "bender"',
        ),
    ],
)
def test_what_is_no_fleet_is_an_error(folder: Path, text: str, start: str) -> None:
    assert any(each.startswith(start) for each in errors(folder, text)), errors(folder, text)


# The scenario


def test_more_than_1000_waypoints_are_an_error(folder: Path) -> None:
    load(folder, with_key(f"waypoints_m = {[[10, 10]] * 1000}"))
    (error,) = errors(folder, with_key(f"waypoints_m = {[[10, 10]] * 1001}"))
    assert error.endswith("must be a list of 0 to 1000 lists of 2 numbers (metres)"), error


@pytest.mark.parametrize(
    ("name", "end"),
    [
        ("crawlers", "; did you mean"),
        ("serch", 'relative to this file; did you mean "search"?'),
        ("x" * 5000, "relative to this file"),
        (".", "relative to this file"),
    ],
)
def test_an_unknown_scenario_is_an_error(folder: Path, name: str, end: str) -> None:
    (error,) = errors(folder, swapped("crawlers.toml", name))
    assert error.startswith('fleet.toml:1: scenario = "')
    assert "must be the name of a bundled scenario, or the path of a scenario" in error
    assert error.endswith(end) or name == "crawlers"


def test_a_scenario_that_cannot_be_read_is_an_error(folder: Path) -> None:
    (folder / "crawlers.bin").write_bytes(b"\xff")
    (error,) = errors(folder, swapped("crawlers.toml", "crawlers.bin"))
    assert error.startswith(
        'fleet.toml:1: scenario = "crawlers.bin": must be a scenario that can be'
    )
    assert "is not UTF-8 text" in error


def test_the_classic_engine_drives_no_robots(folder: Path) -> None:
    (error,) = errors(folder, swapped("crawlers.toml", "classic"))
    assert error == (
        'fleet.toml:1: scenario = "classic": must be a scenario of the metric engine, not of '
        "classic"
    )


def test_a_world_without_a_place_on_the_earth_is_an_error(folder: Path) -> None:
    lines = SCENARIO.splitlines()
    scenario = "\n".join("" if line.startswith("origin") else line for line in lines)
    (error,) = errors(folder, FLEET, scenario)
    assert error.startswith(
        "crawlers.toml:7: world.origin is missing: expected the geographic origin"
    )


def test_a_periodic_world_is_an_error(folder: Path) -> None:
    scenario = swapped("size_m = [40, 30]", "size_m = [40, 30]\nperiodic = true", SCENARIO)
    (error,) = errors(folder, FLEET, scenario)
    assert error.startswith("crawlers.toml:9: world.periodic = true: must be false")


def test_a_robot_that_turns_instantly_is_an_error(folder: Path) -> None:
    scenario = swapped(", max_turn_rate_deg_s = 90", "", SCENARIO)
    (error,) = errors(folder, FLEET, scenario)
    assert error.startswith(
        "crawlers.toml:14: robots.crawler.drive.max_turn_rate_deg_s is missing: expected a number"
    )


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        (
            "rays = 1\n",
            "rays = 4\n",
            [
                '6 sensors of kind "range" with rays = 1',
                "and the kind has sonar_0 (rays = 4), sonar_1",
            ],
        ),
        (
            '[robots.crawler.sensors.sonar_0]\nkind = "range"\nrays = 1\nfov_deg = 0\nrange_m = 6\n'
            "noise_m = 0.02\nrelative_noise = 0.01\n",
            "",
            ['6 sensors of kind "range" with rays = 1', "and the kind has sonar_1 (rays = 1)"],
        ),
        (
            '[robots.crawler.sensors.gps]\nkind = "position"\nnoise_m = 0.3\n',
            "",
            ['one sensor of kind "position"', "and the kind has none"],
        ),
        (
            "[robots.crawler.sensors.compass]",
            '[robots.crawler.sensors.backup]\nkind = "heading"\n[robots.crawler.sensors.compass]',
            ['one sensor of kind "heading"', "and the kind has backup and compass"],
        ),
    ],
)
def test_sensors_that_the_driver_does_not_provide_are_errors(
    folder: Path, old: str, new: str, parts: list[str]
) -> None:
    # The behaviour needs the sensor that one of the cases takes away.
    brain = '    { kind = "correct", waypoints_m = [[30, 15]], within_m = 1 },\n'
    (error,) = errors(folder, FLEET, swapped(old, new, swapped(brain, "", SCENARIO)))
    assert error.startswith(
        'fleet.toml:3: robots."crawler/0".driver = "bender": must be a driver for the sensors of '
        "robots.crawler in the scenario: bender needs "
    )
    assert all(part in error for part in parts), error


CAMERA = '[robots.crawler.sensors.camera]\nkind = "robots"\nrange_m = 5\n'


def test_a_detector_that_has_no_input_is_virtual_with_a_warning(folder: Path) -> None:
    (folder / "crawlers.toml").write_text(SCENARIO + CAMERA)
    loaded = load(folder, FLEET)
    warning = next(str(each) for each in loaded.warnings if "camera" in str(each))
    assert "camera is virtual, because bender has no input for it" in warning
    assert loaded.plan.robots[0].sensors["camera"] == "virtual"
    stated = FLEET + '[robots."crawler/0".sensors]\ncamera = "virtual"\n'
    loaded = load(folder, stated)
    named = [str(each) for each in loaded.warnings if "camera" in str(each)]
    assert not [each for each in named if "crawler/0" in each]


def test_all_sources_that_sensors_cannot_have_are_errors(folder: Path) -> None:
    second = '[robots.crawler.sensors.second]\nkind = "position"\n'
    sources = {
        "camera": "real",
        "compass": "both",
        "gps": "real",
        "second": "real",
        "sonra": "virtual",
    }
    lines = "\n".join(f'{name} = "{source}"' for name, source in sources.items())
    text = f'{FLEET}[robots."crawler/0".sensors]\n{lines}\n'
    found = errors(folder, text, SCENARIO + CAMERA + second)
    found = [error for error in found if '"crawler/0".sensors' in error]
    at = 1 + text.splitlines().index('camera = "real"')
    starts = [
        f'fleet.toml:{at + row}: robots."crawler/0".sensors.{name}'
        for row, name in enumerate(sources)
    ]
    assert [error.startswith(start) for error, start in zip(found, starts, strict=True)] == [
        True
    ] * 5
    for error, allowed in zip(
        found,
        (
            '"virtual": the driver bender has no input for it, only for sensors of kind "heading"',
            '"real": a real and a virtual heading cannot be merged',
            '"virtual" for all but one of gps and second: the driver bender measures one position',
            '"virtual" for all but one of gps and second: the driver bender measures one position',
            "a sensor of robots.crawler in the scenario",
        ),
        strict=True,
    ):
        assert allowed in error


def test_a_virtual_position_needs_a_real_one(folder: Path) -> None:
    virtual = FLEET + '[robots."crawler/0".sensors]\ngps = "virtual"\n'
    (error,) = errors(folder, virtual)
    assert "virtual sensors measure from the position that a real one states" in error
    second = '[robots.crawler.sensors.second]\nkind = "position"\n'
    (folder / "crawlers.toml").write_text(SCENARIO + second)
    names = ("crawler/0", "crawler/1", "crawler/2")
    stated = "".join(f'[robots."{name}".sensors]\nsecond = "virtual"\n' for name in names)
    loaded = load(folder, FLEET + stated)
    assert loaded.plan.robots[0].sensors["second"] == "virtual"


def test_a_start_in_an_obstacle_and_sources_that_are_wrong_are_reported_together(
    folder: Path,
) -> None:
    assert "obstacles" not in SCENARIO
    walled = SCENARIO.replace(
        "[world]", "[world]\nobstacles = [{ circle = { at_m = [5, 5], radius_m = 50 } }]", 1
    )
    text = FLEET + '[robots."crawler/0".sensors]\ngps = "both"\nsonra = "virtual"\n'
    found = errors(folder, text, walled)
    lines = text.splitlines()
    gps, sonra = (1 + lines.index(line) for line in ('gps = "both"', 'sonra = "virtual"'))
    assert any("robots.crawler" in error and "obstacle" in error for error in found)
    assert any(error.startswith(f"fleet.toml:{gps}: ") for error in found)
    assert any(error.startswith(f"fleet.toml:{sonra}: ") for error in found)


def test_the_rules_judge_the_same_inputs_whatever_is_virtual(folder: Path) -> None:
    sonars = "".join(f'sonar_{number} = "virtual"\n' for number in range(6))
    stated = load(folder, f'{FLEET}[robots."crawler/0".sensors]\n{sonars}').plan.robots[0]
    assert set(stated.scans or ()) == {None}
    plain = load(folder, FLEET).plan.robots[0]
    assert (stated.inputs, stated.fence_m) == (plain.inputs, plain.fence_m)
    assert plain.scans == tuple(range(6))


def test_two_real_sensors_of_one_quantity_are_an_error(folder: Path) -> None:
    second = '[robots.crawler.sensors.second]\nkind = "position"\n'
    (error,) = errors(folder, FLEET, SCENARIO + second)
    assert 'needs one sensor of kind "position", and the kind has gps and second' in error
    assert 'set the others to "virtual" under sensors' in error


def test_all_sensors_of_a_bundled_model_are_named(folder: Path) -> None:
    text = 'scenario = "search"\n[robots."rover/0"]\ndriver = "bender"\nhost = "a"\n'
    found = errors(folder, text)
    assert [each for each in found if "fleet.toml:3" in each] == [
        'fleet.toml:3: robots."rover/0".driver = "bender": must be a driver for the sensors of '
        'robots.rover in the scenario: bender needs 6 sensors of kind "range" with rays = 1, and '
        "the kind has lidar (rays = 55)"
    ]


# The network


@pytest.mark.parametrize(
    "host", ["robot", "bender.local", "a_b.lan.", "10.1.2.3", "::1", "bücher.example", "LOCALHOST"]
)
def test_a_name_or_an_address_is_a_host(folder: Path, host: str) -> None:
    found = load(folder, swapped('"10.0.0.1"', f'"{host}"'))
    assert found.plan.robots[0].host == host


@pytest.mark.parametrize(
    "host",
    [
        "http://robot",
        "robot:2000",
        "10.0.0.256",
        "1.2.3",
        "a b",
        "-robot",
        "robot-",
        "a..b",
        ".",
        "[::1]",
        "0.0.0.0",  # noqa: S104  (an address that is refused)
        "224.0.0.1",
        "255.255.255.255",
        "x" * 64,
        ".".join(["abcdefg"] * 40),
        "a\\u0000b",
        "a/b",
    ],
)
def test_what_cannot_be_a_host_is_an_error(folder: Path, host: str) -> None:
    (error,) = errors(folder, swapped('"10.0.0.1"', f'"{host}"'))
    assert error.startswith('fleet.toml:4: robots."crawler/0".host = "')
    assert "must be a host name such as bender.local or an IP address, without a port" in error


@pytest.mark.parametrize(
    ("first", "second"),
    [("10.0.0.1", "10.0.0.1"), ("Robot", "robot."), ("localhost", "127.0.0.1"), ("::1", "0:0::1")],
)
def test_two_robots_with_the_same_host_and_port_are_an_error(
    folder: Path, first: str, second: str
) -> None:
    text = swapped('"10.0.0.1"', f'"{first}"')
    text = swapped('"10.0.0.2"', f'"{second}"\nports = {{ motors = 2001 }}', text)
    (error,) = errors(folder, text)
    assert error == (
        'fleet.toml:18: robots."crawler/1".ports.motors = 2001: must be another number than 2001, '
        "which is port compass of crawler/0 on the same host"
    )
    load(folder, swapped("motors = 2001", "motors = 2010", text))


def test_two_ports_of_a_robot_with_the_same_number_are_an_error(folder: Path) -> None:
    (error,) = errors(folder, with_key("ports = { gps = 2003 }"))
    assert error == (
        'fleet.toml:5: robots."crawler/0".ports.sonar is missing: expected another number than '
        "2003, which is port gps of crawler/0 on the same host"
    )


def test_a_default_port_beyond_the_last_one_is_an_error(folder: Path) -> None:
    scenario = swapped("count = 3", "count = 7000", SCENARIO)
    scenario = swapped("[[5, 5], [5, 15], [5, 25]] }", "[] }", scenario)
    scenario = swapped('start = { kind = "fixed", at_m = [] }', "", scenario)
    scenario = swapped("radius_m = 0.4", "radius_m = 0", scenario)
    text = swapped("crawler/2", "crawler/6999")
    found = errors(folder, text, scenario)
    assert len(found) == 4
    assert "must be" not in found[0]
    assert "expected a whole number from 1 to 65535: without it, it is" in found[0]


# Times


def test_a_setpoint_must_not_outlive_an_input(folder: Path) -> None:
    (error,) = errors(folder, with_key("max_age_s = { sonar = 0.25 }"))
    assert error == (
        "fleet.toml: setpoint_lifetime_s is missing: expected a number of at most 0.25 (seconds), "
        'max_age_s.sonar of "crawler/0"; without it, it is 0.3'
    )


def test_a_setpoint_must_not_outlive_the_maximum_lateness(folder: Path) -> None:
    (error,) = errors(folder, "setpoint_lifetime_s = 0.4\nmax_lateness_s = 0.3\n" + FLEET)
    assert error == (
        "fleet.toml:1: setpoint_lifetime_s = 0.4: must be a number of at most 0.3 (seconds), "
        "max_lateness_s"
    )


def test_a_setpoint_must_outlive_the_period_of_the_brain(folder: Path) -> None:
    (error,) = errors(folder, "setpoint_lifetime_s = 0.15\n" + FLEET)
    assert error == (
        "fleet.toml:1: setpoint_lifetime_s = 0.15: must be a number of at least 0.2 (seconds), the "
        "time between two steps of the brain of crawler"
    )


def test_the_manual_speed_is_at_most_the_maximum_speed(folder: Path) -> None:
    (error,) = errors(folder, with_key("manual_speed_m_s = 0.7"))
    assert error == (
        'fleet.toml:5: robots."crawler/0".manual_speed_m_s = 0.7: must be a number from 0 to 0.6 '
        "(m/s), the maximum speed of crawler"
    )


# Fences and waypoints


@pytest.mark.parametrize(
    ("fence", "parts"),
    [
        ("[[1, 1], [39, 1]]", ["must be a list of 3 to 1000", "[[1, 1], [39, 1]]"]),
        ("[[1, 1], [39, 29], [39, 1], [1, 29]]", ["a polygon that does not intersect itself"]),
        ("[[1, 1], [39, 1], [39, 1], [1, 29]]", ["a polygon without repeated vertices"]),
        ("[[1, 1], [39, 1], [20, 1]]", ["a polygon"]),
        ("[[1, 1], [41, 1], [39, 29], [1, 29]]", ["fence_m[1] = [41, 1]", "a point of the world"]),
        ("[[6, 1], [39, 1], [39, 29], [6, 29]]", ["[5, 5], where crawler/0 starts"]),
        ("[[1, 1], [29, 1], [29, 29], [1, 29]]", ["the waypoint [30, 15] of the scenario's brain"]),
        ('[[1, "a"], [29, 1], [29, 29]]', ['fence_m[0][1] = "a": must be a number']),
        ("[[1, nan], [29, 1], [29, 29]]", ["fence_m[0][1] = NaN: must be a number"]),
    ],
)
def test_a_fence_is_an_area_of_the_world_with_its_robot_and_its_waypoints(
    folder: Path, fence: str, parts: list[str]
) -> None:
    found = errors(folder, with_key(f"fence_m = {fence}"))
    assert len(found) == 1, found
    assert found[0].startswith('fleet.toml:5: robots."crawler/0".fence_m')
    assert all(part in found[0] for part in parts), found


def test_waypoints_for_a_brain_that_takes_no_orders_are_an_error() -> None:
    text = """scenario = "bender-team"
[robots."bender/0"]
driver = "bender"
host = "127.0.0.1"
waypoints_m = [[10, 10]]
"""
    with pytest.raises(InputError, match="must be omitted, because the brain of bender has no"):
        fleet.loads(text)


def test_waypoints_are_in_the_world_and_in_the_fence(folder: Path) -> None:
    fence = "fence_m = [[1, 1], [31, 1], [31, 29], [1, 29]]\n"
    found = errors(folder, with_key(fence + "waypoints_m = [[10, 10],\n[32, 15],\n[50, 15]]"))
    assert found == [
        'fleet.toml:8: robots."crawler/0".waypoints_m[2] = [50, 15]: must be a point of the world, '
        "from [0, 0] to [40, 30]",
        'fleet.toml:7: robots."crawler/0".waypoints_m[1] = [32, 15]: must be a point inside the '
        "fence of the robot, fence_m",
    ]
    load(folder, with_key(fence + "waypoints_m = [[10, 10], [31, 29]]"))

"""Warnings about scenarios: what is allowed, and probably not meant."""

import json
import time
from pathlib import Path

import pytest
from command_line import refuse, run, succeed

import agent_economy as ae
from agent_economy import study
from agent_economy.scenario.bundled import scenarios

MAP = """image: room.pgm
resolution: 0.05
origin: [-10, -10, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
mode: trinary
"""

JOB = """
engine = "metric"
summary = "A start strip in a room."
merit = "equation-5.2"
clock = { time_limit_s = 1 }
world = { size_m = [19.2, 19.2], obstacles = [{ map = "room.yaml" }] }

[items.mine]
count = 1

[robots.rover]
count = 2
radius_m = 0.2
start = { kind = "uniform", within_m = [[1, 1], [3, 18]] }
drive = { max_speed_m_s = 0.5 }
sensors = { detector = { kind = "items", range_m = 0.5 } }

[study]
vary = { "robots.rover.count" = "1,2" }
delta = 0.5
"""

CROPPED = (
    'world.obstacles[0].map = "room.yaml": 75% of its occupied cells are outside of the world, '
    "from [0, 0] to [19.2, 19.2], and are ignored; at_m = [0, 0] holds all of the map"
)


def room() -> bytes:
    """Return an image of the size of TurtleBot3's: four blocks of 4 x 4 cells, the rest unknown."""
    side, far = 384, 300
    blocks = [*range(80, 84), *range(far, far + 4)]
    rows = [
        bytes(0 if x in blocks and y in blocks else 205 for x in range(side)) for y in range(side)
    ]
    return b"P5 384 384 255\n" + b"".join(rows)


@pytest.fixture
def job(tmp_path: Path) -> Path:
    (tmp_path / "room.yaml").write_text(MAP)
    (tmp_path / "room.pgm").write_bytes(room())
    file = tmp_path / "job.toml"
    file.write_text(JOB)
    return file


def test_check_warns_of_a_cropped_map_and_the_scenario_is_valid(job: Path) -> None:
    given = run("check", job)
    assert given.returncode == 0
    first, derived = given.stdout.splitlines()
    assert first == f"{job}: valid: engine metric, factorial: 2 configurations"
    assert derived.startswith("    robots.rover.sensors.detector, mine: a pass at 0.5 m/s, ")
    assert given.stderr == f"warning: {job}:6: {CROPPED}\n"
    job.write_text(JOB.replace('"room.yaml"', '"room.yaml", at_m = [0, 0]'))
    assert run("check", job).stderr == ""


def test_check_lists_warnings_in_json_with_their_severity(job: Path) -> None:
    bad = job.with_name("bad.toml")
    bad.write_text(JOB.replace("count = 2", "count = -2"))
    given = run("check", job, bad, "--json")
    assert given.returncode == 2
    *errors, warning = json.loads(given.stdout)
    assert {(each["severity"], each["file"]) for each in errors} == {("error", str(bad))}
    assert warning == {
        "severity": "warning",
        "origin": f"{job}:6",
        "file": str(job),
        "line": 6,
        "path": "world.obstacles[0].map",
        "value": '"room.yaml"',
        "effect": CROPPED.partition(": ")[2],
        "message": f"{job}:6: {CROPPED}",
    }
    assert json.loads(run("check", job, "--json").stdout) == [warning]


@pytest.mark.parametrize(
    "command", [["run"], ["replicate", "--runs", "2"], ["study", "--runs", "2", "--out", "out"]]
)
def test_commands_that_run_print_warnings_once(
    command: list[str], job: Path, tmp_path: Path
) -> None:
    name, *options = command
    given = succeed(name, job, *options, "--json", cwd=tmp_path)
    assert given.stderr.count(f"warning: {job}:6: {CROPPED}\n") == 1
    assert json.loads(given.stdout)


def test_warnings_of_a_scenario_are_an_attribute(job: Path) -> None:
    (warning,) = ae.Scenario.load(job).warnings
    assert (warning.path, warning.line) == ("world.obstacles[0].map", 6)
    assert str(warning) == f"{job}:6: {CROPPED}"
    assert ae.Scenario.load("classic").warnings == ()


def test_check_reports_teams_of_the_study_that_have_no_room(job: Path) -> None:
    open_room = JOB.replace(', obstacles = [{ map = "room.yaml" }]', "")
    job.write_text(open_room.replace('"1,2"', '"1..3,1000"'))
    given = run("check", job)
    assert given.returncode == 0
    start = (
        "warning: study.vary: robots.rover.count = 1000: no room: their start area, from [1, 1] to "
        "[3, 18], holds about "
    )
    assert given.stderr.startswith(start)
    assert given.stderr.endswith(" of them; runs without room are quarantined\n")
    number = int(given.stderr.removeprefix(start).split()[0])
    scenario = ae.Scenario.load(job)
    assert scenario.warnings == ()
    assert len(study.make_plan(scenario).warnings) == 1
    fitting = ae.replicate(scenario.replace("robots.rover.count", number - 20), 4)
    crowded = ae.replicate(scenario.replace("robots.rover.count", number + 20), 4)
    assert (fitting["time_s"].null_count, crowded["time_s"].null_count) == (0, 4)


HALL = """
engine = "metric"
summary = "A hall with a closed room."
merit = "equation-5.2"
clock = { time_limit_s = 60 }
[world]
size_m = [20, 20]
obstacles = [
    { rectangle = { at_m = [15, 17.5], size_m = [0.2, 5] } },
    { rectangle = { at_m = [17.5, 15], size_m = [5, 0.2] } },
]
[items.mine]
count = 4
[robots.rover]
count = 2
radius_m = 0.3
start = { kind = "uniform", within_m = [[1, 1], [5, 19]] }
drive = { max_speed_m_s = 0.5 }
sensors = { detector = { kind = "items", range_m = 3 } }
"""

CLOSED = (
    "no robot with a sensor for it can reach 5.9% of its free area, near [17.4, 17.4], within "
    "range: about 22% of runs have one there; limit the area with within_m, make a way wider than "
    "0.6 m, or start a robot there"
)


def test_check_warns_of_a_closed_room_in_which_items_may_lie(tmp_path: Path) -> None:
    file = tmp_path / "hall.toml"
    file.write_text(HALL)
    given = run("check", file)
    assert given.returncode == 0
    assert given.stderr == f"warning: {file}:12: items.mine.placement: {CLOSED}\n"
    (warning,) = json.loads(run("check", file, "--json").stdout)
    assert (warning["path"], warning["effect"]) == ("items.mine.placement", CLOSED)
    # What the warning advises.
    for old, new in (
        ("size_m = [5, 0.2]", "size_m = [3.7, 0.2]"),
        ("count = 4", 'count = 4\nplacement = { kind = "uniform", within_m = [[0, 0], [14, 20]] }'),
        (
            'kind = "uniform", within_m = [[1, 1], [5, 19]]',
            'kind = "fixed", at_m = [[2, 2], [18, 18]]',
        ),
    ):
        file.write_text(HALL.replace(old, new))
        assert ae.Scenario.load(file).warnings == ()


def test_items_in_a_closed_room_are_as_frequent_as_the_warning_states() -> None:
    # 400 runs: the share is within three standard errors, 6%, with a probability above 99%.
    scenario = ae.Scenario.loads(HALL)
    closed = 0
    for run_number in range(400):
        items = ae.Simulation(scenario, run=run_number).items
        x_m, y_m = (items[axis].to_numpy() for axis in ("x_m", "y_m"))
        closed += bool(((x_m > 15) & (y_m > 15)).any())
    assert closed / 400 == pytest.approx(0.22, abs=0.06)


def test_a_warning_of_a_replaced_value_names_the_option(job: Path) -> None:
    given = run("check", job, "--set", "robots.rover.count=1000", "--set", "study.vary={}")
    lines = given.stderr.splitlines()
    assert given.returncode == 0
    assert lines[1].startswith(
        "warning: --set robots.rover.count: robots.rover.count = 1000: no room: their start area,"
    )
    assert len(lines) == 2


def test_bundled_scenarios_have_no_warnings_and_are_examined_quickly() -> None:
    plans = [study.make_plan(ae.Scenario.load(name)) for name in scenarios()]
    begin = time.process_time()
    found = [plan.scenario.warnings + plan.warnings for plan in plans]
    assert time.process_time() - begin < 0.5 * len(plans)
    assert not any(found)


def test_other_image_formats_are_refused_with_what_is_read(job: Path) -> None:
    job.with_name("room.pgm").write_bytes(b"BM" + bytes(60))
    assert refuse("check", job) == (
        "room.pgm: must be a PGM image (P5 or P2) or a PNG image; it is a BMP image: convert it, "
        "such as with ImageMagick: magick IMAGE IMAGE.png\n"
    )

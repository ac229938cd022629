"""The 2003 simulator from Python."""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy import InputError, _core, classic

ROOT = Path(__file__).resolve().parents[2]
TRACES = sorted((ROOT / "crates/classic/tests/traces").glob("*.json"))


@pytest.mark.parametrize("file", TRACES, ids=lambda file: file.stem)
def test_traces_equal_the_golden_files_value_for_value(file: Path) -> None:
    case = json.loads(file.read_text())
    trace = classic.trace(case["start"], len(case["decisions"]))
    assert trace == {key: case[key] for key in ("start_grid", "paints", "decisions")}


def test_a_trace_has_the_requested_decisions_and_34_paints() -> None:
    start = classic.start(2, seed=1, run=5)
    for decisions in (0, 1, 2, 50):
        trace = classic.trace(start, decisions)
        assert len(trace["decisions"]) == decisions
        assert len(trace["paints"]) == 34


def test_start_returns_the_team_that_replicate_runs() -> None:
    # With a time limit of 0 paints, a run finds only items close to the start, counted here.
    items = [(3, 17), (9, 5), (14, 22), (21, 8)]
    _, found, _ = _core.replicate(
        3, 300, contact="within-3", time_limit_paints=0, seed=4, first_run=0, threads=None
    )
    near = []
    for run in range(300):
        cells = [(each["x"] / 20, each["y"] / 20) for each in classic.start(3, seed=4, run=run)]
        near.append(
            sum(any(max(abs(x - ix), abs(y - iy)) <= 3 for x, y in cells) for ix, iy in items)
        )
    assert found.tolist() == near
    assert len(set(near)) > 2


def test_starts_are_shared_by_teams_of_different_size_and_uniform() -> None:
    counts: Counter[float] = Counter()
    for run in range(4000):
        team = classic.start(8, seed=11, run=run)
        assert team[:3] == classic.start(3, seed=11, run=run)
        assert [robot["heading"] for robot in team] == [0, 45, 90, 135, 180, 225, 270, 315]
        counts.update(robot[axis] / 20 for robot in team for axis in "xy")
    # 64,000 coordinates on 17 cells: chi-square with 16 degrees of freedom is above 39.3 by
    # chance once in a thousand; the seed is fixed.
    expected = 64_000 / 17
    assert set(counts) == set(range(4, 21))
    assert sum((count - expected) ** 2 / expected for count in counts.values()) < 39.3


@pytest.mark.parametrize(
    ("contact", "one", "two"),
    [
        ("neighbour", 73, 9450),
        ("diagonal", 75, 10_646),
        ("within-2", 0, 5870),
        ("within-3", 0, 3587),
        ("touch", 82, 18_106),
        ("ahead", 76, 12_623),
    ],
)
def test_exhaust_proves_which_starts_never_complete(contact: str, one: int, two: int) -> None:
    for robots, never in ((1, one), (2, two)):
        table = classic.exhaust(robots, contact)
        assert table.num_rows == 289**robots
        assert table["paints"].null_count == never


def test_exhaust_has_a_row_for_each_start() -> None:
    table = classic.exhaust(2, "within-3")
    assert table.column_names == ["x0", "y0", "x1", "y1", "paints"]
    rows = set(zip(*(table[name].to_pylist() for name in table.column_names[:4]), strict=True))
    assert len(rows) == 83_521
    assert {value for row in rows for value in row} == set(range(4, 21))


def test_exhaust_and_replicate_agree_on_the_same_start() -> None:
    every = {
        (row["x0"], row["y0"]): row["paints"] for row in classic.exhaust(1, "ahead").to_pylist()
    }
    for row in classic.replicate(1, 500, contact="ahead", seed=2).to_pylist():
        robot = classic.start(1, seed=2, run=row["run"])[0]
        assert every[robot["x"] / 20, robot["y"] / 20] == row["paints"]


def test_replicate_has_the_stated_columns_and_ranges() -> None:
    table = classic.replicate(2, 1000)
    assert {field.name: str(field.type) for field in table.schema} == {
        "run": "int64",
        "paints": "int64",
        "found": "int64",
        "collisions": "int64",
    }
    rows = table.to_pylist()
    assert [row["run"] for row in rows] == list(range(1000))
    assert table["paints"].null_count > 0
    for row in rows:
        in_time = row["paints"] is not None and row["paints"] <= classic.TIME_LIMIT_PAINTS
        assert (row["found"] == 4) == in_time
        assert 0 <= row["collisions"] <= 2 * 610


def test_replicate_is_the_same_for_any_number_of_threads_and_runs() -> None:
    table = classic.replicate(4, 9000, contact="diagonal", seed=8)
    for threads in (1, 2, 7):
        assert table.equals(classic.replicate(4, 9000, contact="diagonal", seed=8, threads=threads))
    assert table.slice(0, 100).equals(classic.replicate(4, 100, contact="diagonal", seed=8))
    assert not table.equals(classic.replicate(4, 9000, contact="diagonal", seed=9))


BAD_STARTS = [
    ([], "start = []: must be a list of 1 to 250 dicts"),
    ("here", "start = 'here': must be a list"),
    ([{"x": 0}], "start[0] = {'x': 0}: must be a dict with exactly x, y, heading, speed"),
    ([7], "start[0] = 7: must be a dict"),
    ([{"x": 900, "y": 20, "heading": 0, "speed": 1}], "start[0].x = 900: must be a number of"),
    ([{"x": 20, "y": -11, "heading": 0, "speed": 1}], "start[0].y = -11: must be a number of"),
    ([{"x": float("nan"), "y": 0, "heading": 0, "speed": 1}], "start[0].x = nan"),
    (
        [{"x": 20, "y": 20, "heading": 30, "speed": 1}],
        "start[0].heading = 30: must be one of 0, 45",
    ),
    ([{"x": 20, "y": 20, "heading": 0, "speed": 3}], "start[0].speed = 3: must be a whole number"),
    ([{"x": True, "y": 20, "heading": 0, "speed": 1}], "start[0].x = True"),
]


@pytest.mark.parametrize(("start", "message"), BAD_STARTS)
def test_an_invalid_start_is_named_with_what_is_allowed(start: Any, message: str) -> None:
    with pytest.raises(InputError) as caught:
        classic.trace(start, 1)
    assert message in str(caught.value)


def test_a_trace_has_a_maximum_length() -> None:
    with pytest.raises(InputError, match="decisions = 1000000: must be .* from 0 to 500000"):
        classic.trace(classic.start(2), 1_000_000)


def test_a_long_value_is_shortened_in_its_message() -> None:
    with pytest.raises(InputError) as caught:
        classic.trace(classic.start(250) * 2, 1)
    assert len(str(caught.value)) < 200


def test_all_errors_of_a_call_are_reported() -> None:
    with pytest.raises(InputError) as caught:
        classic.replicate(0, -3, contact="tuoch", seed=-1, threads=0)
    message = str(caught.value)
    for part in (
        "robots = 0: must be a whole number from 1 to 250",
        "runs = -3: must be a whole number from 0 to",
        "contact = 'tuoch': must be one of \"neighbour\"",
        'did you mean "touch"?',
        "seed = -1: must be a whole number from 0 to",
        "threads = 0: must be a whole number from 1 to",
    ):
        assert part in message


@pytest.mark.parametrize("robots", [0, 3, 1.5, "1", True, None])
def test_exhaust_takes_one_or_two_robots_only(robots: Any) -> None:
    with pytest.raises(InputError, match="robots = .*: must be a whole number from 1 to 2"):
        classic.exhaust(robots, "touch")


coordinate = st.floats(-10, 489.5, width=32)
robot = st.fixed_dictionaries(
    {
        "x": coordinate,
        "y": coordinate,
        "heading": st.sampled_from(range(0, 361, 45)),
        "speed": st.sampled_from([0, 1, 2]),
    }
)


@given(st.lists(robot, min_size=1, max_size=12))
def test_any_start_on_the_grid_runs_and_robots_snap_to_cells(start: Any) -> None:
    trace = classic.trace(start, 30)
    for _carry, _grid, *robots in trace["decisions"]:
        for x, y, heading, speed, *_turns, colour in robots:
            assert x % 20 == 0
            assert y % 20 == 0
            assert heading % 45 == 0
            assert speed in (0, 1, 2)
            assert colour in "byr"


@pytest.mark.parametrize("contact", ["neighbour", "diagonal", "within-2", "ahead"])
def test_a_looser_contact_is_never_later(contact: str) -> None:
    # Each definition on cells implies within-3, so it cannot complete sooner on the same run.
    strict = classic.replicate(4, 2000, contact=contact, seed=1)["paints"].to_pylist()
    loose = classic.replicate(4, 2000, contact="within-3", seed=1)["paints"].to_pylist()
    assert all(
        late is None or (early is not None and early <= late)
        for late, early in zip(strict, loose, strict=True)
    )

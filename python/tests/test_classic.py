"""The 2003 simulator: traces of the original, starts and definitions of contact."""

import json
from collections import Counter
from pathlib import Path

import pytest

import agent_economy as ae

ROOT = Path(__file__).resolve().parents[2]
TRACES = ROOT / "crates/classic/tests/traces"

RUNS = {
    0: 297,
    16: 516,
    24: 94,
    40: 537,
    1: 39_359,
    9: 197_545,
    25: 234_346,
    33: 32_307,
    10: 39_125_834,
    18: 3_744_151,
    34: 20_101_948,
    42: 8_835_156,
}
"""Golden traces of one, two and three robots, and the runs of seed 0 that start like them."""

COLUMNS = ("x_px", "y_px", "heading_deg", "speed", "left_turns", "right_turns", "colour")


def scenario(robots: int = 4, contact: str = "touch", time_limit_s: float = 120) -> ae.Scenario:
    """Return the experiment of 2003 with other values."""
    team = ae.Scenario.load("classic").replace("robots.wanderer.count", robots)
    return team.replace("contact", contact).replace("clock.time_limit_s", time_limit_s)


def visible(simulation: ae.ClassicSimulation) -> list[list[object]]:
    """Return the robots as in the golden files."""
    rows = [[row[name] for name in COLUMNS] for row in simulation.team.to_pylist()]
    return [[*numbers, colour[0]] for *numbers, colour in rows]


@pytest.mark.parametrize("number", RUNS)
def test_traces_equal_the_golden_files_value_for_value(number: int) -> None:
    case = json.loads((TRACES / f"case_{number:03}.json").read_text())
    simulation = ae.ClassicSimulation(scenario(case["n"]), 0, RUNS[number])
    paints, decisions = [], []
    while not simulation.is_over:
        decides = simulation.decides_in == 1
        simulation.step()
        paints.append([robot[:2] for robot in visible(simulation)])
        if decides:
            decisions.append([simulation.carry, *visible(simulation)])
    assert len(paints) >= len(case["paints"])
    assert paints[: len(case["paints"])] == case["paints"]
    expected = [[carry, *robots] for carry, _grid, *robots in case["decisions"]]
    compared = min(len(decisions), len(expected))
    assert compared > 100
    assert decisions[:compared] == expected[:compared]


def test_a_run_starts_with_the_team_that_replicate_runs() -> None:
    # With a time limit of 0 s, a run finds only items close to the start, counted here.
    items = [(3, 17), (9, 5), (14, 22), (21, 8)]
    team = scenario(3, "within-3", 0)
    near = []
    for run in range(300):
        robots = ae.ClassicSimulation(team, 4, run).team.to_pylist()
        cells = [(robot["column"], robot["row"]) for robot in robots]
        near.append(
            sum(any(max(abs(x - ix), abs(y - iy)) <= 3 for x, y in cells) for ix, iy in items)
        )
    assert ae.replicate(team, 300, seed=4)["found"].to_pylist() == near
    assert len(set(near)) > 2


def test_starts_are_shared_by_teams_of_different_size_and_uniform() -> None:
    counts: Counter[float] = Counter()
    large, small = scenario(250), scenario(3)
    headings = [index * 45 % 360 for index in range(250)]
    for run in range(128):
        team = ae.ClassicSimulation(large, 11, run).team
        assert team.slice(0, 3) == ae.ClassicSimulation(small, 11, run).team
        assert team["heading_deg"].to_pylist() == headings
        for axis in ("x_px", "y_px"):
            counts.update(px / 20 for px in team[axis].to_pylist())
    # 64,000 coordinates on 17 cells: chi-square with 16 degrees of freedom is above 39.3 by
    # chance once in a thousand; the seed is fixed.
    expected = 64_000 / 17
    assert set(counts) == set(range(4, 21))
    assert sum((count - expected) ** 2 / expected for count in counts.values()) < 39.3


def test_paints_found_and_collisions_are_within_their_ranges() -> None:
    table = ae.replicate(scenario(2), 1000)
    assert table["paints"].null_count > 0
    for row in table.to_pylist():
        in_time = row["paints"] is not None and row["paints"] <= 6720
        assert row["complete"] == in_time == (row["found"] == 4)
        assert 0 <= row["collisions"] <= 2 * 610


def test_replicate_is_the_same_for_any_number_of_threads_and_runs() -> None:
    team = scenario(4, "diagonal")
    table = ae.replicate(team, 9000, seed=8)
    for threads in (1, 2, 7):
        assert table.equals(ae.replicate(team, 9000, seed=8, threads=threads))
    assert table.slice(0, 100).equals(ae.replicate(team, 100, seed=8))
    assert not table.equals(ae.replicate(team, 9000, seed=9))


@pytest.mark.parametrize("contact", ["neighbour", "diagonal", "within-2", "ahead"])
def test_a_looser_contact_is_never_later(contact: str) -> None:
    # Each definition on cells implies within-3, so it cannot complete sooner on the same run.
    strict = ae.replicate(scenario(contact=contact), 2000, seed=1)["paints"].to_pylist()
    loose = ae.replicate(scenario(contact="within-3"), 2000, seed=1)["paints"].to_pylist()
    assert all(
        late is None or (early is not None and early <= late)
        for late, early in zip(strict, loose, strict=True)
    )

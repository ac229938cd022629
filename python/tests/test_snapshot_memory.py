"""The memory that snapshots take."""

import subprocess
import sys
from pathlib import Path

import pytest

import agent_economy as ae
from agent_economy.server.runs import snapshots
from agent_economy.server.runs.snapshots import FIRST_INTERVAL, MIN_SNAPSHOTS
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 600.0

HAS_STATM = Path("/proc/self/statm").exists()

# The memory of other tests would hide that of snapshots: it is measured in a process of its own.
MEASURE = """
from pathlib import Path
import resource
import agent_economy as ae
from agent_economy.server.runs import snapshots
from agent_economy.server.runs.timeline import Timeline
from test_snapshot_memory import endless

def resident_bytes():
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
"""


def endless(robots: int, cells: int = 65_000) -> ae.Scenario:
    """Return a search that does not end, by robots whose maps have at most this number of cells."""
    scenario = ae.Scenario.load("search-beliefs").replace("clock.time_limit_s", 10_000)
    scenario = scenario.replace("items.mine.count", 0).replace("world.size_m", [100, 100])
    scenario = scenario.replace("robots.rover.brain.beliefs.cells", cells)
    return scenario.replace("robots.rover.count", robots)


def measured(script: str) -> list[int]:
    """Return the numbers that a script prints."""
    command = [sys.executable, "-c", MEASURE + script]
    given = subprocess.run(
        command, cwd=Path(__file__).parent, capture_output=True, text=True, check=False
    )
    assert given.returncode == 0, given.stderr
    return [int(number) for number in given.stdout.split()]


@pytest.mark.skipif(not HAS_STATM, reason="no /proc/self/statm")
def test_snapshots_take_as_much_memory_as_they_state() -> None:
    stated, taken = measured("""
simulation = ae.Simulation(endless(8), seed=1)
simulation.step(50)
before = resident_bytes()
kept = [simulation.snapshot() for _ in range(50)]
print(sum(each.bytes for each in kept), resident_bytes() - before)
""")
    assert 1 / 1.5 < taken / stated < 1.5


@pytest.mark.skipif(not HAS_STATM, reason="no /proc/self/statm")
def test_a_run_with_large_maps_grows_by_about_the_budget_of_its_snapshots() -> None:
    budget = 15_000_000
    (taken,) = measured(f"""
snapshots.MEMORY_BYTES = {budget}
timeline = Timeline(endless(8), 1)
timeline.seek(20, {FOREVER_S})
before = resident_bytes()
timeline.seek({20 * FIRST_INTERVAL}, {FOREVER_S})
print(resident_bytes() - before)
""")
    assert taken < 1.5 * budget


@pytest.mark.parametrize(("robots", "exceeds"), [(2, False), (8, True)])
def test_snapshots_exceed_their_budget_only_if_the_minimum_number_is_left(
    monkeypatch: pytest.MonkeyPatch, robots: int, *, exceeds: bool
) -> None:
    budget = 5_000_000
    monkeypatch.setattr(snapshots, "MEMORY_BYTES", budget)
    timeline = Timeline(endless(robots), 1)
    counts, exceeded = [], False
    for tick in range(0, 20 * FIRST_INTERVAL, FIRST_INTERVAL):
        assert timeline.seek(tick, FOREVER_S)
        kept = timeline._snapshots._kept
        counts.append(len(kept))
        if sum(each.bytes for each in kept) > budget:
            exceeded = True
            assert len(kept) <= MIN_SNAPSHOTS
    assert exceeded == exceeds
    assert max(counts) > MIN_SNAPSHOTS or exceeds


def test_larger_maps_make_larger_snapshots() -> None:
    small, large = (ae.Simulation(endless(4, cells), seed=1) for cells in (1_000, 65_000))
    assert large.snapshot().bytes > 5 * small.snapshot().bytes


def test_a_classic_snapshot_grows_with_its_team() -> None:
    scenario = ae.Scenario.load("classic")
    teams = (scenario.replace("robots.wanderer.count", count) for count in (1, 40))
    one, many = (ae.ClassicSimulation(team, seed=1).snapshot().bytes for team in teams)
    assert 0 < one < many < 1_000_000

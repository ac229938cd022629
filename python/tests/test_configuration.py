"""Configurations and blocks of their runs."""

import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alarm import ringing
from command_line import run_python

from agent_economy import ClassicSimulation, InputError, Scenario, _core
from agent_economy.study import design

COLUMNS = ["time_s", "failed", "robots", "found", "collisions", "paints"]


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    """Return the 2003 experiment."""
    return Scenario.load(Path(__file__).resolve().parents[2] / "scenarios/classic.toml")


def teams(scenario: Scenario, *sizes: int) -> list[_core.Configuration]:
    """Return a configuration for each team size."""
    return [scenario.configuration({"robots.wanderer.count": size}) for size in sizes]


def block(configurations: list[_core.Configuration], **changes: Any) -> dict[str, Any]:
    """Run a block with usual arguments."""
    usual: dict[str, Any] = {"seed": 1, "first_run": 0, "runs": 40, "threads": None}
    return _core.run_block(configurations, **usual | changes)


def test_columns_have_names_kinds_and_bounds(scenario: Scenario) -> None:
    # A team decides 610 times: in paints 12, 23, ..., 6711 of 6720.
    assert scenario.configuration({"robots.wanderer.count": 3}).columns == [
        ("time_s", "real", 0.0, 120.0),
        ("failed", "flag", 0.0, 1.0),
        ("robots", "whole", 3.0, 3.0),
        ("found", "whole", 0.0, 4.0),
        ("collisions", "whole", 0.0, 1830.0),
        ("paints", "whole", 0.0, None),
    ]


def test_a_block_equals_stepped_runs_of_each_team(scenario: Scenario) -> None:
    sizes = (1, 3, 17)
    given = block(teams(scenario, *sizes), seed=9, first_run=70, runs=100)
    assert list(given) == COLUMNS
    for index, size in enumerate(sizes):
        team = scenario.replace("robots.wanderer.count", size)
        rows = [ClassicSimulation(team, 9, 70 + run).finish().row for run in range(100)]
        paints = np.array([np.inf if row["paints"] is None else row["paints"] for row in rows])
        failed = paints > 6720
        expected = {
            "time_s": np.where(failed, 120, paints / 56),
            "failed": failed,
            "robots": np.full(100, size),
            "found": [row["found"] for row in rows],
            "collisions": [row["collisions"] for row in rows],
            "paints": paints,
        }
        for name, values in expected.items():
            assert given[name].shape == (3, 100)
            assert given[name].dtype == np.float64
            np.testing.assert_array_equal(given[name][index], values)
    assert np.isinf(given["paints"]).any()


def test_every_factor_changes_the_runs(scenario: Scenario) -> None:
    same = block([scenario.configuration({})])
    values: dict[str, str | float] = {
        "robots.wanderer.count": 5,
        "clock.paints_per_s": 41.5,
        "clock.time_limit_s": 10,
        "contact": "within-3",
    }
    for path, value in values.items():
        other = block([scenario.configuration({path: value})])
        assert any(not np.array_equal(same[name], other[name]) for name in COLUMNS)


def test_threads_and_neighbours_change_no_byte(scenario: Scenario) -> None:
    configurations = teams(scenario, *range(1, 12))
    one = block(configurations, runs=101, threads=1)
    for threads in (2, 3, 8, None):
        given = block(configurations, runs=101, threads=threads)
        assert all(given[name].tobytes() == one[name].tobytes() for name in COLUMNS)
    part = block(configurations[4:5], first_run=50, runs=7)
    for name in COLUMNS:
        np.testing.assert_array_equal(part[name][0], one[name][4, 50:57])


def test_merits_of_a_block_are_within_the_bounds_of_the_configuration(scenario: Scenario) -> None:
    scenario = scenario.replace("study.vary.contact", "touch,ahead,within-3")
    merit = scenario.replace(
        "merit", {"time": -0.03, "collisions": -0.7, "paints": {"weight": -0.1, "max": 500}}
    ).merit
    configurations = [scenario.configuration(point) for point in design.points(scenario.factors)]
    scores = merit.score(block(configurations, runs=200))
    assert scores.shape == (24, 200)
    for row, configuration in zip(scores, configurations, strict=True):
        bounds = {name: (low, high) for name, _, low, high in configuration.columns}
        low, high = merit.bounds(bounds)
        assert np.all((low <= row) & (row <= high))


def test_a_block_may_have_no_runs(scenario: Scenario) -> None:
    assert block(teams(scenario, 1, 2), runs=0)["paints"].shape == (2, 0)


def test_replace_returns_the_scenario_with_another_value(scenario: Scenario) -> None:
    changed = scenario.replace("clock.time_limit_s", 60).replace("contact", "ahead")
    changed = changed.replace("study.vary.clock.paints_per_s", "50,41.5")
    assert (changed.time_limit_s, changed.facts[0], scenario.time_limit_s) == (
        60,
        ("contact", "ahead"),
        120,
    )
    rates = [factor.values for factor in changed.factors]
    assert rates == [(1, 2, 3, 4, 5, 6, 7, 8), (41.5, 50)]
    assert changed.configuration({}).columns[0] == ("time_s", "real", 0.0, 60.0)
    assert changed.replace("clock.time_limit_s", 90).time_limit_s == 90
    with pytest.raises(
        InputError, match="^replace: clock.time_limit_s = -1: must be a number from 0"
    ):
        scenario.replace("clock.time_limit_s", -1)


def test_optional_keys_of_a_study_are_read(scenario: Scenario) -> None:
    assert (scenario.design, scenario.delta, scenario.confidence) == ("factorial", 0.01, 0.95)
    given = scenario.replace("study.design", "lhs:200").replace("study.delta", 0.05)
    given = given.replace("study.confidence", 0.99)
    given = given.replace("study.vary.clock.paints_per_s", "41.0..57.0")
    assert (given.design, given.delta, given.confidence) == ("lhs:200", 0.05, 0.99)
    assert given.factors[1].range == (41.0, 57.0)


def test_all_invalid_values_of_a_configuration_are_reported(scenario: Scenario) -> None:
    with pytest.raises(InputError) as caught:
        scenario.configuration({"robots.wanderer.count": 0, "contact": "tuoch"})
    message = str(caught.value)
    assert "study.vary: robots.wanderer.count = 0: must be a whole number from 1 to 250" in message
    assert 'did you mean "touch"?' in message
    with pytest.raises(InputError) as caught:
        scenario.configuration({"robots.rover.count": 1})
    assert str(caught.value) == (
        "study.vary: robots.rover.count is not a known key: expected one of "
        "robots.wanderer.count, clock.paints_per_s, clock.time_limit_s, contact; did you mean "
        "robots.wanderer.count?"
    )
    # Each value is allowed, but a time limit over a million paints is not.
    with pytest.raises(InputError, match="must be at most 1000000 paints at 1000 paints per sec"):
        scenario.configuration({"clock.paints_per_s": 1000, "clock.time_limit_s": 1001})


def test_all_invalid_arguments_of_a_block_are_reported(scenario: Scenario) -> None:
    anything: Any = [teams(scenario, 1)[0], 7, "x"]
    with pytest.raises(InputError) as caught:
        block(anything, seed=-1, first_run=1.5, runs=True, threads=0)
    message = str(caught.value)
    for part in (
        "configurations[1] = 7: must be a Configuration",
        "configurations[2] = 'x': must be a Configuration",
        "seed = -1: must be a whole number",
        "first_run = 1.5: must be",
        "runs = True: must be",
        "threads = 0: must be a whole number from 1 to 1024",
    ):
        assert part in message
    with pytest.raises(InputError, match=r"configurations = \[\]: must be a list of at least one"):
        block([])
    with pytest.raises(InputError, match="runs = 5000001: must be .* from 0 to 5000000"):
        block(teams(scenario, 1, 2), runs=5_000_001)


def test_a_signal_stops_a_long_block(scenario: Scenario) -> None:
    with ringing(0.3):
        block(teams(scenario, *range(100, 140)), runs=100_000)
    assert block(teams(scenario, 2), runs=3)["robots"].tolist() == [[2, 2, 2]]


def test_other_threads_run_while_a_block_is_computed(scenario: Scenario) -> None:
    ticks = []
    worker = threading.Thread(target=lambda: block(teams(scenario, 100), runs=5000))
    worker.start()
    while worker.is_alive():
        ticks.append(time.monotonic())
        time.sleep(0.001)
    assert len(ticks) > 10


def test_a_forked_process_has_its_own_threads(classic_toml: Path) -> None:
    forked = f"""
import os
from agent_economy import Scenario, _core
given = [Scenario.load({str(classic_toml)!r}).configuration({{}})]
def paints():
    return _core.run_block(given, seed=1, first_run=0, runs=99, threads=2)["paints"].tobytes()
before = paints()
child = os.fork()
if not child:
    os._exit(0 if paints() == before else 1)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert paints() == before
"""
    given = run_python(forked)
    assert given.returncode == 0, given.stderr

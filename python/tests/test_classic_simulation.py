"""Interactive runs of the classic engine."""

from typing import Any

import pytest

import agent_economy as ae
from agent_economy import _core


def classic(**values: str | float) -> ae.Scenario:
    scenario = ae.Scenario.load("classic")
    for path, value in values.items():
        scenario = scenario.replace(path.replace("__", "."), value)
    return scenario


@pytest.mark.parametrize("robots", [1, 2, 4, 8])
@pytest.mark.parametrize("contact", _core.CONTACTS)
def test_a_finished_run_is_a_row_of_replicate(robots: int, contact: str) -> None:
    scenario = classic(robots__wanderer__count=robots, contact=contact, clock__time_limit_s=20)
    rows = ae.replicate(scenario, runs=30, seed=3).to_pylist()
    assert [ae.ClassicSimulation(scenario, 3, run).finish().row for run in range(30)] == rows
    assert ae.ClassicSimulation(scenario, 3, 4).finish() == ae.run(scenario, seed=3, run=4)


def test_a_run_in_parts_equals_the_run_in_one_call() -> None:
    one, other = ae.ClassicSimulation("classic", 7), ae.ClassicSimulation("classic", 7)
    one.step(500)
    for steps in (0, 1, 11, 488):
        other.step(steps)
    assert (one.hash, one.tick, one.time_s) == (other.hash, 500, 500 / 56)
    other.step()
    assert one.hash != other.hash


def test_a_finished_run_does_not_advance_unless_a_change_allows_it() -> None:
    simulation = ae.ClassicSimulation(classic(clock__time_limit_s=5), 1)
    assert simulation.finish().status == "incomplete"
    assert simulation.tick == 5 * 56
    hash_ = simulation.hash
    simulation.step(100)
    assert simulation.hash == hash_
    simulation.change("clock.time_limit_s", 120)
    assert not simulation.is_over
    assert simulation.finish() == ae.run("classic", seed=1)


def test_changes_are_logged_and_reproduce_the_run() -> None:
    changes: list[tuple[int, str, Any]] = [
        (10, "robots.wanderer.count", 200),
        (31, "contact", "ahead"),
        (31, "robots.wanderer.count", 3),
        (60, "clock.paints_per_s", 28),
        (60, "merit", {"time": -1}),
        (95, "clock.time_limit_s", 400),
    ]
    first, hashes = ae.ClassicSimulation("classic", 2, 9), []
    for tick, path, value in changes:
        first.step(tick - first.tick)
        first.change(path, value)
        hashes.append(first.hash)
    assert [tuple(change) for change in first.changes] == changes
    assert (first.step_s, first.time_s) == (1 / 28, 95 / 28)
    again = ae.ClassicSimulation("classic", 2, 9)
    for change, hash_ in zip(first.changes, hashes, strict=True):
        again.step(change.tick - again.tick)
        again.change(change.path, change.value)
        assert again.hash == hash_
    assert again.finish() == first.finish()
    assert again.hash == first.hash


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        ("robots.wanderer.count", 0, "a whole number from 1 to 250"),
        ("robots.wanderer.count", 251, "a whole number from 1 to 250"),
        ("contact", "nose", "one of"),
        ("clock.time_limit_s", -1, "a number from 0"),
        ("clock.paints_per_s", 10_000, "a number from 0.1 to 1000"),
        ("world.size_m", [3, 3], 'only the engine "metric" has it'),
        ("engine", "metric", "is not a known key"),
    ],
)
def test_invalid_changes_are_named_and_change_nothing(
    path: str, value: str | float, expected: str
) -> None:
    simulation = ae.ClassicSimulation("classic")
    before = (simulation.hash, simulation.scenario)
    with pytest.raises(ae.InputError, match=expected):
        simulation.change(path, value)
    assert (simulation.hash, simulation.scenario, simulation.changes) == (*before, ())


def test_restoring_a_snapshot_restores_its_scenario_and_changes() -> None:
    simulation = ae.ClassicSimulation("classic", 4)
    simulation.step(20)
    simulation.change("robots.wanderer.count", 9)
    kept, hash_ = simulation.snapshot(), simulation.hash
    simulation.step(50)
    simulation.change("robots.wanderer.count", 2)
    simulation.restore(kept)
    assert (simulation.hash, len(simulation.robots), len(simulation.changes)) == (hash_, 9, 1)


def test_a_snapshot_of_another_classic_run_is_refused() -> None:
    simulation, other = (ae.ClassicSimulation("classic", seed) for seed in (4, 5))
    allowed = "must be of this run, 'classic', seed=4, run=0"
    with pytest.raises(ae.InputError, match=rf"is of the run 'classic', seed=5, run=0: {allowed}"):
        simulation.restore(other.snapshot())
    with pytest.raises(ae.InputError, match=r"must be what snapshot\(\) returned"):
        simulation.restore(ae.Simulation("search", 4).snapshot())


def test_found_items_have_a_time() -> None:
    simulation = ae.ClassicSimulation("classic", 1)
    assert simulation.items["found_s"].null_count == 4
    outcome = simulation.finish()
    assert max(simulation.items["found_s"].to_pylist()) == outcome.time_s


def test_a_robot_examines_three_near_and_three_far_cells() -> None:
    simulation = ae.ClassicSimulation("classic", 1)
    state = simulation.team.to_pylist()[0]
    column, row = state["column"], state["row"]
    near = [(column + side, row - 1) for side in (-1, 0, 1)]
    far = [(column + 2 * side, row - 2) for side in (-1, 0, 1)]
    assert state["heading_deg"] == 0
    assert simulation.examined_cells("wanderer/0") == near + far
    with pytest.raises(ae.InputError, match="wanderer/0 to wanderer/3"):
        simulation.examined_cells("wanderer/4")


def test_each_engine_rejects_scenarios_of_the_other() -> None:
    with pytest.raises(ae.InputError, match="ClassicSimulation"):
        ae.Simulation("classic")
    with pytest.raises(ae.InputError, match="use Simulation"):
        ae.ClassicSimulation("search")

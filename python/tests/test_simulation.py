"""Interactive runs of the metric engine."""

import pickle
import threading
from typing import Any

import numpy as np
import pytest
from alarm import ringing
from metric import ENDLESS, FULL, HUGE, search

import agent_economy as ae
from agent_economy import InputError, Scenario, Simulation


def stepped(steps: int, **arguments: Any) -> Simulation:
    """Return a run of the search after some steps."""
    simulation = Simulation("search", **{"seed": 1, "run": 3} | arguments)
    simulation.step(steps)
    return simulation


@pytest.mark.parametrize("name", ["search", "open-field"])
def test_a_run_in_single_steps_equals_the_run(name: str) -> None:
    stepwise = Simulation(name, seed=7, run=1)
    while not stepwise.is_over:
        assert stepwise.outcome().status == "running"
        stepwise.step()
    at_once = Simulation(name, seed=7, run=1)
    assert at_once.finish() == stepwise.outcome() == ae.run(name, 7, 1)
    assert at_once.hash == stepwise.hash
    assert at_once.tick == stepwise.tick


def test_several_steps_equal_as_many_single_steps() -> None:
    one_by_one = stepped(0)
    for _ in range(60):
        one_by_one.step()
    assert stepped(60).hash == one_by_one.hash
    assert stepped(61).hash != one_by_one.hash


def test_threads_change_no_result() -> None:
    huge = search(HUGE)
    hashes = set()
    for threads in (1, 2, 8, None):
        simulation = Simulation(huge, seed=3, threads=threads)
        simulation.step(4)
        hashes.add(simulation.hash)
    assert len(hashes) == 1


def test_arrays_have_one_row_per_robot_in_the_order_of_names() -> None:
    simulation = Simulation("open-field")
    assert simulation.robots == ("bird/0", "rover/0", "rover/1", "rover/2")
    simulation.step(30)
    assert simulation.poses.shape == (4, 3)
    assert simulation.poses.dtype == simulation.battery.dtype == simulation.speeds.dtype
    assert (np.abs(simulation.poses[:, 2]) <= np.pi).all()
    assert simulation.status.tolist() == ["active"] * 4
    assert ((simulation.battery < 1) & (simulation.battery > 0.9)).all()
    assert (simulation.speeds >= 0).all()
    assert simulation.speeds.max() > 0


def test_robots_start_at_the_positions_of_the_scenario() -> None:
    simulation = Simulation("open-field")
    begun = simulation.poses[1:]
    np.testing.assert_allclose(begun[:, :2], [[2, 2], [4, 2], [6, 2]])
    np.testing.assert_allclose(begun[:, 2], np.deg2rad([45, 45, 45]))


def test_a_battery_without_a_capacity_is_full() -> None:
    tireless = search({"robots.rover.battery.capacity_j": 1.0})
    simulation = Simulation(tireless)
    simulation.finish()
    assert simulation.status.tolist() == ["empty"] * 4
    assert (simulation.battery <= 0).all()
    assert simulation.outcome().robots_stopped == 4


def test_arrays_are_copies() -> None:
    simulation = stepped(0)
    poses, items = simulation.poses, simulation.items
    kept = poses.copy()
    simulation.step(50)
    np.testing.assert_array_equal(poses, kept)
    poses[:] = 0
    assert (simulation.poses != 0).any()
    assert items["found_s"].null_count == 4


def test_times_of_finds_agree_with_the_outcome() -> None:
    simulation = Simulation("search", seed=1)
    run = next(run for run in range(20) if ae.run("search", 1, run).complete)
    simulation = Simulation("search", seed=1, run=run)
    before = simulation.items
    outcome = simulation.finish()
    after = simulation.items
    assert before.select(["kind", "x_m", "y_m"]).equals(after.select(["kind", "x_m", "y_m"]))
    assert after["kind"].to_pylist() == ["mine"] * 4
    assert max(after["found_s"].to_pylist()) == outcome.time_s
    assert before["found_by"].to_pylist() == [""] * 4
    assert set(after["found_by"].to_pylist()) <= set(simulation.robots)


def test_time_is_the_number_of_steps_times_their_length() -> None:
    simulation = stepped(25)
    assert (simulation.tick, simulation.time_s) == (25, 2.5)


def test_times_are_exact_decimals() -> None:
    simulation = Simulation("search", seed=7, run=2)
    outcome = simulation.finish()
    assert repr(outcome.time_s) == "56.4"
    found_s = [*simulation.items["found_s"].to_pylist(), simulation.time_s]
    assert [repr(each) for each in found_s] == [f"{each:.1f}" for each in found_s]


def test_steps_continue_after_the_end() -> None:
    simulation = stepped(0)
    outcome = simulation.finish()
    tick = simulation.tick
    simulation.step(5)
    assert simulation.tick == tick + 5
    assert simulation.outcome().time_s == outcome.time_s


def test_a_snapshot_contains_the_complete_run() -> None:
    simulation = stepped(40)
    snapshot = simulation.snapshot()
    first = (simulation.finish(), simulation.hash)
    for _ in range(2):
        simulation.restore(snapshot)
        assert simulation.tick == 40
        assert (simulation.finish(), simulation.hash) == first


def test_a_snapshot_contains_the_changes() -> None:
    simulation = stepped(20)
    simulation.change("robots.rover.count", 6)
    snapshot = simulation.snapshot()
    simulation.step(20)
    hash_of_six = simulation.hash
    simulation.change("robots.rover.count", 2)
    simulation.restore(snapshot)
    assert len(simulation.robots) == 6
    assert simulation.scenario.robots == {"rover": 6}
    assert [change.value for change in simulation.changes] == [6]
    simulation.step(20)
    assert simulation.hash == hash_of_six


def test_a_snapshot_can_be_restored_in_another_simulation_of_the_same_run() -> None:
    here, there = stepped(33), stepped(0)
    there.change("robots.rover.count", 2)
    there.restore(here.snapshot())
    assert (there.seed, there.run, there.tick, there.changes) == (1, 3, 33, ())
    assert there.finish() == here.finish()
    assert there.hash == here.hash
    here.change("robots.rover.count", 6)
    same = Simulation(Scenario.loads(stepped(0).scenario.source.text, file="search.toml"), 1, 3)
    same.restore(here.snapshot())
    assert (same.hash, same.changes) == (here.hash, here.changes)


def test_a_snapshot_of_another_run_is_refused_and_both_runs_are_named() -> None:
    simulation = stepped(33)
    before = simulation.hash
    changed = Scenario.load("search").replace("clock.time_limit_s", 50)
    for other, which in (
        (Simulation("search", seed=2, run=3), "'search', seed=2, run=3"),
        (Simulation("search", seed=1, run=4), "'search', seed=1, run=4"),
        (Simulation("open-field", seed=1, run=3), "'open-field', seed=1, run=3"),
        (Simulation(changed, seed=1, run=3), "'search', seed=1, run=3 with another scenario of"),
    ):
        own = "must be of this run, 'search', seed=1, run=3"
        with pytest.raises(InputError, match=rf"snapshot is of the run {which}.*: {own}"):
            simulation.restore(other.snapshot())
        assert (simulation.hash, simulation.seed, simulation.run) == (before, 1, 3)


def test_other_types_than_snapshots_are_named() -> None:
    with pytest.raises(InputError, match=r"snapshot = 7: must be what snapshot\(\) returned"):
        stepped(0).restore(7)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        pickle.dumps(stepped(0).snapshot())


def test_a_larger_team_does_not_move_existing_robots() -> None:
    simulation = stepped(30)
    before, battery = simulation.poses, simulation.battery
    simulation.change("robots.rover.count", 7)
    assert simulation.robots == tuple(f"rover/{index}" for index in range(7))
    np.testing.assert_array_equal(simulation.poses[:4], before)
    np.testing.assert_array_equal(simulation.battery[:4], battery)
    assert simulation.tick == 30
    simulation.change("robots.rover.count", 3)
    np.testing.assert_array_equal(simulation.poses, before[:3])
    assert simulation.finish().robots == 3


def test_any_path_can_be_changed() -> None:
    simulation, same = stepped(30), stepped(30)
    simulation.change("robots.rover.drive.max_speed_m_s", 0.2)
    simulation.step(30)
    same.step(30)
    assert (simulation.speeds <= 0.2).all()
    assert (same.speeds > 0.2).any()


def test_the_time_limit_can_be_changed() -> None:
    simulation = stepped(30)
    simulation.change("clock.time_limit_s", 2.5)
    assert simulation.is_over
    assert simulation.outcome().status == "incomplete"
    assert simulation.outcome().time_s == 2.5


def test_changes_reproduce_the_run() -> None:
    simulation = stepped(10)
    simulation.change("robots.rover.count", 6)
    simulation.step(10)
    simulation.change("items.mine.count", 9)
    outcome = simulation.finish()
    assert [(change.tick, change.path) for change in simulation.changes] == [
        (10, "robots.rover.count"),
        (20, "items.mine.count"),
    ]
    again = stepped(0)
    for change in simulation.changes:
        again.step(change.tick - again.tick)
        again.change(change.path, change.value)
    assert again.finish() == outcome
    assert again.hash == simulation.hash


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        (
            "clock.step_s",
            0.05,
            "change: clock.step_s = 0.05: must be as it was when the run began",
        ),
        ("world.size_m", [30, 30], "change: world.size_m = .*: must be as it was"),
        ("world.periodic", True, "change: world.periodic = .*: must be as it was"),
        (
            "clock",
            {"step_s": 0.05, "time_limit_s": 9},
            "clock.step_s = 0.05: must be 0.1, as when the run",
        ),
        ("world", {"size_m": [30, 30]}, r"world.size_m = \[30, 30\]: must be \[25, 25\], as when"),
        (
            "world",
            {"size_m": [25, 25], "periodic": True},
            "world.periodic = true: must be false, as when",
        ),
        (
            "robots.rover.cuont",
            3,
            r"change: robots.rover.cuont is not a known key: .*did you mean count\?",
        ),
        ("robots.rover.count", -1, "change: robots.rover.count = -1: must be a whole number from"),
        ("engine", "classic", "engine = 'classic': must be 'metric'|is not a known key"),
    ],
)
def test_an_invalid_change_changes_nothing(path: str, value: Any, expected: str) -> None:
    simulation = stepped(15)
    before = simulation.hash
    with pytest.raises(InputError, match=expected):
        simulation.change(path, value)
    assert simulation.hash == before
    assert simulation.changes == ()
    assert simulation.scenario == Scenario.load("search")


@pytest.mark.parametrize("path", [None, 1, ["clock", "time_limit_s"]])
def test_a_path_must_be_a_string(path: Any) -> None:
    simulation = Simulation("search")
    for act in (simulation.change, simulation.scenario.replace):
        with pytest.raises(InputError, match=r"path = .*: must be keys from the root"):
            act(path, 1)
    assert simulation.changes == ()


def test_a_team_without_room_is_named() -> None:
    message = "robots.second: the run has no room for second/0: no free position found"
    with pytest.raises(InputError, match=message):
        Simulation(Scenario.loads(FULL))
    alone = Simulation(Scenario.loads(FULL).replace("robots.second.count", 0))
    before = alone.hash
    with pytest.raises(InputError, match=message):
        alone.change("robots.second.count", 1)
    assert alone.hash == before
    assert alone.robots == ("first/0",)


def test_the_classic_engine_has_its_own_simulation() -> None:
    with pytest.raises(InputError, match="engine = 'classic': must be 'metric'"):
        Simulation("classic")


def test_all_invalid_arguments_are_reported() -> None:
    with pytest.raises(InputError) as caught:
        Simulation("search", seed=-1, run=2**63, threads=5000)
    lines = str(caught.value).splitlines()
    assert [line.partition(" = ")[0] for line in lines] == ["seed", "run", "threads"]
    for steps in (-1, 1.5, True, "3"):
        with pytest.raises(InputError, match="steps = .*: must be a whole number from 0"):
            stepped(0).step(steps)  # type: ignore[arg-type]


def test_a_signal_stops_between_two_steps() -> None:
    simulation = Simulation(search(ENDLESS))
    with ringing(0.3):
        simulation.step(2**60)
    with ringing(0.3):
        simulation.finish()
    again = Simulation(search(ENDLESS))
    again.step(simulation.tick)
    assert simulation.tick > 0
    assert again.hash == simulation.hash


def test_threads_can_share_a_simulation() -> None:
    simulation = Simulation(search(HUGE))
    workers = [threading.Thread(target=simulation.step, args=(2,)) for _ in range(3)]
    for worker in workers:
        worker.start()
    while any(worker.is_alive() for worker in workers):
        assert simulation.poses.shape == (3000, 3)
    assert simulation.tick == 6


def test_the_representation_of_a_simulation_identifies_the_run() -> None:
    assert repr(stepped(4)) == "<Simulation of 'search', seed=1, run=3: tick 4>"

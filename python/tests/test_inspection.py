"""What robots with minds think, told while they run."""

import math
from typing import Any

import pytest
from example_brains import Bumper
from metric import search

from agent_economy import InputError, Simulation
from agent_economy.recording.metric_writer import moment_of

SEEK = {"robots.rover.brain.behaviours": [{"kind": "bayesian_search"}, {"kind": "avoid"}]}


def seeking(**arguments: Any) -> Simulation:
    """Return a search by robots with minds, after ten seconds."""
    simulation = Simulation(search(SEEK), seed=7, **arguments)
    simulation.step(100)
    return simulation


def test_a_robot_with_a_mind_knows_where_it_is_and_what_it_wants() -> None:
    simulation = seeking()
    # It thinks in every second step, of where it is before it moves.
    poses = simulation.poses.copy()
    simulation.step()
    for robot, true in zip(simulation.robots, poses, strict=True):
        belief_state = simulation.belief_state(robot)
        assert belief_state is not None
        pose = belief_state["pose"]
        assert pose is not None
        assert pose["at"] == pytest.approx(true[:2], abs=2.0)
        assert math.remainder(pose["heading_rad"] - true[2], math.tau) == pytest.approx(0, abs=0.1)
        assert len(belief_state["goals"]) <= 1
        for goal in belief_state["goals"]:
            assert goal["behaviour"] == 0
            assert goal["verdict"] in {"complete", "impossible", "approaching", "receding"}
    assert any(simulation.belief_state(robot)["goals"] for robot in simulation.robots)  # type: ignore[index]


def test_in_what_one_robot_found_and_told_all_believe() -> None:
    simulation = seeking()
    simulation.finish()
    for robot in simulation.robots:
        belief_state = simulation.belief_state(robot)
        assert belief_state is not None
        items = belief_state["items"]
        assert len(items) >= 2
        assert all(item["kind"] == 0 and 0 <= item["confidence"] <= 1 for item in items)


def test_to_look_at_thoughts_changes_nothing() -> None:
    looked, not_looked = seeking(), seeking()
    for robot in looked.robots:
        assert looked.belief_state(robot) == not_looked.belief_state(robot)
    looked.step(50)
    not_looked.step(50)
    assert looked.hash == not_looked.hash


def test_what_is_watched_is_what_the_robot_perceives_and_then_wants() -> None:
    simulation = seeking()
    simulation.inspect("rover/1")
    for _ in range(20):
        percept = simulation.percept("rover/1")
        told = simulation.inspection()
        assert told is not None
        assert percept is None or (percept, simulation.tick) == (told["percept"], told["tick"])
        simulation.step()
        wanted = moment_of(simulation)["commanded"][1]
        assert tuple(wanted) == tuple(told["command"]["motion"].values())
        belief_state = simulation.belief_state("rover/1")
        assert belief_state == told["belief_state"]


def test_to_watch_changes_nothing_and_holds_when_the_run_is_put_back() -> None:
    watched, free = seeking(), seeking()
    watched.inspect("rover/0")
    before = watched.snapshot()
    for simulation in (watched, free):
        simulation.step(51)
    told = watched.inspection()
    assert watched.hash == free.hash
    watched.restore(before)
    watched.step(51)
    assert watched.inspection() == told
    watched.change("robots.rover.count", 6)
    assert watched.inspection() is None
    watched.step(2)
    assert watched.inspection() is not None
    watched.change("robots.rover.count", 0)
    assert watched.inspection() is None
    watched.inspect(None)
    assert watched.inspection() is None


def test_of_the_places_around_it_a_robot_takes_the_one_that_is_worth_most() -> None:
    simulation = seeking()
    simulation.inspect("rover/0")
    looked = 0
    for _ in range(100):
        simulation.step()
        told = simulation.inspection()
        assert told is not None
        assert told["belief_state"] is not None
        reach = told["belief_state"]["reach"]
        if reach is not None:
            looked += 1
            most = max(course["utility"] for course in reach["courses"])
            assert reach["courses"][reach["taken"]]["utility"] == pytest.approx(most)
    assert looked > 50


def test_a_map_says_what_is_free_and_what_nobody_has_seen() -> None:
    simulation = seeking()
    told = simulation.believed_map("rover/0")
    assert told is not None
    assert told["occupancy"].shape == told["unseen"].shape
    assert told["occupancy"].min() == -1
    assert 0 <= told["unseen"].min() < told["unseen"].max() == 100
    x, y, _ = simulation.poses[0]
    (left, low), cell_m = told["corner"], told["cell_m"]
    here = told["occupancy"][int((y - low) / cell_m), int((x - left) / cell_m)]
    assert 0 <= here < 50


def test_who_has_no_mind_or_one_in_python_has_no_thoughts() -> None:
    assert Simulation("search").believed_map("rover/0") is None
    assert seeking(brains={"rover": Bumper}).believed_map("rover/0") is None
    bumpers = seeking(brains={"rover": Bumper})
    bumpers.inspect("rover/0")
    assert bumpers.inspection() is None
    assert Simulation("search").belief_state("rover/0") is None
    assert seeking(brains={"rover": Bumper}).belief_state("rover/0") is None


@pytest.mark.parametrize("robot", ["rover/7", "rovre/0", 3, None])
def test_a_robot_that_is_not_there_thinks_nothing(robot: Any) -> None:
    with pytest.raises(InputError, match="robot = .*must be one of the run's robots"):
        Simulation("search").belief_state(robot)
    with pytest.raises(InputError, match="robot = .*must be one of the run's robots"):
        Simulation("search").believed_map(robot)

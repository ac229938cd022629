"""Belief states, and the inspection of robots while they run."""

import math
from typing import Any

import pytest
from example_brains import Bumper
from metric import search

from agent_economy import InputError, Simulation
from agent_economy.recording.metric_writer import moment_of

SEEK = {"robots.rover.brain.behaviours": [{"kind": "bayesian_search"}, {"kind": "avoid"}]}


def seeking(**arguments: Any) -> Simulation:
    """Return a search with belief-based brains, after ten seconds."""
    simulation = Simulation(search(SEEK), seed=7, **arguments)
    simulation.step(100)
    return simulation


def test_a_belief_state_has_the_pose_and_the_goals() -> None:
    simulation = seeking()
    # Brains run in every second step, with the pose before the motion.
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


def test_all_robots_believe_in_items_that_one_reports() -> None:
    simulation = seeking()
    simulation.finish()
    for robot in simulation.robots:
        belief_state = simulation.belief_state(robot)
        assert belief_state is not None
        items = belief_state["items"]
        assert len(items) >= 2
        assert all(item["kind"] == 0 and 0 <= item["confidence"] <= 1 for item in items)


def test_reading_belief_states_changes_nothing() -> None:
    read, plain = seeking(), seeking()
    for robot in read.robots:
        assert read.belief_state(robot) == plain.belief_state(robot)
    read.step(50)
    plain.step(50)
    assert read.hash == plain.hash


def test_an_inspection_has_the_percept_and_the_command_of_the_step() -> None:
    simulation = seeking()
    simulation.inspect("rover/1")
    for _ in range(20):
        percept = simulation.percept("rover/1")
        inspection = simulation.inspection()
        assert inspection is not None
        inspected = (inspection["percept"], inspection["tick"])
        assert percept is None or (percept, simulation.tick) == inspected
        simulation.step()
        motion = moment_of(simulation)["commanded"][1]
        assert tuple(motion) == tuple(inspection["command"]["motion"].values())
        belief_state = simulation.belief_state("rover/1")
        assert belief_state == inspection["belief_state"]


def test_inspecting_changes_nothing_and_survives_a_restored_snapshot() -> None:
    inspected, plain = seeking(), seeking()
    inspected.inspect("rover/0")
    before = inspected.snapshot()
    for simulation in (inspected, plain):
        simulation.step(51)
    inspection = inspected.inspection()
    assert inspected.hash == plain.hash
    inspected.restore(before)
    inspected.step(51)
    assert inspected.inspection() == inspection
    inspected.change("robots.rover.count", 6)
    assert inspected.inspection() is None
    inspected.step(2)
    assert inspected.inspection() is not None
    inspected.change("robots.rover.count", 0)
    assert inspected.inspection() is None
    inspected.inspect(None)
    assert inspected.inspection() is None


def test_a_robot_takes_the_heading_of_the_highest_utility() -> None:
    simulation = seeking()
    simulation.inspect("rover/0")
    choices = 0
    for _ in range(100):
        simulation.step()
        inspection = simulation.inspection()
        assert inspection is not None
        assert inspection["belief_state"] is not None
        options = inspection["belief_state"]["heading_options"]
        if options is not None:
            choices += 1
            highest = max(heading["utility"] for heading in options["headings"])
            assert options["headings"][options["chosen"]]["utility"] == pytest.approx(highest)
    assert choices > 50


def test_a_map_has_free_and_unobserved_cells() -> None:
    simulation = seeking()
    believed = simulation.believed_map("rover/0")
    assert believed is not None
    assert believed["occupancy"].shape == believed["unseen"].shape
    assert believed["occupancy"].min() == -1
    assert 0 <= believed["unseen"].min() < believed["unseen"].max() == 100
    x, y, _ = simulation.poses[0]
    (left, low), cell_m = believed["corner"], believed["cell_m"]
    here = believed["occupancy"][int((y - low) / cell_m), int((x - left) / cell_m)]
    assert 0 <= here < 50


def test_robots_without_beliefs_or_with_python_brains_have_no_belief_state() -> None:
    assert Simulation("search").believed_map("rover/0") is None
    assert seeking(brains={"rover": Bumper}).believed_map("rover/0") is None
    bumpers = seeking(brains={"rover": Bumper})
    bumpers.inspect("rover/0")
    assert bumpers.inspection() is None
    assert Simulation("search").belief_state("rover/0") is None
    assert seeking(brains={"rover": Bumper}).belief_state("rover/0") is None


@pytest.mark.parametrize("robot", ["rover/7", "rovre/0", 3, None])
def test_an_unknown_robot_has_no_belief_state(robot: Any) -> None:
    with pytest.raises(InputError, match="robot = .*must be one of the run's robots"):
        Simulation("search").belief_state(robot)
    with pytest.raises(InputError, match="robot = .*must be one of the run's robots"):
        Simulation("search").believed_map(robot)

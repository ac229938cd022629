"""What robots with minds think, told while they run."""

import math
from typing import Any

import pytest
from bumpers import Bumper
from metric import search

from agent_economy import InputError, Simulation

SEEK = {"robots.rover.brain.behaviours": [{"kind": "seek"}, {"kind": "avoid"}]}


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
        thoughts = simulation.thoughts(robot)
        assert thoughts is not None
        pose = thoughts["pose"]
        assert pose is not None
        assert pose["at"] == pytest.approx(true[:2], abs=2.0)
        assert math.remainder(pose["heading_rad"] - true[2], math.tau) == pytest.approx(0, abs=0.1)
        assert len(thoughts["goals"]) <= 1
        for goal in thoughts["goals"]:
            assert goal["behaviour"] == 0
            assert goal["verdict"] in {"complete", "impossible", "approaching", "receding"}
    assert any(simulation.thoughts(robot)["goals"] for robot in simulation.robots)  # type: ignore[index]


def test_in_what_one_robot_found_and_told_all_believe() -> None:
    simulation = seeking()
    simulation.finish()
    for robot in simulation.robots:
        thoughts = simulation.thoughts(robot)
        assert thoughts is not None
        items = thoughts["items"]
        assert len(items) >= 2
        assert all(item["kind"] == 0 and 0 <= item["confidence"] <= 1 for item in items)


def test_to_look_at_thoughts_changes_nothing() -> None:
    looked, not_looked = seeking(), seeking()
    for robot in looked.robots:
        assert looked.thoughts(robot) == not_looked.thoughts(robot)
    looked.step(50)
    not_looked.step(50)
    assert looked.hash == not_looked.hash


def test_who_has_no_mind_or_one_in_python_has_no_thoughts() -> None:
    assert Simulation("search").thoughts("rover/0") is None
    assert seeking(brains={"rover": Bumper}).thoughts("rover/0") is None


@pytest.mark.parametrize("robot", ["rover/7", "rovre/0", 3, None])
def test_a_robot_that_is_not_there_thinks_nothing(robot: Any) -> None:
    with pytest.raises(InputError, match="robot = .*must be one of the run's robots"):
        Simulation("search").thoughts(robot)

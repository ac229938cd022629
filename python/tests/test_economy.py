"""Goals and controllers of runs in Python."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import agent_economy as ae


@pytest.fixture(scope="module")
def scenario() -> ae.Scenario:
    """Return the waypoints with fewer robots."""
    scenario = ae.Scenario.load("waypoints")
    return scenario.replace("robots.rover.count", 4).replace("goals.spot.count", 12)


def test_goals_are_served_and_their_times_are_in_order(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    while not simulation.is_over:
        simulation.step()
    goals = simulation.goals.to_pylist()
    assert [goal["name"] for goal in goals] == [f"spot/{index}" for index in range(12)]
    for goal in goals:
        times = [goal[key] for key in ("issued_s", "began_s", "arrived_s", "served_s")]
        assert times == sorted(times)
        assert goal["served_by"] in simulation.robots
        assert not goal["expired"]
    row = simulation.outcome().row
    assert (row["goals"], row["served"]) == (12, 12)


def test_the_columns_of_goals_are_the_means_over_the_goals(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    while not simulation.is_over:
        simulation.step()
    goals = simulation.goals.to_pylist()
    row = simulation.outcome().row
    parts = sum(row[key] for key in ("waiting_s", "travel_s", "blocked_s", "service_s"))
    totals = [goal["served_s"] - goal["issued_s"] for goal in goals]
    assert parts == pytest.approx(sum(totals) / len(totals))


def test_controllers_own_the_goals_that_are_not_served(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    for _ in range(100):
        simulation.step()
    (controller,) = simulation.controllers
    assert (controller["name"], controller["working"]) == ("base/0", True)
    assert any(goal["assignee"] in simulation.robots for goal in controller["goals"])
    assert {goal["goal"] for goal in controller["goals"]} <= set(
        simulation.goals["name"].to_pylist()
    )


def test_a_robot_that_has_failed_serves_no_goals(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    for _ in range(100):
        simulation.step()
    robot = next(each for each in simulation.robots if simulation.served_goals(each))
    simulation.fail(robot)
    assert simulation.served_goals(robot) == []


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        ("goals.spot.value", 2, "goals.spot.value = 2: must be 1, as when the first of these"),
        ("goals.spot.arrive_s", 9, "goals.spot.arrive_s = 9: must be 0: all of these goals have"),
        ("controllers.base.start", {"kind": "uniform"}, "controllers.base.start = .*: must be as"),
        ("goals.spot.placement", {"kind": "uniform"}, "goals.spot.placement = .*: they do not"),
    ],
)
def test_changes_that_no_agent_would_notice_are_rejected(
    scenario: ae.Scenario, path: str, value: Any, expected: str
) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step()
    with pytest.raises(ae.InputError, match=expected):
        simulation.change(path, value)
    assert not simulation.changes


def test_allocation_and_number_of_controllers_change_in_mid_run(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step()
    simulation.change("controllers.base.allocation", "nearest")
    simulation.step()
    simulation.change("controllers.base.count", 2)
    assert len(simulation.controllers) == 2
    simulation.change("controllers.base.count", 0)
    assert simulation.controllers == []


def test_the_clocks_of_a_run_do_not_change(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    with pytest.raises(ae.InputError, match="clock.max_drift"):
        simulation.change("clock.max_drift", 0.01)


def test_a_controller_stepped_outside_the_run_gives_the_same_run(scenario: ae.Scenario) -> None:
    inside, outside = (ae.Simulation(scenario, seed=1) for _ in range(2))
    controller = ae.Controller.of(scenario, "base")
    for _ in range(200):
        inside.step()
        percept = outside.percept("base/0")
        assert percept is not None
        outside.step(commands={"base/0": controller.step(percept)})
    assert np.array_equal(inside.poses, outside.poses)
    assert inside.goals == outside.goals
    assert len(controller.goals) == len(inside.controllers[0]["goals"])


def test_the_percept_of_a_controller_does_not_change_the_run(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    before = simulation.hash
    percept = simulation.percept("base/0")
    assert percept is not None
    assert len(percept["inbox"]) == 12
    assert (simulation.percept("base/0"), simulation.hash) == (percept, before)


def test_a_recording_repeats_the_commands_of_a_controller(
    scenario: ae.Scenario, mcap: Path
) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    controller = ae.Controller({"allocation": "nearest"})
    with ae.Recording(simulation, mcap) as recording:
        for _ in range(100):
            percept = simulation.percept("base/0")
            assert percept is not None
            recording.step(commands={"base/0": controller.step(percept)})
    assert any(goal["assignee"] for goal in controller.goals)
    assert ae.replay(mcap).agrees


def test_an_unknown_controller_is_named_with_the_known_ones(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    for call in (simulation.percept, simulation.fail):
        with pytest.raises(ae.InputError, match=r"robots and controllers: rover/0.*base/0"):
            call("base/1")
    command = ae.Controller().step(percept_of_a_controller())
    with pytest.raises(ae.InputError, match=r'commands = "bse/0".*did you mean base/0'):
        simulation.step(commands={"bse/0": command})


def percept_of_a_controller() -> Any:
    """Return a percept without messages."""
    return {"time_s": 0.0, "id": {"role": "controller", "kind": 1, "index": 0}}


def test_a_robot_that_fails_on_command_is_broken_and_others_serve_its_goals(
    scenario: ae.Scenario,
) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step(100)
    simulation.fail("rover/2")
    assert simulation.status.tolist() == ["active", "active", "broken", "active"]
    at = simulation.poses[2]
    simulation.finish()
    assert np.array_equal(simulation.poses[2], at)
    assert simulation.outcome().row["served"] == 12


def test_a_failure_on_command_equals_one_at_random(scenario: ae.Scenario) -> None:
    random = scenario.replace("robots.rover.mean_time_between_failures_s", 100)
    simulation = ae.Simulation(random, seed=1)
    while (simulation.status == "active").all():
        before = simulation.snapshot()
        simulation.step()
    (failed,) = np.flatnonzero(simulation.status == "broken").tolist()
    # From here on, no other robot fails.
    simulation.change("robots.rover.mean_time_between_failures_s", 1e12)
    simulation.step(200)
    at_random = simulation.poses, simulation.goals
    simulation.restore(before)
    simulation.change("robots.rover.mean_time_between_failures_s", 1e12)
    simulation.step()
    simulation.fail(f"rover/{failed}")
    simulation.step(200)
    assert np.array_equal(simulation.poses, at_random[0])
    assert simulation.goals == at_random[1]


def test_a_controller_that_fails_on_command_is_silent(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step(10)
    simulation.fail("base/0")
    assert not simulation.controllers[0]["working"]
    assert simulation.percept("base/0") is None
    assert simulation.changes[-1].path == "controllers.base.failed"


def test_a_replay_repeats_failures_on_command(scenario: ae.Scenario, mcap: Path) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(50)
        simulation.fail("rover/1")
        simulation.fail("base/0")
        recording.step(50)
    replayed = ae.replay(mcap)
    assert replayed.agrees
    assert replayed.hash == f"{simulation.hash:016x}"


def test_a_robot_out_of_service_returns_its_goals_and_serves_again_when_it_is_back(
    scenario: ae.Scenario,
) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step(100)

    def assigned() -> int:
        goals = simulation.controllers[0]["goals"]
        return sum(goal["assignee"] == "rover/2" for goal in goals)

    assert assigned() > 0
    simulation.set_service("rover/2", in_service=False)
    simulation.step(50)
    assert assigned() == 0
    assert simulation.changes[-1].path == "robots.rover.out_of_service"
    before = simulation.snapshot()
    simulation.finish()
    assert simulation.outcome().row["served"] == 12
    simulation.restore(before)
    for index in (0, 1, 3):
        simulation.set_service(f"rover/{index}", in_service=False)
    simulation.set_service("rover/2", in_service=True)
    simulation.step(100)
    assert assigned() > 0


def test_a_replay_repeats_orders_out_of_service(scenario: ae.Scenario, mcap: Path) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(50)
        simulation.set_service("rover/1", in_service=False)
        recording.step(50)
        simulation.set_service("rover/1", in_service=True)
        recording.step(50)
    replayed = ae.replay(mcap)
    assert replayed.agrees
    assert replayed.hash == f"{simulation.hash:016x}"


def test_only_robots_are_taken_out_of_service(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1)
    with pytest.raises(ae.InputError, match=r'name = "base/0": must be a robot'):
        simulation.set_service("base/0", in_service=False)


def test_an_external_body_does_not_fail_on_command(scenario: ae.Scenario) -> None:
    simulation = ae.Simulation(scenario, seed=1, external=["rover/0"])
    with pytest.raises(ae.InputError, match='name = "rover/0": must be a robot whose body'):
        simulation.fail("rover/0")


def test_a_longer_owner_lease_makes_recovery_slower() -> None:
    derived = dict(ae.Scenario.load("waypoints").derived)
    assert "within 67.6 s" in derived["controllers.base"]
    longer = ae.Scenario.load("waypoints").replace("controllers.base.owner_lease_s", 100)
    assert "within 137.6 s" in dict(longer.derived)["controllers.base"]
    none = ae.Scenario.load("waypoints").replace("controllers.base.count", 0)
    assert "controllers.base" not in dict(none.derived)


def test_a_brain_stepped_by_hand_shows_the_leases_that_it_holds() -> None:
    brain = ae.Brain.of("waypoints", "rover")
    assert brain.served_goals() == []
    position = {"value": [0.0, 0.0], "age_s": 0.0}
    heading = {"value": 0.0, "age_s": 0.0}
    goal = {"issuer": {"role": "person", "kind": 0, "index": 0}, "number": 3}
    task = {
        "id": goal,
        "at_m": [10.0, 0.0],
        "radius_m": 1.0,
        "value": 1.0,
        "service_s": 0.0,
        "due_s": 1e6,
        "work": "visit",
        "capability": 0,
    }

    def step(time_s: float, contract: dict[str, Any]) -> list[Any]:
        message = {"about": {"contract": contract}, "confidence": 1.0}
        message["to"] = {"kind": 0, "index": 0}
        inbox = [
            {
                "from": {"role": "controller", "kind": 1, "index": 0},
                "age_s": 0.0,
                "message": message,
            }
        ]
        percept = {"time_s": time_s, "position": position, "heading_rad": heading, "inbox": inbox}
        outbox = brain.step(percept)["outbox"]  # type: ignore[arg-type]
        return [each["about"]["contract"] for each in outbox if "contract" in each["about"]]

    (bid,) = [
        each["bid"] for each in step(1.0, {"call": {"number": 0, "task": task}}) if "bid" in each
    ]
    step(2.0, {"award": {"goal": goal, "number": bid["number"], "lease_s": 20.0}})
    (served,) = brain.served_goals()
    assert served["task"]["id"] == goal
    assert served["owner"] == {"role": "controller", "kind": 1, "index": 0}
    assert served["lease_s"] == pytest.approx(19.0)

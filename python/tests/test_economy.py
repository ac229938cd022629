"""Goals and controllers of runs in Python."""

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

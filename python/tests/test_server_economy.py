"""Goals and controllers, as a page receives them."""

from typing import Any

from page_client import Page

import agent_economy as ae
from agent_economy.server.runs.economy_view import economy

REQUEST = {"links": False, "footprints": False, "economy": True}


def received(page: Page) -> list[dict[str, Any]]:
    """Return the goals and controllers that the page has received."""
    return [message for message in page.received if message["type"] == "economy"]


def test_goals_are_sent_only_while_they_are_requested(page: Page) -> None:
    page.open(scenario="waypoints")
    page.step(5, to=5)
    assert not received(page)
    page.send("layers", **REQUEST)
    assert page.wait_for("economy", tick=5)
    page.send("layers", links=False, footprints=False)
    page.step(5, to=10)
    page.step(5, to=15)
    assert {message["tick"] for message in received(page)} == {5}


def test_runs_without_goals_and_controllers_have_no_such_message(page: Page) -> None:
    page.send("layers", **REQUEST)
    for scenario in ("open-field", "classic"):
        page.open(scenario=scenario)
        page.step(5, to=5)
        page.step(5, to=10)
    assert not received(page)


def test_an_awarded_goal_has_the_owner_and_the_robot_that_serves_it(page: Page) -> None:
    page.send("layers", **REQUEST)
    page.open(scenario="waypoints", tick=200)
    page.send("select", robot="rover/0")
    message = page.wait_for("economy", tick=200)
    while message["service"] is None:
        message = page.wait_for("economy", tick=200)
    goals = {goal["name"]: goal for goal in message["goals"]}
    assert message["service"]["robot"] == "rover/0"
    assert message["service"]["goals"]
    for served in message["service"]["goals"]:
        goal = goals[served["goal"]]
        assert (goal["status"], goal["robot"]) == ("awarded", "rover/0")
        assert goal["owner"] == served["owner"] == "base/0"
        # The grantor waits at least as long as the holder holds.
        assert 0 < served["lease_s"] <= goal["lease_s"]
    assert {goal["status"] for goal in goals.values()} == {"open", "awarded", "served"}


def test_controllers_that_are_added_during_a_run_are_sent(page: Page) -> None:
    page.send("layers", **REQUEST)
    page.open(scenario="waypoints", tick=100)
    page.change("controllers.base.count", 3)
    message = page.wait_for("economy", tick=100)
    assert [each["name"] for each in message["controllers"]] == ["base/0", "base/1", "base/2"]
    page.change("controllers.base.allocation", "nearest")
    page.step(1, to=101)


def test_a_goal_without_an_owner_has_the_reason() -> None:
    scenario = ae.Scenario.load("waypoints").replace("controllers.base.failed", [0])
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step()
    view = economy(simulation, None)
    assert view is not None
    assert {goal["unserved"] for goal in view["goals"]} == {"no_controller"}

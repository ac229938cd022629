"""Goals and controllers, as a page receives them."""

import json
from typing import Any

from page_client import Page

import agent_economy as ae
from agent_economy.server.runs.shown import subjects
from agent_economy.server.runs.shown.subject import Request

LAYER, GOALS, SERVICE = "economy", "goals", "service"
ALL = Request(layers=frozenset({LAYER}), panels=frozenset({GOALS}))


def received(page: Page) -> list[dict[str, Any]]:
    """Return the layers and panels that the page has received."""
    return [message for message in page.received if message["type"] == "shown"]


def rows(panel: Any, section: int) -> list[list[str]]:
    """Return the cells of the table of a section, with their notes."""
    return [
        [f"{cell['text']} {cell['note']}".strip() for cell in row["cells"]]
        for row in panel["sections"][section]["table"]["rows"]
    ]


def test_goals_are_sent_only_while_they_are_requested(page: Page) -> None:
    page.open(scenario="waypoints")
    page.step(5, to=5)
    assert not received(page)
    page.send("show", layers=[LAYER])
    message = page.wait_for("shown", tick=5)
    assert (list(message["layers"]), message["panels"]) == ([LAYER], {})
    page.send("show", layers=["links"])
    page.step(5, to=10)
    page.step(5, to=15)
    assert {message["tick"] for message in received(page)} == {5}


def test_runs_without_goals_and_controllers_neither_offer_nor_send_them(page: Page) -> None:
    page.send("show", layers=[LAYER], panels=[GOALS, SERVICE])
    for scenario in ("open-field", "classic"):
        page.open(scenario=scenario)
        page.step(5, to=5)
        page.step(5, to=10)
    assert not received(page)


def test_an_awarded_goal_has_the_owner_and_the_robot_that_serves_it(page: Page) -> None:
    page.send("show", layers=[LAYER], panels=[GOALS, SERVICE])
    page.open(scenario="waypoints", tick=200)
    page.send("select", robot="rover/0")
    message = page.wait_for("shown", tick=200)
    while SERVICE not in message["panels"]:
        message = page.wait_for("shown", tick=200)
    goals = {name: (owner, status) for name, owner, status in rows(message["panels"][GOALS], 1)}
    served = rows(message["panels"][SERVICE], 0)
    assert message["panels"][SERVICE]["note"] == str(len(served))
    assert served
    for name, owner, _, _ in served:
        assert goals[name][0] == owner == "base/0"
        assert goals[name][1].startswith("awarded to rover/0, lease")
    own = [line for line in message["layers"][LAYER]["lines"] if line["robot"] == "rover/0"]
    assert len(own) == len(served)
    assert {status.split()[0] for _, status in goals.values()} == {"open", "awarded", "served"}


def test_controllers_that_are_added_during_a_run_are_sent(page: Page) -> None:
    page.send("show", layers=[], panels=[GOALS])
    page.open(scenario="waypoints", tick=100)
    page.change("controllers.base.count", 3)
    message = page.wait_for("shown", tick=100)
    names = [cells[0] for cells in rows(message["panels"][GOALS], 0)]
    assert names == ["base/0", "base/1", "base/2"]
    page.change("controllers.base.allocation", "nearest")
    page.step(1, to=101)


def test_a_goal_without_an_owner_has_the_reason() -> None:
    scenario = ae.Scenario.load("waypoints").replace("controllers.base.failed", [0])
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step()
    found = subjects.shown(simulation, ALL)
    assert found is not None
    statuses = {status for _, _, status in rows(found["panels"][GOALS], 1)}
    # Robots are on their way to some of them by themselves.
    assert statuses == {"awarded", "reported no controller works that could own it"}
    crossed = {
        tuple(glyph["shape"] for glyph in symbol) for symbol in found["layers"][LAYER]["symbols"]
    }
    assert ("square", "cross") in crossed


def test_with_a_controller_chosen_only_its_goals_stand_out_and_are_listed() -> None:
    scenario = ae.Scenario.load("waypoints").replace("controllers.base.count", 2)
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step(300)
    everything = subjects.shown(simulation, ALL)
    chosen = subjects.shown(simulation, ALL._replace(choices={"controller": "base/1"}))
    assert everything is not None
    assert chosen is not None
    owners = {owner for _, owner, _ in rows(everything["panels"][GOALS], 1)}
    assert {"base/0", "base/1"} <= owners
    assert {owner for _, owner, _ in rows(chosen["panels"][GOALS], 1)} == {"base/1"}
    assert chosen["panels"][GOALS]["sections"][1]["heading"] == "Goals of base/1"
    opacities = {marker["opacity"] for marker in chosen["layers"][LAYER]["markers"]}
    assert opacities == {0.25, 1.0}
    assert {marker["opacity"] for marker in everything["layers"][LAYER]["markers"]} == {1.0}


def goals_section(simulation: ae.Simulation, **choices: str) -> Any:
    """Return the section of the goals, with these choices of the filter."""
    chosen = {f"goals-{key}": value for key, value in choices.items()}
    found = subjects.shown(simulation, ALL._replace(choices=chosen))
    assert found is not None
    return found["panels"][GOALS]["sections"][1]


def names(section: Any) -> list[str]:
    """Return the names of the goals that are listed."""
    return [row["cells"][0]["text"] for row in section["table"]["rows"]]


def test_goals_are_filtered_by_status_and_by_words() -> None:
    simulation = ae.Simulation(ae.Scenario.load("waypoints"), seed=7)
    simulation.step(200)
    everything = goals_section(simulation)
    counts = {kind["id"]: kind["count"] for kind in everything["filter"]["kinds"]}
    assert counts.keys() == {"open", "awarded", "served"}
    assert everything["filter"]["passed"] == (60, 60)
    served = goals_section(simulation, hidden="open,awarded")
    assert served["filter"]["passed"] == (counts["served"], 60)
    assert len(names(served)) == counts["served"]
    assert [kind["is_on"] for kind in served["filter"]["kinds"]] == [False, False, True]
    # Of the hidden kinds, too, the number is sent.
    assert {kind["id"]: kind["count"] for kind in served["filter"]["kinds"]} == counts
    assert names(goals_section(simulation, words="spot/59")) == ["spot/59"]
    found = goals_section(simulation, words="AWARDED rover/0")
    assert {row["cells"][2]["note"].split(",")[0] for row in found["table"]["rows"]} == {
        "to rover/0"
    }


def test_a_filter_that_no_goal_passes_leaves_the_filter_and_no_table() -> None:
    simulation = ae.Simulation(ae.Scenario.load("waypoints"), seed=7)
    section = goals_section(simulation, words="no such goal", hidden="unknown,")
    assert section["table"] is None
    assert section["filter"]["passed"] == (0, 60)


def test_each_goal_has_its_place() -> None:
    simulation = ae.Simulation(ae.Scenario.load("waypoints"), seed=7)
    simulation.step(200)
    goals = {goal["name"]: (goal["x_m"], goal["y_m"]) for goal in simulation.goals.to_pylist()}
    rows = goals_section(simulation)["table"]["rows"]
    assert {row["cells"][0]["text"]: row["at"] for row in rows} == goals


def test_every_goal_of_thousands_can_be_reached_in_a_small_message() -> None:
    anywhere = ae.Scenario.load("waypoints").replace("goals.spot.placement", {"kind": "uniform"})
    scenario = anywhere.replace("goals.spot.count", 3000)
    simulation = ae.Simulation(scenario, seed=7)
    simulation.step()
    section = goals_section(simulation)
    assert (len(names(section)), section["table"]["total"]) == (200, 3000)
    assert len(json.dumps(section)) < 100_000
    assert names(goals_section(simulation, words="spot/2999")) == ["spot/2999"]

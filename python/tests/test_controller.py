"""Single controllers: they own the goals that they receive, and award them by messages only."""

from typing import Any

import pytest

import agent_economy as ae

OPERATOR: dict[str, Any] = {"role": "person", "kind": 0, "index": 0}
BASE: dict[str, Any] = {"role": "controller", "kind": 1, "index": 0}
ROVER: dict[str, Any] = {"kind": 0, "index": 0}


def task(number: int) -> dict[str, Any]:
    """Return a goal."""
    return {
        "id": {"issuer": OPERATOR, "number": number},
        "at_m": [3, 4],
        "radius_m": 0.5,
        "value": 1,
        "service_s": 0,
        "due_s": 3600,
        "work": "visit",
        "capability": 0,
    }


def received(sender: dict[str, Any], **contract: Any) -> dict[str, Any]:
    """Return a received message."""
    message = {"to": BASE, "about": {"contract": contract}, "confidence": 1}
    return {"from": sender, "age_s": 0.1, "message": message}


def percept(time_s: float, *inbox: dict[str, Any]) -> Any:
    """Return a percept of the controller."""
    return {"time_s": time_s, "id": BASE, "inbox": list(inbox)}


def sent(command: Any, kind: str) -> list[Any]:
    """Return the messages about contracts of a kind in a command."""
    contracts = [message["about"].get("contract", {}) for message in command["outbox"]]
    return [contract[kind] for contract in contracts if kind in contract]


def awarded(controller: ae.Controller, bids: int = 1) -> list[Any]:
    """Issue goals, bid for each, and return the awards in the next 10 s."""
    issue = [received(OPERATOR, issue=task(number)) for number in range(bids)]
    calls = sent(controller.step(percept(0.0, *issue)), "call")
    awards = []
    for step in range(1, 50):
        answers = [
            received(
                ROVER,
                bid={
                    "goal": call["task"]["id"],
                    "number": 100 * step + place,
                    "time_s": 5,
                    "total_s": 5,
                    "energy": 0,
                    "call": call["number"],
                },
            )
            for place, call in enumerate(calls)
        ]
        command = controller.step(percept(0.2 * step, *answers))
        awards += sent(command, "award")
        calls = sent(command, "call")
    return awards


def test_a_goal_is_awarded_to_the_robot_that_bids() -> None:
    controller = ae.Controller()
    assert awarded(controller)
    (goal,) = controller.goals
    assert goal["assignee"] == ROVER
    assert goal["lease_s"] is not None
    assert goal["lease_s"] > 0
    assert (goal["votes"], goal["owner_lease_s"], goal["unserved"]) == ([], None, None)
    assert (controller.lost, controller.refused) == ([], 0)


def test_the_rule_none_awards_nothing() -> None:
    controller = ae.Controller({"allocation": "none"})
    assert awarded(controller) == []
    assert [goal["assignee"] for goal in controller.goals] == [None]


def test_goals_beyond_the_maximum_are_refused() -> None:
    controller = ae.Controller({"max_goals": 2})
    awarded(controller, 3)
    assert (len(controller.goals), controller.refused) == (2, 1)


def test_a_controller_of_a_scenario_has_its_settings() -> None:
    scenario = ae.Scenario.load("waypoints").replace("controllers.base.max_goals", 1)
    controller = ae.Controller.of(scenario, "base")
    controller.step(percept(0.0, *(received(OPERATOR, issue=task(n)) for n in range(2))))
    assert controller.refused == 1


def test_a_restarted_controller_remembers_nothing_and_awards_nothing_at_first() -> None:
    controller = ae.Controller()
    awarded(controller)
    again = controller.restarted()
    assert again.goals == []
    assert awarded(again) == []
    assert [goal["assignee"] for goal in again.goals] == [None]


def test_a_copy_is_equal_and_independent() -> None:
    controller = ae.Controller()
    controller.step(percept(0.0, received(OPERATOR, issue=task(0))))
    copy = controller.copy()
    later = percept(5.0, received(OPERATOR, issue=task(1)))
    assert copy.step(later) == controller.copy().step(later)
    assert (len(copy.goals), len(controller.goals)) == (2, 1)


def ownership(command: Any, kind: str) -> list[Any]:
    """Return the messages about ownership of a kind in a command."""
    messages = [message["about"].get("ownership", {}) for message in command["outbox"]]
    return [message[kind] for message in messages if kind in message]


def from_peer(**ownership: Any) -> dict[str, Any]:
    """Return a message about ownership of another controller of the kind."""
    message = {"to": BASE, "about": {"ownership": ownership}, "confidence": 1}
    return {"from": {**BASE, "index": 1}, "age_s": 0.1, "message": message}


def test_one_of_three_controllers_owns_a_goal_when_another_votes_for_it() -> None:
    controller = ae.Controller({"count": 3, "trade": {"gain": 0.5}})
    issue = received(OPERATOR, issue=task(0))
    command = controller.step(percept(0.0, issue, from_peer(present={})))
    (request,) = ownership(command, "entrust")
    assert controller.goals == []
    vote = {"goal": request["task"]["id"], "number": request["number"], "lease_s": 30}
    controller.step(percept(0.2, from_peer(entrusted=vote)))
    (goal,) = controller.goals
    assert goal["votes"] == [{"role": "controller", "kind": 1, "index": 1}]
    assert goal["owner_lease_s"] == pytest.approx(29.8)


def test_all_errors_of_settings_are_reported_with_what_is_allowed() -> None:
    wrong: Any = {"alocation": "auction", "service_lease_s": -1, "max_goals": 1.5}
    wrong |= {"count": 0, "trade": {"gain": 1}}
    with pytest.raises(ae.InputError) as error:
        ae.Controller(wrong)
    words = str(error.value)
    assert "settings.alocation is not a known key" in words
    assert "did you mean allocation?" in words
    assert "settings.service_lease_s = -1: must be a number from 0.1 to 3600" in words
    assert "settings.max_goals = 1.5: must be" in words
    assert "settings.count = 0: must be" in words
    assert "settings.trade.gain = 1: must be a number from 0.01 to 0.99" in words


def test_a_lease_shorter_than_the_auction_is_an_error_also_if_it_is_the_default() -> None:
    for settings, lease in (
        ({"auction_s": 30.0}, r"20 \(default\)"),
        ({"auction_s": 5.0, "service_lease_s": 4.0}, "4"),
    ):
        expected = f"service_lease_s = {lease}: must be at least .* must outlast an auction of"
        with pytest.raises(ae.InputError, match=expected):
            ae.Controller(settings)  # type: ignore[arg-type]
    assert ae.Controller({"auction_s": 5.0, "service_lease_s": 6.0}).goals == []


def test_an_unknown_kind_of_controllers_is_an_error() -> None:
    with pytest.raises(ae.InputError, match='kind = "bas".*did you mean "base"'):
        ae.Controller.of("waypoints", "bas")


def test_percepts_that_no_controller_can_have_are_errors() -> None:
    controller = ae.Controller()
    wrong: Any = {"id": ROVER}
    with pytest.raises(ae.InputError, match=r'percept\.id\.role = "robot": must be "controller"'):
        controller.step(wrong)
    lie = received(ROVER, query={})
    lie["message"]["confidence"] = 2
    with pytest.raises(ae.InputError, match=r"inbox\[0\]\.message\.confidence = 2"):
        controller.step(percept(0.0, lie))

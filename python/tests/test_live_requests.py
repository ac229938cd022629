"""Requests that change nothing are refused with the reason; those that wait state for what."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from test_live_endpoint import PLAN, Served, serving

from agent_economy.live.clock import now_s
from agent_economy.live.plan import Wall
from agent_economy.live.readings import Quantity, Reading
from agent_economy.live.warden import waypoint_request
from agent_economy.live.warden.endings import End

ROBOT = "bender/0"
NOTCHED = ((1, 1), (39, 1), (39, 29), (22, 29), (22, 10), (18, 10), (18, 29), (1, 29))
"""A fence with a notch from above between x = 18 and 22."""


@pytest.fixture
def served() -> Iterator[Served]:
    with serving() as each:
        yield each


def refused(served: Served, path: str, **body: Any) -> str:
    """Send a request that has to be refused; return the reason."""
    before = list(served.events.since(0))
    status, answer = served.ask(path, **body)
    assert status == 409, answer
    assert list(served.events.since(0)) == before
    return str(answer["message"])


def accepted(served: Served, path: str, **body: Any) -> str:
    """Send a request that has to be accepted; return what it does."""
    status, answer = served.ask(path, **body)
    assert status == 200, answer
    return str(answer["message"])


def arm(served: Served) -> None:
    """Let the robot be armed and without faults, as after a turn of the rules."""
    decision = served.warden.outputs.robots[ROBOT]
    armed = replace(decision, is_armed=True, latched=(), faults=(), blockers=())
    served.warden.outputs = replace(served.warden.outputs, robots={ROBOT: armed})


# Stop and release, hold and resume


def test_a_release_without_an_emergency_stop_is_refused(served: Served) -> None:
    assert refused(served, "/release") == "no emergency stop is latched"
    assert not served.turn().release


def test_a_release_together_with_a_stop_is_refused_because_the_stop_wins(served: Served) -> None:
    accepted(served, "/stop")
    assert refused(served, "/release").startswith("an emergency stop has just been requested")
    served.turn()
    accepted(served, "/release")
    assert refused(served, "/release") == "the release has been requested already"
    served.turn()
    assert refused(served, "/release") == "no emergency stop is latched"


def test_a_stop_and_a_hold_state_if_they_are_active_already(served: Served) -> None:
    for path, latched in (
        ("/stop", "emergency stop: already latched"),
        ("/hold", "hold: already active"),
    ):
        assert accepted(served, path).endswith("of all robots")
        assert "already" in accepted(served, path)
        served.turn()
        assert accepted(served, path) == latched


def test_a_stop_after_a_release_is_a_new_one(served: Served) -> None:
    accepted(served, "/stop")
    served.turn()
    accepted(served, "/release")
    assert accepted(served, "/stop") == "emergency stop of all robots"
    served.turn()
    assert served.ask("/state")[1]["is_stopped"]


def test_a_resume_without_a_hold_or_together_with_one_is_refused(served: Served) -> None:
    assert refused(served, "/resume") == "the robots are not held"
    accepted(served, "/hold")
    assert refused(served, "/resume").startswith("a hold has just been requested")
    served.turn()
    accepted(served, "/resume")
    assert refused(served, "/resume") == "the resume has been requested already"
    served.turn()
    assert refused(served, "/resume") == "the robots are not held"


# Arming, modes, navigation


def test_arming_robots_that_are_armed_is_refused(served: Served) -> None:
    arm(served)
    assert refused(served, "/arm") == "armed already: bender/0"
    assert not served.turn().arm


def test_arming_is_refused_while_a_request_of_the_same_turn_prevents_it(served: Served) -> None:
    decision = served.warden.outputs.robots[ROBOT]
    ready = replace(decision, faults=(), blockers=())
    for path, body in (
        ("/hold", {}),
        ("/mode", {"robot": ROBOT, "mode": "manual"}),
        ("/navigate", {"robot": ROBOT, "is_on": False}),
    ):
        served.turn()
        served.warden.outputs = replace(served.warden.outputs, robots={ROBOT: ready})
        served.warden.operator.take()
        accepted(served, path, **body)
        assert "has just been requested" in refused(served, "/arm")
        served.warden.operator.take()
        accepted(served, "/arm")
        assert refused(served, "/arm") == "arming has been requested already"


def test_a_change_to_the_mode_or_navigation_that_a_robot_has_is_refused(served: Served) -> None:
    mode = {"robot": ROBOT, "mode": "manual"}
    assert refused(served, "/mode", **mode | {"mode": "auto"}) == "bender/0 is in auto mode already"
    accepted(served, "/mode", **mode)
    assert refused(served, "/mode", **mode) == "bender/0 is in manual mode already"
    served.turn()
    assert refused(served, "/mode", **mode) == "bender/0 is in manual mode already"
    on = {"robot": ROBOT, "is_on": True}
    assert refused(served, "/navigate", **on) == "the navigation of bender/0 is on already"
    text = accepted(served, "/navigate", **on | {"is_on": False})
    assert text.endswith("it takes effect in automatic mode")
    assert refused(served, "/navigate", **on | {"is_on": False}).endswith("is off already")


def ready(served: Served) -> None:
    """Let the robot be without faults, but not armed."""
    decision = replace(served.warden.outputs.robots[ROBOT], faults=(), blockers=())
    served.warden.outputs = replace(served.warden.outputs, robots={ROBOT: decision})


def test_a_waypoint_does_not_wait_for_an_arming_that_has_just_been_accepted(
    served: Served,
) -> None:
    ready(served)
    assert "bender/0 is not armed" in accepted(served, "/waypoint", **to(10, 10))
    accepted(served, "/arm")
    assert "queued" not in accepted(served, "/waypoint", **to(11, 10))


def test_a_hold_states_which_arming_of_the_same_turn_it_cancels(served: Served) -> None:
    ready(served)
    accepted(served, "/arm")
    text = accepted(served, "/hold")
    cancelled = "cancelled: the arming of bender/0 that has just been requested"
    assert text == f"hold of all robots; {cancelled}"
    assert "cancelled" not in accepted(served, "/hold")
    assert "bender/0 is not armed" in accepted(served, "/waypoint", **to(10, 10))
    assert not served.turn().arm


@pytest.mark.parametrize(("path", "value"), [("/mode", "manual"), ("/navigate", False)])
def test_a_request_that_would_undo_another_one_of_its_turn_is_refused(
    served: Served, path: str, value: Any
) -> None:
    key, back = ("mode", "auto") if path == "/mode" else ("is_on", True)
    ready(served)
    accepted(served, "/arm")
    reason = refused(served, path, robot=ROBOT, **{key: value})
    assert reason == "the arming of bender/0 has just been requested: repeat this afterwards"
    assert served.turn().arm == {ROBOT}
    accepted(served, path, robot=ROBOT, **{key: value})
    assert refused(served, path, robot=ROBOT, **{key: value}).endswith("already")
    assert refused(served, path, robot=ROBOT, **{key: back}).endswith("has just been requested")
    served.turn()
    accepted(served, path, robot=ROBOT, **{key: back})


def test_a_second_confirmation_in_one_turn_is_refused(served: Served) -> None:
    decision = replace(served.warden.outputs.robots[ROBOT], doubted=("compass",))
    served.warden.outputs = replace(served.warden.outputs, robots={ROBOT: decision})
    accepted(served, "/confirm", robot=ROBOT, port="compass")
    reason = refused(served, "/confirm", robot=ROBOT, port="compass")
    assert reason == "the confirmation of compass of bender/0 has been requested already"


# The operator


def test_taking_control_twice_and_giving_up_without_it_are_refused(served: Served) -> None:
    own = {"client": "a", "take": True}
    accepted(served, "/operator", **own)
    assert refused(served, "/operator", **own) == "this client is the operator already"
    for client in ("b", "c"):
        reason = refused(served, "/operator", client=client, take=False)
        assert reason == "this client is not the operator"
    accepted(served, "/operator", client="a", take=False)
    assert refused(served, "/operator", client="a", take=False).endswith("not the operator")


def test_motor_values_are_refused_from_the_request_of_automatic_mode_on(served: Served) -> None:
    values = {"client": "a", "robot": ROBOT, "left": 160, "right": 150}
    accepted(served, "/operator", client="a", take=True)
    accepted(served, "/mode", client="a", robot=ROBOT, mode="manual")
    served.turn()
    assert served.ask("/manual", number=1, **values)[0] == 200
    accepted(served, "/mode", client="a", robot=ROBOT, mode="auto")
    assert refused(served, "/manual", number=2, **values) == "bender/0 is not in manual mode"


# Requests as such


BODIES: dict[str, dict[str, Any]] = {
    "/release": {},
    "/arm": {},
    "/resume": {},
    "/operator": {"take": True},
    "/state": {},
    "/mode": {"robot": ROBOT, "mode": "manual"},
    "/manual": {"robot": ROBOT, "left": 150, "right": 150, "number": 1},
    "/waypoint": {"robot": ROBOT, "point_m": [10, 10]},
    "/navigate": {"robot": ROBOT, "is_on": False},
}


@pytest.mark.parametrize("path", BODIES)
def test_unknown_keys_and_clients_that_are_no_string_are_refused(served: Served, path: str) -> None:
    accepted(served, "/stop")
    accepted(served, "/hold")
    served.turn()
    unknown = refused(served, path, **BODIES[path], robott="bender/0")
    assert unknown.startswith("'robott' is not a known key: expected one of token, client")
    for client in (3, None, "", ["a"], "a" * 101):
        reason = refused(served, path, **BODIES[path], client=client)
        assert reason == "client must be a string of 1 to 100 characters"


@pytest.mark.parametrize("path", ["/stop", "/hold"])
def test_a_stop_and_a_hold_are_accepted_whatever_else_they_contain(
    served: Served, path: str
) -> None:
    accepted(served, path, client=3, robott="bender/0")


@pytest.mark.parametrize("path", [each for each in BODIES if each not in ("/state", "/operator")])
def test_while_the_drive_ends_requests_are_refused(served: Served, path: str) -> None:
    accepted(served, "/operator", client="a", take=True)
    accepted(served, "/stop")
    accepted(served, "/hold")
    served.turn()
    served.warden._end = End.INTERRUPTED
    reason = refused(served, path, client="a", **BODIES[path])
    assert reason == "the drive ends: all robots are being stopped"
    assert "the drive ends" in accepted(served, "/stop")
    assert "the drive ends" in accepted(served, "/hold")


# Waypoints: the way to them


def position(served: Served, x_m: float, y_m: float, age_s: float = 0.0) -> None:
    """Let the newest position of the robot be a place."""
    robot, at_s = served.warden.robots[ROBOT], now_s() - age_s
    robot.readings["gps"] = (Reading(Quantity.POSITION, (x_m, y_m)), at_s)


def goal(served: Served, number: int, at_m: list[float], verdict: str = "pending") -> None:
    """Let the loop report a goal."""
    goals = served.warden.goals.setdefault(ROBOT, {})
    goals[str(number)] = {"goal": str(number), "at_m": at_m, "verdict": verdict, "served_by": None}


def to(x_m: float, y_m: float) -> dict[str, Any]:
    return {"robot": ROBOT, "point_m": [x_m, y_m]}


@pytest.fixture
def notched() -> Iterator[Served]:
    """Serve a drive whose robot has a concave fence, and whose world has one wall."""
    robot = replace(PLAN.robots[0], fence_m=NOTCHED)
    wall = Wall("world.obstacles[0]", ((10, 2), (11, 2), (11, 8), (10, 8)))
    with serving(replace(PLAN, robots=(robot,), walls=(wall,))) as each:
        yield each


def test_a_leg_from_the_robot_that_leaves_its_fence_is_refused(notched: Served) -> None:
    position(notched, 5, 15)
    assert refused(notched, "/waypoint", **to(30, 15)) == (
        "the leg from [5.00, 15.00] to [30.00, 15.00] leaves the fence of bender/0 at "
        "[18.00, 15.00]"
    )
    assert not notched.orders
    accepted(notched, "/waypoint", **to(30, 3))


def test_a_leg_begins_at_the_last_waypoint_that_is_left(notched: Served) -> None:
    position(notched, 5, 15)
    goal(notched, 1, [25, 20])
    goal(notched, 2, [5, 20], "complete")
    accepted(notched, "/waypoint", **to(30, 15))
    # The loop has not reported it yet.
    assert "the leg from [30.00, 15.00]" in refused(notched, "/waypoint", **to(5, 15))
    goal(notched, 3, [30, 15], "impossible")
    goal(notched, 1, [25, 20], "complete")
    assert "the leg from [5.00, 15.00]" in refused(notched, "/waypoint", **to(25, 15))


@pytest.mark.parametrize("age_s", [None, 10.0])
def test_without_a_position_only_the_waypoint_is_checked(
    notched: Served, age_s: float | None
) -> None:
    if age_s is not None:
        position(notched, 5, 15, age_s)
    text = accepted(notched, "/waypoint", **to(30, 15))
    assert "only the waypoint was checked: the position of bender/0 is not known" in text


def test_the_way_of_a_robot_outside_its_fence_is_not_compared_with_it(notched: Served) -> None:
    position(notched, 20, 20)
    text = accepted(notched, "/waypoint", **to(30, 15))
    assert "its way was not compared with the fence: bender/0 is outside of it" in text


def test_a_waypoint_at_which_the_robot_touches_a_wall_is_refused(notched: Served) -> None:
    assert refused(notched, "/waypoint", **to(10.5, 5)) == (
        "the waypoint is inside the obstacle world.obstacles[0]: at least 0.4 m, the radius of "
        "bender/0, are needed"
    )
    assert "is 0.25 m from the obstacle" in refused(notched, "/waypoint", **to(11.25, 5))


def test_a_way_across_a_wall_is_accepted_with_a_warning(notched: Served) -> None:
    position(notched, 5, 5)
    assert (
        "the straight way crosses the obstacle world.obstacles[0]: the robot has to find a way "
        "around"
    ) in accepted(notched, "/waypoint", **to(15, 5))
    assert "crosses" not in accepted(notched, "/waypoint", **to(15, 9))


def test_a_world_with_too_many_walls_for_a_plan_is_reported_as_unchecked() -> None:
    with serving(replace(PLAN, walls=None)) as served:
        text = accepted(served, "/waypoint", **to(15, 5))
    assert "it was not compared with the obstacles: the world has too many" in text


def test_the_answer_to_an_order_states_what_it_waits_for(served: Served) -> None:
    position(served, 5, 5)
    assert accepted(served, "/waypoint", **to(10, 10)) == (
        "bender/0: waypoint [10.00, 10.00] ordered; queued: bender/0 is not armed"
    )
    arm(served)
    assert accepted(served, "/waypoint", **to(10, 9)).endswith("waypoint [10.00, 9.00] ordered")
    accepted(served, "/hold")
    accepted(served, "/navigate", robot=ROBOT, is_on=False)
    accepted(served, "/mode", robot=ROBOT, mode="manual")
    assert accepted(served, "/waypoint", **to(10, 8)).endswith(
        "queued: bender/0 is in manual mode, the robots are held, the navigation of bender/0 is off"
    )


def test_orders_that_the_loop_has_not_reported_count_as_waypoints(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(waypoint_request, "MAX_WAYPOINTS", 2)
    accepted(served, "/waypoint", **to(10, 10))
    goal(served, 1, [10, 10])
    accepted(served, "/waypoint", **to(11, 10))
    assert refused(served, "/waypoint", **to(12, 10)) == "bender/0 has 2 waypoints already"


def test_a_waypoint_has_one_notation(served: Served) -> None:
    angle = {"degrees": 36, "minutes": 35.7, "hemisphere": "N"}
    assert "either point_m, or" in refused(served, "/waypoint", **to(10, 10), latitude=angle)
    assert not served.orders

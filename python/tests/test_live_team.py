"""Several robots that share waypoints by radio: claims, visits, and robots that fall silent."""

from collections import Counter
from pathlib import Path
from typing import Any

from bare_timer import repeated_if_late
from live_bench import INEXACT, changed_scenario, driving, emulated, fleet_text

import agent_economy as ae
from agent_economy import Simulation
from agent_economy.live import fleet
from agent_economy.live.loop.shared import MAX_AGE_S, SharedWaypoints
from agent_economy.live.loop.team import Team
from agent_economy.live.replay import read_drive
from agent_economy.live.verification import INPUT

WAYPOINTS_M = [[12.0, 7.0], [12.0, 23.0]]
TEAM = Path(__file__).resolve().parents[2] / "scenarios" / "bender-team.toml"


def goal(number: int, status: str, at: list[float] | None = None) -> dict[str, Any]:
    """Return a message about a destination of its sender."""
    place = at or WAYPOINTS_M[number]
    about = {"id": {"issuer": {"kind": 9, "index": 1}, "number": number}, "at": place}
    return {"about": {"goal": about | {"status": status}}, "confidence": 1.0}


def pose() -> dict[str, Any]:
    sender = {"at": [1.0, 1.0], "heading_rad": 0.0, "observations": 0}
    return {"about": {"sender": sender}, "confidence": 1.0}


def shared() -> SharedWaypoints:
    return SharedWaypoints(WAYPOINTS_M, ("bender/0", "bender/1", "bender/2"))


def verdicts(team: SharedWaypoints, now_s: float) -> list[tuple[str, str | None]]:
    return [(each["verdict"], each["served_by"]) for each in team.verdicts(now_s)]


def test_a_waypoint_is_approached_by_the_robot_that_claims_it_and_then_served_by_it() -> None:
    team = shared()
    assert verdicts(team, 0.0) == [("pending", None)] * 2
    team.add("bender/1", [goal(1, "active")], 0.0)
    assert verdicts(team, 1.0) == [("pending", None), ("approaching", "bender/1")]
    team.add("bender/1", [goal(1, "done"), goal(0, "active")], 2.0)
    assert verdicts(team, 2.0) == [("approaching", "bender/1"), ("complete", "bender/1")]


def test_of_two_that_claim_or_reach_a_waypoint_one_is_named() -> None:
    team = shared()
    team.add("bender/2", [goal(0, "active")], 0.0)
    team.add("bender/1", [goal(0, "active")], 0.0)
    assert verdicts(team, 0.0)[0] == ("approaching", "bender/1")
    team.add("bender/2", [goal(0, "done")], 1.0)
    team.add("bender/1", [goal(0, "done")], 1.2)
    assert verdicts(team, 2.0)[0] == ("complete", "bender/2")


def test_a_claim_ends_when_it_is_released_or_its_robot_is_silent() -> None:
    team = shared()
    team.add("bender/0", [goal(0, "active")], 0.0)
    team.add("bender/1", [goal(1, "active")], 0.0)
    team.add("bender/0", [goal(0, "released")], 1.0)
    assert verdicts(team, 1.0) == [("pending", None), ("approaching", "bender/1")]
    for robot in ("bender/0", "bender/2"):
        team.add(robot, [pose()], MAX_AGE_S)
    assert team.silent(MAX_AGE_S) == set()
    assert team.silent(MAX_AGE_S + 0.1) == {"bender/1"}
    assert verdicts(team, MAX_AGE_S + 0.1) == [("pending", None)] * 2


def test_a_waypoint_that_every_robot_has_given_up_is_impossible_until_one_reaches_it() -> None:
    team = shared()
    for robot in range(3):
        name, at_s = f"bender/{robot}", float(robot)
        team.add(name, [goal(0, "active")], at_s)
        assert verdicts(team, at_s)[0] == ("approaching", name)
        status = "released" if robot else "active"  # a new destination releases the one before
        team.add(name, [goal(0 if robot else 1, status)], at_s)
    assert verdicts(team, 3.0)[0] == ("impossible", None)
    team.add("bender/1", [goal(0, "active")], 3.0)
    assert verdicts(team, 3.0)[0] == ("impossible", None)
    team.add("bender/1", [goal(0, "done")], 4.0)
    assert verdicts(team, 4.0)[0] == ("complete", "bender/1")


def test_a_robot_that_leaves_a_waypoint_to_another_has_not_given_it_up() -> None:
    team = shared()
    for robot in ("bender/1", "bender/0"):
        team.add(robot, [goal(0, "active")], 0.0)
    team.add("bender/1", [goal(1, "active")], 0.2)
    team.add("bender/0", [goal(0, "released")], 1.0)
    assert verdicts(team, 1.0) == [("pending", None), ("approaching", "bender/1")]


def test_a_waypoint_that_a_simulated_robot_may_reach_is_not_impossible() -> None:
    team = SharedWaypoints(WAYPOINTS_M, ("bender/0",), is_whole=False)
    team.add("bender/0", [goal(0, "active"), goal(0, "released")], 0.0)
    assert verdicts(team, 0.0)[0] == ("pending", None)


def test_a_goal_at_another_place_or_beyond_the_list_is_none_of_the_shared_waypoints() -> None:
    team = shared()
    team.add("bender/0", [goal(0, "done", [1.0, 2.0]), goal(7, "done", [1.0, 2.0])], 0.0)
    assert verdicts(team, 0.0) == [("pending", None)] * 2


def test_every_robot_of_the_team_lists_every_shared_waypoint() -> None:
    plan = fleet.load("bender-team").plan
    names = [robot.name for robot in plan.robots]
    assert not any(robot.takes_orders for robot in plan.robots)
    simulation = Simulation("bender-team", external=names)
    team = Team(plan, simulation, {}, seed=0, start_s=0.0)
    listed = Counter(each["robot"] for each in team.new_verdicts())
    assert listed == dict.fromkeys(names, 7)
    assert not list(team.new_verdicts())


def visits(record: Path, scenario: Path, names: list[str]) -> Counter[int]:
    """Return by how many robots each waypoint was reached; a robot may announce it repeatedly."""
    drive = read_drive(record)
    assert drive is not None
    given = {each["tick"]: each["percepts"] for topic, each in drive.messages if topic == INPUT}
    simulation = Simulation(ae.Scenario.load(scenario), external=names)
    found: set[tuple[int, str]] = set()
    for tick in range(max(given) + 1):
        for robot, command in simulation.step(percepts=given.get(tick, {})).items():
            for sent in command["outbox"]:
                about = sent["about"].get("goal", {})
                if about.get("status") == "done":
                    found.add((about["id"]["number"], robot))
    return Counter(waypoint for waypoint, _ in found)


FAST: dict[str, Any] = {"forward_m_s_per_unit": 0.03, "reverse_m_s_per_unit": 0.03}
CHANGES = {
    "max_speed_m_s": "max_speed_m_s = 1.2",
    "max_acceleration_m_s2": "max_acceleration_m_s2 = 4",
    "max_turn_rate_deg_s": "max_turn_rate_deg_s = 120",
    "noise_m = 0.2": "noise_m = 0.1",
    "rate_hz = 1 ": "rate_hz = 5",
}
"""Changes of the bundled scenario: faster robots."""


@repeated_if_late
def test_a_team_serves_each_waypoint_once_and_takes_over_that_of_a_silent_robot(
    tmp_path: Path,
) -> None:
    scenario = changed_scenario(tmp_path / "team.toml", CHANGES, TEAM)
    path = tmp_path / "fleet.toml"
    arguments = ("--scenario", str(scenario))
    with emulated(
        tmp_path, 5, arguments=arguments, gps_hz=5, sonar_hz=10, **FAST, **INEXACT
    ) as bench:
        path.write_text(fleet_text(bench, scenario=str(scenario), **FAST), encoding="utf-8")
        with driving(path) as drive:
            claim = drive.wait_for(lambda each: each.get("served_by") == "bender/2")
            bench.fault(2, "compass", "close")
            drive.wait_until_latched(["bender/2"])
            drive.wait_for(lambda each: each["type"] == "radio" and each["is_silent"])
            assert drive.wait(120) == 3  # a robot was stopped
    goals = [each for each in drive.events if each["type"] == "goal"]
    complete = [each for each in goals if each["verdict"] == "complete"]
    served = {each["goal"]: each["served_by"] for each in complete}
    assert sorted(served) == list("1234567")
    # Every robot lists every waypoint, with the same robot that served it.
    assert all(each["served_by"] == served[each["goal"]] for each in complete)
    assert len(complete) == 5 * 7
    assert served[claim["goal"]] != "bender/2"
    silent = {each["robot"] for each in drive.events if each["type"] == "radio"}
    assert "bender/2" in silent
    names = [f"bender/{number}" for number in range(5)]
    assert visits(drive.record, scenario, names) == dict.fromkeys(range(7), 1)
    assert ae.replay(drive.record).mismatch_tick is None

"""Drives whose goals are awarded by controllers: a verdict for each goal, and an end."""

import re
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from conftest import ROOT
from live_bench import Drive, driving, emulated, fleet_text

import agent_economy as ae
from agent_economy.live.loop.awarded import (
    DEFAULTS_S,
    FAILOVER_S,
    QUIET_S,
    TURN_S,
    AwardedGoals,
    awarded_to,
)
from agent_economy.live.replay import replay
from agent_economy.live.warden.sentences import sentence

FINAL = {"complete", "impossible"}

GOALS = """
[goals.spot]
count = {count}
within_m = 1.5
{keys}
placement = {{ kind = "fixed", at_m = {places} }}

[controllers.base]
count = {controllers}
start = {{ kind = "fixed", at_m = [[2, 2]] }}
radio = {{ range_m = {range_m}, messages_per_step = 20 }}
"""

NEAR = [[9, 11], [9, 19], [12, 7]]


def economy(path: Path, robots: int = 2, places: list[list[int]] = NEAR, **values: Any) -> Path:
    """Write a scenario of Benders that serve goals, which a controller awards."""
    text = (ROOT / "scenarios" / "bender-team.toml").read_text(encoding="utf-8")
    text = re.sub(r"(?m)^ +\{ kind = \"navigate\".*$", '    { kind = "serve" },', text)
    text = re.sub(r"(?m)^count = 5", f"count = {robots}", text)
    text = text.replace("range_m = 100\n", "range_m = 100\nmessages_per_step = 20\n")
    defaults = {"keys": "", "range_m": 100, "controllers": 1}
    path.write_text(
        text + GOALS.format(count=len(places), places=places, **defaults | values), encoding="utf-8"
    )
    return path


class Watch:
    """A run of simulated robots of which some count as real ones, and the verdicts of its goals.

    Attributes:
        goals: The verdicts.
        now_s: The time of the drive.
    """

    def __init__(self, scenario: Path, robots: tuple[str, ...] = ("bender/0", "bender/1")) -> None:
        """Begin the run."""
        self.simulation = ae.Simulation(str(scenario), 1)
        self.goals: AwardedGoals = awarded_to(self.simulation, robots)
        self.now_s = 100.0

    def step(self, seconds: float, *, is_driving: bool = True) -> dict[str, Any]:
        """Step the run and return the verdicts and the robots, by goal."""
        for _ in range(round(seconds / self.simulation.step_s)):
            self.simulation.step()
            self.now_s += self.simulation.step_s
            self.goals.update(self.now_s, is_driving=is_driving)
        return {
            each["goal"]: (each["verdict"], each["served_by"]) for each in self.goals.verdicts()
        }


def test_each_goal_is_pending_then_awarded_then_complete_as_judged(tmp_path: Path) -> None:
    watch = Watch(economy(tmp_path / "economy.toml"))
    seen: dict[str, list[str]] = {}
    for _ in range(600):
        for name, (verdict, robot) in watch.step(0.1).items():
            before = seen.setdefault(name, [])
            before += [verdict] if not before or before[-1] != verdict else []
            assert (robot in watch.simulation.robots) or verdict in ("pending", "impossible")
    assert {name: each[0] for name, each in seen.items()} == dict.fromkeys(seen, "pending")
    assert all(each[-1] == "complete" and each.count("complete") == 1 for each in seen.values())
    assert all("impossible" not in each for each in seen.values())
    judged = {each["name"]: each["served_by"] for each in watch.simulation.goals.to_pylist()}
    assert {name: robot for name, (_, robot) in watch.step(0.1).items()} == judged


def test_a_goal_that_no_robot_is_awarded_is_given_up_only_while_a_robot_drives(
    tmp_path: Path,
) -> None:
    # No robot is in range of the controller.
    watch = Watch(economy(tmp_path / "economy.toml", range_m=0.5))
    quiet_s = watch.goals.quiet_s
    assert quiet_s == QUIET_S + 2
    pending = {f"spot/{number}": ("pending", None) for number in range(3)}
    assert watch.step(3 * quiet_s, is_driving=False) == pending
    assert watch.step(quiet_s - 1) == pending
    assert watch.step(1, is_driving=False) == pending  # a hold
    assert watch.step(quiet_s - 1) == pending
    assert watch.step(2) == dict.fromkeys(pending, ("impossible", None))
    reasons = [each["unserved"] for each in watch.goals.verdicts()]
    assert reasons == ["no_robot"] * 3


def test_a_long_auction_and_a_lost_owner_are_waited_for(tmp_path: Path) -> None:
    path = economy(tmp_path / "slow.toml", keys="")
    slow = path.read_text().replace(
        "[controllers.base]", "[controllers.base]\nauction_s = 40\nservice_lease_s = 60"
    )
    path.write_text(slow.replace("count = 1\nstart", "count = 3\nstart"))
    path.write_text(path.read_text().replace("[[2, 2]]", "[[2, 2], [3, 3], [4, 4]]"))
    watch = Watch(path)
    assert watch.goals.quiet_s == QUIET_S + 2 * 40 + 30 + 60 + FAILOVER_S + 3 * TURN_S
    watch.step(20)  # the voters for the owner of each goal know it
    watch.simulation.fail("base/0")
    verdicts = [verdict for _ in range(300) for verdict, _ in watch.step(1).values()]
    assert verdicts[-3:] == ["complete"] * 3
    assert "impossible" not in verdicts


def test_the_defaults_of_controllers_are_those_of_the_schema() -> None:
    schema = (ROOT / "schemas" / "metric.schema.json").read_text(encoding="utf-8")
    for key, value in DEFAULTS_S.items():
        text = schema.partition(f'"{key}": {{')[2]
        assert float(re.findall(r'"default": ([\d.]+)', text)[0]) == value


@pytest.mark.parametrize("range_m", [100, 0.5])
def test_a_goal_that_arrives_later_is_given_up_only_a_quiet_time_after_its_arrival(
    range_m: float, tmp_path: Path
) -> None:
    scenario = economy(tmp_path / "late.toml", places=NEAR[:1], range_m=range_m)
    late = 'count = 1\narrive_s = 150\nplacement = { kind = "fixed", at_m = [[9, 15]] }\n'
    scenario.write_text(f"{scenario.read_text()}\n[goals.late]\n{late}")
    watch = Watch(scenario)
    first = [watch.step(1)["late/0"][0] for _ in range(150)]
    assert set(first) == {"pending"}
    then = [watch.step(1)["late/0"][0] for _ in range(round(watch.goals.quiet_s) - 1)]
    assert "impossible" not in then
    assert ("complete" in then) is (range_m == 100)
    last, robot = watch.step(10)["late/0"]
    assert (last == "complete") is (robot is not None) is (range_m == 100)
    assert last in FINAL


def test_a_drive_goes_on_until_a_goal_that_arrives_after_the_quiet_time_is_served(
    tmp_path: Path,
) -> None:
    # A drive ends, also a headless one, when every verdict of its robots is final.
    scenario = economy(tmp_path / "late.toml", 1, NEAR[:1])
    arrive_s = 2.5 * Watch(scenario, ("bender/0",)).goals.quiet_s
    late = f'count = 1\narrive_s = {arrive_s}\nplacement = {{ kind = "fixed", at_m = [[9, 15]] }}\n'
    scenario.write_text(f"{scenario.read_text()}\n[goals.late]\n{late}")
    watch = Watch(scenario, ("bender/0",))
    begun_s = watch.now_s
    seen = set()
    while {verdict for verdict, _ in watch.step(0.2).values()} - FINAL:
        seen |= {each["verdict"] for each in watch.goals.verdicts()}
        assert watch.now_s - begun_s < arrive_s + 60
    assert watch.now_s - begun_s > arrive_s
    assert {each["verdict"] for each in watch.goals.verdicts()} == {"complete"}
    assert "impossible" not in seen


def test_a_goal_that_expires_is_impossible(tmp_path: Path) -> None:
    brief = Watch(economy(tmp_path / "brief.toml", keys="deadline_s = 1"))
    assert {verdict for verdict, _ in brief.step(2).values()} == {"impossible"}


def test_that_a_real_robot_serves_a_goal_is_known_from_its_message(tmp_path: Path) -> None:
    watch = Watch(economy(tmp_path / "economy.toml", range_m=0.5))
    watch.step(0.2)
    goals = int(watch.simulation.goals["issuer"][1].as_py())
    for issuer, number in (({"list": goals}, 1), ({"kind": 0, "index": goals}, 2)):
        goal = {"issuer": issuer, "number": number}
        about = {"goal": {"id": goal, "at": [0.0, 0.0], "status": "done"}}
        watch.goals.add("bender/1", [{"about": about, "confidence": 1.0}])
    verdicts = watch.step(2 * QUIET_S)
    assert verdicts["spot/1"] == ("complete", "bender/1")
    assert verdicts["spot/2"] == ("impossible", None)


def test_without_controllers_or_robots_that_serve_there_are_no_awarded_goals(
    tmp_path: Path,
) -> None:
    path = economy(tmp_path / "economy.toml", controllers=0)
    assert Watch(path).step(1) == {}
    assert Watch(ROOT / "scenarios" / "bender.toml", ("bender/0",)).step(1) == {}


def test_a_goal_is_named_in_words_with_the_reason() -> None:
    event = {"type": "goal", "robot": "bender/0", "goal": "spot/1", "verdict": "complete"}
    served = event | {"served_by": "bender/1", "unserved": None}
    assert sentence(served) == "bender/0: goal spot/1: complete by bender/1"
    failed = event | {"verdict": "impossible", "served_by": None, "unserved": "no_robot"}
    assert sentence(failed) == "bender/0: goal spot/1: impossible: no robot"
    waypoint = event | {"goal": "2", "served_by": "bender/0"}
    assert sentence(waypoint) == "bender/0: waypoint 2: complete"


def last_verdicts(drive: Drive) -> dict[tuple[str, str], tuple[str, str | None]]:
    goals = (each for each in drive.events if each["type"] == "goal")
    return {(each["robot"], each["goal"]): (each["verdict"], each["served_by"]) for each in goals}


def one_goal_each(path: Path, places: list[list[int]]) -> Path:
    """Write a scenario of two Benders that serve one goal at a time.

    A robot that is not armed bids for nothing, so that the other one of its team could be awarded
    every goal before it is.
    """
    scenario = economy(path, 2, places)
    text = scenario.read_text(encoding="utf-8")
    scenario.write_text(text.replace('kind = "serve"', 'kind = "serve", max_goals = 1'))
    return scenario


def test_a_simulated_robot_of_the_team_serves_goals_too(tmp_path: Path) -> None:
    watch = Watch(economy(tmp_path / "economy.toml"), ("bender/0",))
    verdicts = watch.step(60)
    assert {verdict for verdict, _ in verdicts.values()} == {"complete"}
    assert {robot for _, robot in verdicts.values()} == {"bender/0", "bender/1"}


@repeated_if_late
def test_a_headless_drive_ends_with_0_when_every_goal_is_served_by_whatever_robot(
    tmp_path: Path,
) -> None:
    scenario = one_goal_each(tmp_path / "economy.toml", [[8, 11], [8, 15]])
    with emulated(tmp_path, 1, arguments=("--scenario", str(scenario))) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench, scenario=str(scenario)))
        with driving(fleet) as drive:
            assert drive.wait(60) == 0
    verdicts = last_verdicts(drive)
    # The other robot of the team is simulated.
    assert set(verdicts) == {("bender/0", "spot/0"), ("bender/0", "spot/1")}
    assert sorted(verdicts.values()) == [("complete", "bender/0"), ("complete", "bender/1")]
    assert replay(drive.record).agrees


@repeated_if_late
def test_a_headless_drive_ends_with_1_if_a_goal_has_expired(tmp_path: Path) -> None:
    scenario = one_goal_each(tmp_path / "economy.toml", [[7, 11], [7, 15]])
    brief = 'count = 1\ndeadline_s = 0.5\nplacement = { kind = "fixed", at_m = [[20, 5]] }\n'
    scenario.write_text(f"{scenario.read_text()}\n[goals.brief]\n{brief}")
    with emulated(tmp_path, 2, arguments=("--scenario", str(scenario))) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench, scenario=str(scenario)))
        with driving(fleet) as drive:
            assert drive.wait(60) == 1
    verdicts = last_verdicts(drive)
    assert len(verdicts) == 3 * 2  # of every goal, for every real robot
    for robot in ("bender/0", "bender/1"):
        served = [verdicts[robot, f"spot/{number}"] for number in (0, 1)]
        assert sorted(served) == [("complete", "bender/0"), ("complete", "bender/1")]
        assert verdicts[robot, "brief/0"] == ("impossible", None)
    assert replay(drive.record).agrees

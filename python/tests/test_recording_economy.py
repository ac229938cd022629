"""Recordings of goals and controllers, and their replay."""

import json
from pathlib import Path
from typing import Any

import jsonschema
from recorded import contents

import agent_economy as ae
from agent_economy.recording.reading import read
from agent_economy.server.runs.timeline import Timeline


def scenario(**overrides: Any) -> ae.Scenario:
    """Return the waypoints with four robots and two controllers; `__` stands for a dot."""
    scenario = ae.Scenario.load("waypoints").replace("robots.rover.count", 4)
    scenario = scenario.replace("controllers.base.count", 2)
    for path, value in overrides.items():
        scenario = scenario.replace(path.replace("__", "."), value)
    return scenario


def recorded(path: Path, steps: int = 300, **overrides: Any) -> ae.Simulation:
    """Record the first steps of a run."""
    simulation = ae.Simulation(scenario(**overrides), seed=1)
    with ae.Recording(simulation, path) as recording:
        recording.step(steps)
    return simulation


def events(path: Path) -> list[tuple[str, str]]:
    """Return the events in the log of a recording: names and words."""
    messages = contents(path).topics.get("/log", [])
    return [(message.content.name, message.content.message) for message in messages]


def test_the_replay_of_a_run_with_controllers_agrees_to_the_bit(mcap: Path) -> None:
    simulation = recorded(mcap)
    replayed = ae.replay(mcap)
    assert replayed.agrees
    assert replayed.hash == f"{simulation.hash:016x}"


def test_each_recorded_step_has_the_goals_and_the_controllers(mcap: Path) -> None:
    simulation = recorded(mcap)
    topics, schemas, *_ = contents(mcap)
    assert len(topics["/economy"]) == len(topics["/robots"]) == 301
    schema = json.loads(schemas["/economy"].data)
    for message in topics["/economy"]:
        jsonschema.validate(message.content, schema)
    last = topics["/economy"][-1].content
    assert last["controllers"]["name"] == ["base/0", "base/1"]
    assert last["controllers"]["working"] == [True, True]
    goals = last["goals"]
    rows = [dict(zip(goals, row, strict=True)) for row in zip(*goals.values(), strict=True)]
    names = simulation.goals["name"].to_pylist()
    served_s = simulation.goals["served_s"].to_pylist()
    assert [row["name"] for row in rows] == names
    assert [row["state"] == "served" for row in rows] == [at is not None for at in served_s]
    awarded = [row for row in rows if row["state"] == "awarded"]
    assert awarded
    for row in awarded:
        assert row["assignee"] in simulation.robots
        assert row["lease_s"] > 0
    assert any({row["owner"], *row["votes"]} == {"base/0", "base/1"} for row in rows)


def test_a_scenario_without_goals_and_controllers_has_no_such_topic(mcap: Path) -> None:
    ae.run(ae.Scenario.load("search").replace("clock.time_limit_s", 2), record=mcap)
    assert "/economy" not in contents(mcap).topics


def test_a_goal_that_no_robot_can_serve_is_in_the_log_once_with_the_reason(mcap: Path) -> None:
    corners = {"kind": "fixed", "at_m": [[5, 295], [295, 5], [5, 5]]}
    far: dict[str, Any] = {
        "controllers__base__start": corners,
        "controllers__base__backup": "none",
        "controllers__base__radio__range_m": 20,
    }
    recorded(mcap, 300, goals__spot__count=2, **far)
    found = [event for event in events(mcap) if "no robot" in event[1]]
    assert sorted(found) == [
        ("spot/0", "no robot can serve it: no_robot"),
        ("spot/1", "no robot can serve it: no_robot"),
    ]


def test_a_controller_that_fails_is_in_the_log_once(mcap: Path) -> None:
    simulation = ae.Simulation(scenario(), seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(50)
        simulation.fail("base/1")
        recording.step(50)
        simulation.change("robots.rover.count", 5)
        recording.step(50)
    assert events(mcap).count(("base/1", "has failed")) == 1
    assert ae.replay(mcap).agrees


def test_goals_of_two_controllers_of_which_one_fails_are_lost_in_the_log(mcap: Path) -> None:
    simulation = ae.Simulation(scenario(controllers__base__owner_lease_s=5), seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(100)
        simulation.fail("base/1")
        recording.step(200)
    lost = simulation.controllers[0]["lost"]
    assert lost
    logged = [name for name, words in events(mcap) if words.startswith("lost")]
    assert set(lost) <= set(logged)
    assert len(logged) == len(set(logged))


def test_the_next_owner_of_a_goal_of_a_failed_controller_is_recorded(mcap: Path) -> None:
    leases = {"controllers__base__owner_lease_s": 5, "controllers__base__service_lease_s": 5}
    three = scenario(controllers__base__count=3, **leases)
    simulation = ae.Simulation(three, seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(100)
        simulation.fail("base/0")
        recording.step(200)
    economy = contents(mcap).topics["/economy"]
    assert {"base/0", "base/1"} <= set(economy[100].content["goals"]["owner"])
    last = economy[-1].content
    assert last["controllers"]["working"] == [False, True, True]
    assert "base/0" not in last["goals"]["owner"]
    taken_over = [
        before == "base/0" and after in {"base/1", "base/2"}
        for before, after in zip(
            economy[100].content["goals"]["owner"], last["goals"]["owner"], strict=True
        )
    ]
    assert any(taken_over)


def test_a_player_that_steps_back_returns_to_the_same_controllers(mcap: Path) -> None:
    simulation = recorded(mcap)
    identity, history = read(mcap)
    timeline = Timeline(identity.scenario, identity.seed, identity.run, None, history)

    def at(tick: int) -> tuple[int, list[dict[str, Any]]]:
        while not timeline.seek(tick, 60.0):
            pass
        run = timeline.simulation
        assert isinstance(run, ae.Simulation)
        return run.hash, run.controllers

    early, late = at(120), at(300)
    assert early[1] != late[1]
    assert late == (simulation.hash, simulation.controllers)
    assert at(120) == early
    assert at(300) == late
    assert timeline.recorded.mismatch_tick is None


def test_a_snapshot_holds_the_controllers() -> None:
    simulation = ae.Simulation(scenario(), seed=1)
    simulation.step(100)
    snapshot, before = simulation.snapshot(), simulation.controllers
    simulation.step(100)
    after = simulation.controllers
    assert before != after
    simulation.restore(snapshot)
    assert simulation.controllers == before
    simulation.step(100)
    assert simulation.controllers == after

"""Recordings of the classic engine, and their replay."""

import json
import math
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from command_line import refuse, run, run_python
from recorded import SECOND_NS, Message, contents

import agent_economy as ae
from agent_economy import ClassicSimulation, InputError, Scenario

CHANGES: list[tuple[int, str, Any]] = [
    (0, "robots.wanderer.count", 6),
    (34, "robots.wanderer.count", 9),
    (50, "contact", "within-3"),
    (50, "merit", {"time": -1}),
    (90, "clock.paints_per_s", 1000),
    (120, "clock.time_limit_s", 1),
]


Topics = dict[str, list[Message]]


@pytest.fixture(scope="module")
def topics(tmp_path_factory: pytest.TempPathFactory) -> Topics:
    """Return the topics of a recorded run."""
    path = tmp_path_factory.mktemp("topics") / "run.mcap"
    ae.run("classic", 5, record=path)
    return contents(path).topics


def changed(path: Path, every: int = 1) -> ClassicSimulation:
    """Record a run with changes to its end."""
    simulation = ClassicSimulation(Scenario.load("classic").replace("contact", "ahead"), 3)
    with ae.Recording(simulation, path, every=every) as recording:
        for tick, name, value in CHANGES:
            recording.step(tick - simulation.tick)
            simulation.change(name, value)
        recording.finish()
    return simulation


def test_recording_does_not_change_the_run_and_can_be_replayed(mcap: Path) -> None:
    recorded = ae.run("classic", 3, 1, record=mcap)
    assert recorded == ae.run("classic", 3, 1)
    again = ae.replay(mcap)
    assert (again.agrees, again.is_complete, again.seed, again.run) == (True, True, 3, 1)
    assert again.outcome == recorded
    assert again.tick == recorded.row["paints"]


@pytest.mark.parametrize("every", [1, 7])
def test_a_run_with_changes_is_replayed(mcap: Path, every: int) -> None:
    simulation = changed(mcap, every)
    again = ae.replay(mcap)
    assert again.agrees
    assert (again.tick, again.hash) == (simulation.tick, f"{simulation.hash:016x}")
    assert again.outcome == simulation.outcome()


def test_the_same_run_gives_the_same_bytes(tmp_path: Path) -> None:
    first, again, other = (tmp_path / f"{name}.mcap" for name in ("first", "again", "other"))
    changed(first), changed(again)
    assert first.read_bytes() == again.read_bytes()
    ae.run("classic", 4, record=other)
    ae.run("classic", 3, record=first)
    assert first.read_bytes() != other.read_bytes()


def test_every_paint_is_recorded_with_its_robots(topics: Topics) -> None:
    simulation = ClassicSimulation("classic", 5)
    moments = zip(topics["/tf"], topics["/robots"], topics["/run"], strict=True)
    for frames, robots, at in moments:
        assert frames.time_ns == robots.time_ns == at.time_ns
        assert at.time_ns == round(simulation.time_s * SECOND_NS)
        assert at.content["hash"] == f"{simulation.hash:016x}"
        assert (at.content["carry"], at.content["decides_in"]) == (
            simulation.carry,
            simulation.decides_in,
        )
        team = simulation.team.to_pydict()
        state = robots.content
        assert state["x_m"] == (np.array(team["x_px"]) / 20).tolist()
        assert state["y_m"] == (25 - np.array(team["y_px"]) / 20).tolist()
        for name in ("column", "row", "speed", "left_turns", "right_turns", "colour"):
            assert state[name] == team[name]
        for number, frame in enumerate(frames.content.transforms):
            assert frame.child_frame_id == simulation.robots[number]
            assert frame.translation.x == state["x_m"][number]
            assert frame.translation.y == state["y_m"][number]
            turn = 2 * math.atan2(frame.rotation.z, frame.rotation.w)
            upwards = math.radians(90 - team["heading_deg"][number])
            assert math.cos(turn - upwards) == pytest.approx(1, abs=1e-15)
            assert math.cos(state["heading_rad"][number] - upwards) == pytest.approx(1, abs=1e-15)
            assert -math.pi < state["heading_rad"][number] <= math.pi
        simulation.step()
    assert simulation.is_over
    assert topics["/run"][-1].content["tick"] == simulation.tick


def test_the_scene_is_the_classic_world_with_y_upwards(topics: Topics) -> None:
    assert set(topics) == {
        "/tf", "/robots", "/run", "/team", "/scene/world", "/scene/robots", "/scene/items",
        "/scene/found/0", "/log", "/outcome",
    }  # fmt: skip
    (world,) = topics["/scene/world"]
    (walls,) = world.content.entities
    assert len(walls.cubes) == 96 + 6 + 3 + 4 + 3
    middles = {(each.pose.position.x, each.pose.position.y) for each in walls.cubes}
    # The frame's corner, and the obstacle in columns 3 to 5 of row 11 from the top.
    assert {(0.5, 0.5), (3.5, 13.5), (5.5, 13.5)} <= middles
    (items,) = topics["/scene/items"]
    places = [each.pose.position for each in items.content.entities[0].spheres]
    assert [(at.x, at.y) for at in places] == [(3.5, 7.5), (9.5, 19.5), (14.5, 2.5), (21.5, 16.5)]
    bodies = topics["/scene/robots"][0].content.entities
    assert [each.frame_id for each in bodies] == [f"wanderer/{number}" for number in range(4)]


def test_bodies_have_the_colours_of_the_robots(topics: Topics) -> None:
    states = {each.time_ns: each.content["colour"] for each in topics["/robots"]}
    painted = {"blue": set(), "yellow": set(), "red": set()}  # type: dict[str, set[float]]
    for time_ns, scene in topics["/scene/robots"]:
        for colour, entity in zip(states[time_ns], scene.entities, strict=True):
            painted[colour].add(round(entity.cylinders[0].color.r, 3))
    assert all(len(each) == 1 for each in painted.values())
    assert len(set.union(*painted.values())) == 3
    changes = [a != b for a, b in zip([None, *states.values()], states.values(), strict=False)]
    assert len(topics["/scene/robots"]) == sum(changes)


@pytest.mark.parametrize("every", [1, 25])
def test_every_find_is_in_the_log_at_its_time(mcap: Path, every: int) -> None:
    simulation = changed(mcap, every)
    topics = contents(mcap).topics
    finds = [each.content for each in topics["/log"] if each.content.name != "scenario"]
    found_s = simulation.items["found_s"].to_pylist()
    there = {f"item/{place}" for place, at_s in enumerate(found_s) if at_s is not None}
    assert sorted(each.name for each in finds) == sorted(there)
    assert topics["/run"][-1].content["found"] == len(there) > 1


def test_finds_in_the_log_have_their_seconds(mcap: Path) -> None:
    simulation = ClassicSimulation("classic", 0)
    with ae.Recording(simulation, mcap) as recording:
        recording.finish()
    log = contents(mcap).topics["/log"]
    finds = {each.content.name: (each.content.message, each.time_ns) for each in log}
    found_s = simulation.items["found_s"].to_pylist()
    assert finds == {
        f"item/{place}": (f"found at {at_s:.3f} s", round(at_s * SECOND_NS))
        for place, at_s in enumerate(found_s)
    }
    assert 0 in found_s  # one beside the start


def test_times_ascend_also_if_paints_become_shorter(mcap: Path) -> None:
    simulation = changed(mcap)
    runs = contents(mcap).topics["/run"]
    times_ns = [each.time_ns for each in runs]
    assert times_ns == sorted(times_ns)
    last = simulation.tick
    assert times_ns[-1] == round(90 / 56 * SECOND_NS) + (last - 90) * SECOND_NS // 1000


def test_changes_are_in_the_log_and_teams_follow_them(mcap: Path) -> None:
    changed(mcap)
    topics = contents(mcap).topics
    changes = [each.content.message for each in topics["/log"] if each.content.name == "scenario"]
    assert changes == [f"{name} = {value!r}" for _, name, value in CHANGES]
    teams = [len(each.content["robots"]) for each in topics["/team"]]
    assert teams == [4, 6, 9, 9, 9, 9, 9]


def test_json_messages_conform_to_their_schemas(mcap: Path) -> None:
    changed(mcap)
    topics, schemas, *_ = contents(mcap)
    declared = {
        topic: json.loads(schema.data)
        for topic, schema in schemas.items()
        if schema.encoding == "jsonschema"
    }
    assert set(declared) == {"/run", "/team", "/robots", "/outcome"}
    for topic, schema in declared.items():
        for message in topics[topic]:
            jsonschema.validate(message.content, schema)


def test_a_finished_run_does_not_advance_until_a_change(mcap: Path) -> None:
    simulation = ClassicSimulation(Scenario.load("classic").replace("clock.time_limit_s", 1), 1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(10**12)
        assert simulation.tick == 56
        simulation.change("clock.time_limit_s", 2)
        recording.finish()
    ticks = [each.content["tick"] for each in contents(mcap).topics["/run"]]
    assert ticks == [*range(57), *range(56, 113)]
    assert ae.replay(mcap).agrees


def test_robots_of_the_classic_engine_have_no_percepts_and_commands(mcap: Path) -> None:
    with pytest.raises(InputError, match=r"percepts = .*: must be none: robots of the classic"):
        ae.Recording(ClassicSimulation("classic"), mcap, percepts=["wanderer/0"])
    assert not mcap.exists()
    with ae.Recording(ClassicSimulation("classic"), mcap) as recording:
        for name in ("percepts", "commands"):
            given: dict[str, Any] = {name: {}}
            with pytest.raises(InputError, match=f"{name} = .*: must be none: robots of the cla"):
                recording.step(**given)
        recording.step(3)
    assert ae.replay(mcap).tick == 3


def test_a_different_run_mismatches_at_its_end(mcap: Path) -> None:
    short, long = (ClassicSimulation(capped(time_limit_s), 1) for time_limit_s in (1, 5))
    with ae.Recording(short, mcap) as recording:
        recording.step(20)
        long.step(20)
        short._run.restore(long._run.snapshot())
        recording.step(80)
    again = ae.replay(mcap)
    assert (again.mismatch_tick, again.tick) == (57, 56)


def capped(time_limit_s: float) -> Scenario:
    return Scenario.load("classic").replace("clock.time_limit_s", time_limit_s)


KILLED = """
import os, signal, sys, agent_economy as ae
recording = ae.Recording(ae.ClassicSimulation("classic", 7), sys.argv[1])
recording.step(600)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_killed_process_leaves_a_readable_recording(mcap: Path) -> None:
    assert run_python(KILLED, mcap).returncode != 0
    again = ae.replay(mcap)
    assert (again.agrees, again.is_complete) == (True, False)
    assert 600 - 5 * 56 < again.tick <= 600


def test_the_command_line_records_and_replays(mcap: Path) -> None:
    given = run("run", "classic", "--seed", "7", "--record", mcap, "--every", "5", "--json")
    assert (given.returncode, given.stderr) == (0, "")
    outcome = ae.run("classic", 7)
    assert json.loads(given.stdout)["paints"] == outcome.row["paints"]
    again = run("replay", mcap)
    assert (again.returncode, again.stderr) == (0, "")
    steps = f"{outcome.row['paints']:,}"
    assert again.stdout.startswith(f"classic, seed 7, run 0: reproduced up to step {steps}")
    errors = refuse("run", "classic", "--record", mcap, "--percepts", "wanderer/0")
    assert "robots of the classic engine have no percepts or commands" in errors

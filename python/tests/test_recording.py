"""Recordings of the metric engine, and their replay."""

import json
import math
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from command_line import refuse, run, run_python, succeed
from conftest import ROOT
from mcap.records import Channel
from mcap.stream_reader import StreamReader
from metric import ENDLESS, search
from recorded import SECOND_NS, Message, contents

import agent_economy as ae
from agent_economy import InputError, Scenario
from agent_economy.recording.reading import read
from agent_economy.runs.brain import Command, Percept
from agent_economy.server.runs.timeline import Timeline

SCENARIOS = ROOT / "scenarios"

SHORT = {"clock.time_limit_s": 10}

DRIVE: Command = {
    "motion": {"speed_m_s": 0.5, "turn_rate_rad_s": 0.3},
    "heading_rad": None,
    "requests": [],
    "outbox": [],
}


def short(path: Path, seed: int = 1) -> Path:
    """Record ten seconds of the bundled search."""
    ae.run(search(SHORT), seed, record=path)
    return path


def test_recording_does_not_change_the_run(mcap: Path) -> None:
    recorded = ae.run("open-field", 3, 1, record=mcap)
    assert recorded == ae.run("open-field", 3, 1)


def test_recorded_poses_are_those_of_each_step(mcap: Path) -> None:
    topics = contents(short(mcap)).topics
    simulation = ae.Simulation(search(SHORT), 1)
    assert len(topics["/tf"]) == len(topics["/robots"]) == len(topics["/run"])
    for frames, robots, at in zip(topics["/tf"], topics["/robots"], topics["/run"], strict=True):
        assert frames.time_ns == robots.time_ns == at.time_ns == simulation.tick * SECOND_NS // 10
        assert at.content["hash"] == f"{simulation.hash:016x}"
        poses = [robots.content[name] for name in ("x_m", "y_m", "heading_rad")]
        assert np.array_equal(np.transpose(poses), simulation.poses)
        assert robots.content["speed_m_s"] == simulation.speeds.tolist()
        assert robots.content["battery"] == simulation.battery.tolist()
        assert robots.content["status"] == simulation.status.tolist()
        each = frames.content.transforms
        assert tuple(frame.child_frame_id for frame in each) == simulation.robots
        for frame, (x_m, y_m, heading_rad) in zip(each, simulation.poses.tolist(), strict=True):
            assert (frame.translation.x, frame.translation.y) == (x_m, y_m)
            turn = 2 * math.atan2(frame.rotation.z, frame.rotation.w)
            assert math.cos(turn - heading_rad) == pytest.approx(1, abs=1e-15)
            now_ns = frame.timestamp.seconds * SECOND_NS + frame.timestamp.nanos
            assert now_ns == frames.time_ns
        simulation.step()
    assert topics["/run"][-1].content["tick"] == simulation.tick - 1 == 100


def test_the_same_run_gives_the_same_bytes(tmp_path: Path) -> None:
    first, again, other = (tmp_path / f"{name}.mcap" for name in ("first", "again", "other"))
    assert short(first).read_bytes() == short(again).read_bytes()
    assert short(other, seed=2).read_bytes() != first.read_bytes()


def test_the_file_alone_suffices_for_a_replay(
    tmp_path: Path, mcap: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = tmp_path / "there"
    shutil.copytree(SCENARIOS, there)
    scenario = Scenario.load(there / "open-field.toml").replace("clock.time_limit_s", 20)
    ae.run(scenario, seed=2**64 - 1, run=7, record=mcap)
    shutil.rmtree(there)
    monkeypatch.chdir(tmp_path)
    again = ae.replay("run.mcap")
    assert (again.agrees, again.is_complete, again.tick) == (True, True, 200)
    assert (again.seed, again.run, again.scenario.name) == (2**64 - 1, 7, "open-field")
    assert again.outcome == ae.run(again.scenario, 2**64 - 1, 7)


def test_changes_are_replayed(mcap: Path) -> None:
    simulation = ae.Simulation(search(), 4)
    simulation.change("robots.rover.count", 5)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(30)
        simulation.change("robots.rover.count", 2)
        simulation.change("world.obstacles", [{"circle": {"at_m": [12, 12], "radius_m": 1}}])
        recording.step(30)
    again = ae.replay(mcap)
    assert again.agrees
    assert int(again.hash, 16) == simulation.hash
    topics = contents(mcap).topics
    assert [len(each.content["robots"]) for each in topics["/team"]] == [5, 2]
    assert [len(each.content.entities) for each in topics["/scene/robots"]] == [5, 2]
    changes = [each.content.message for each in topics["/log"] if each.content.name == "scenario"]
    assert changes[:2] == ["robots.rover.count = 5", "robots.rover.count = 2"]


def test_external_inputs_are_replayed(mcap: Path) -> None:
    simulation = ae.Simulation(search(), 4)
    percept: Percept = {
        "position": {"value": (3.0, 4.0), "age_s": 0.0},
        "scans": [{"age_s": 0.0, "ranges_m": [math.inf] * 55}],
    }
    with ae.Recording(simulation, mcap) as recording:
        recording.step(commands={"rover/0": DRIVE})
        answers = recording.step(percepts={"rover/1": percept})
        recording.step(5)
    assert set(answers) == {"rover/1"}
    assert ae.replay(mcap).agrees
    assert len(contents(mcap).topics["/input"]) == 2


def test_declared_external_bodies_are_replayed(mcap: Path) -> None:
    simulation = ae.Simulation(search(), 4, external=["rover/1", "rover/0"])
    percept: Percept = {"position": {"value": (3.0, 4.0), "age_s": 0.0}, "time_s": 1.0}
    with ae.Recording(simulation, mcap) as recording:
        recording.step(5)
        for _ in range(2):  # the second one is not later
            recording.step(percepts={"rover/1": percept})
        recording.step(5)
    assert ae.replay(mcap).agrees
    identity, recorded = read(mcap)
    assert identity.external == recorded.external == simulation.declared_external
    timeline = Timeline(identity.scenario, identity.seed, identity.run, None, recorded)
    timeline.seek(12, 60.0)
    assert timeline.simulation.hash == simulation.hash
    assert timeline.recorded.mismatch_tick is None
    assert timeline.history.external == identity.external


@pytest.mark.parametrize("age_s", [-1e308, -5.0, 1.0, 1e308])
def test_an_external_scan_of_any_age_has_a_time_within_the_run(mcap: Path, age_s: float) -> None:
    simulation = ae.Simulation("search", 4)
    percept: Percept = {"scans": [{"age_s": age_s, "ranges_m": [-1e308] * 55}]}
    with ae.Recording(simulation, mcap, percepts=["rover/1"]) as recording:
        recording.step(25)
        recording.step(percepts={"rover/1": percept})
    scan = contents(mcap).topics["/scan/rover/1/0"][-1].content
    taken_ns = scan.timestamp.seconds * SECOND_NS + scan.timestamp.nanos
    assert taken_ns == (2.5 - min(max(age_s, 0), 2.5)) * SECOND_NS
    assert ae.replay(mcap).agrees


def test_a_rejected_step_is_not_recorded(mcap: Path) -> None:
    with ae.Recording(ae.Simulation("search"), mcap) as recording:
        with pytest.raises(InputError):
            recording.step(commands={"rover/9": DRIVE})
        recording.step(2)
    assert "/input" not in contents(mcap).topics
    assert ae.replay(mcap).agrees


def test_a_manipulated_run_does_not_agree(mcap: Path) -> None:
    simulation = ae.Simulation("search")
    with ae.Recording(simulation, mcap) as recording:
        recording.step(20)
        simulation.step(commands={"rover/0": DRIVE})
        recording.step(20)
    again = ae.replay(mcap)
    assert (again.agrees, again.mismatch_tick) == (False, 22)


def test_a_brain_gives_the_recorded_commands_for_the_recorded_percepts(mcap: Path) -> None:
    simulation = ae.Simulation("open-field", 5)
    chosen = ("rover/1", "bird/0")
    with ae.Recording(simulation, mcap, every=10, percepts=chosen) as recording:
        recording.step(300)
    plain = ae.Simulation("open-field", 5)
    plain.step(300)
    assert plain.hash == simulation.hash
    topics = contents(mcap).topics
    for name in chosen:
        brain = ae.Brain.of("open-field", name.partition("/")[0])
        percepts, commands = topics[f"/percept/{name}"], topics[f"/command/{name}"]
        # The bird breaks early.
        assert len(percepts) == len(commands) > (20 if name == "bird/0" else 299)
        for (time_ns, percept), command in zip(percepts, commands, strict=True):
            assert time_ns == command.time_ns
            assert brain.step(percept)["motion"] == command.content["motion"]


def test_scans_have_the_ranges_of_percepts_and_the_bearings_of_the_body(mcap: Path) -> None:
    simulation = ae.Simulation("search", 5)
    with ae.Recording(simulation, mcap, percepts=["rover/0"]) as recording:
        recording.step(20)
    with mcap.open("rb") as stream:
        channels = [each for each in StreamReader(stream).records if isinstance(each, Channel)]
    about = next(each.metadata for each in channels if each.topic == "/percept/rover/0")
    body = json.loads(about["body"])
    topics = contents(mcap).topics
    bearings = body["rings"][0]["bearings_rad"]
    percepts = {each.time_ns: each.content for each in topics["/percept/rover/0"]}
    assert topics["/scan/rover/0/0"]
    for time_ns, scan in topics["/scan/rover/0/0"]:
        ranges = percepts[time_ns]["scans"][0]["ranges_m"]
        assert list(scan.ranges) == [math.inf if each is None else each for each in ranges]
        steps = np.linspace(scan.start_angle, scan.end_angle, len(ranges))
        assert np.allclose(np.exp(1j * steps), np.exp(1j * np.array(bearings)), atol=1e-12)


def test_the_scene_shows_the_scenario_and_the_finds(mcap: Path) -> None:
    outcome = ae.run("open-field", 3, record=mcap)
    topics = contents(mcap).topics
    world = {each.id: each for each in topics["/scene/world"][0].content.entities}
    border = {(point.x, point.y) for point in world["border"].lines[0].points}
    assert border == {(0, 0), (60, 0), (60, 40), (0, 40)}
    assert set(world) == {
        "border", "obstacle/1", "obstacle/2", "obstacle/3", "ground/grass/0", "ground/swamp/0",
    }  # fmt: skip
    circle = world["obstacle/2"].cylinders[0]
    assert (circle.pose.position.x, circle.pose.position.y, circle.size.x) == (12, 10, 4)
    grid = topics["/map/0"][0].content
    assert (grid.column_count, len(grid.data) // grid.row_stride) == (48, 36)
    (items,) = topics["/scene/items"]
    counts = {each.id: len(each.spheres) for each in items.content.entities}
    assert counts == {"flag/0-1": 2, "mine/0-5": 6, "scrap/0-9": 10}
    repainted = [each.id for each in topics["/scene/found/0"][-1].content.entities]
    logged = [each.content.name for each in topics["/log"] if "found" in each.content.message]
    assert sorted(logged) == sorted(repainted)
    assert sum(found or 0 for found in outcome.found.values()) == len(logged) > 0


def test_the_scene_has_every_copy_of_an_obstacle(mcap: Path) -> None:
    rack = {"rectangle": {"at_m": [4, 5], "size_m": [1, 2]}}
    pillar = {"circle": {"at_m": [20, 3], "radius_m": 0.5}}
    repeat = {"columns": 3, "rows": 2, "spacing_m": [4, 6]}
    obstacles = [{**rack, "repeat": repeat}, pillar]
    ae.run(search({"world.obstacles": obstacles, "clock.time_limit_s": 1}), 3, record=mcap)
    entities = contents(mcap).topics["/scene/world"][0].content.entities
    found = {each.id: each for each in entities if each.id.startswith("obstacle/")}
    assert list(found) == [f"obstacle/{number}" for number in range(7)]
    corners = {(point.x, point.y) for point in found["obstacle/5"].lines[0].points}
    assert corners == {(11.5, 10), (12.5, 10), (12.5, 12), (11.5, 12)}
    assert len(found["obstacle/6"].cylinders) == 1
    assert ae.replay(mcap).agrees


MANY = {"items.mine.count": 3000, "robots.rover.count": 20, "clock.time_limit_s": 60}


def found_at(topics: Mapping[str, list[Message]], time_ns: int) -> list[str]:
    """Return the finds that a viewer shows after a jump: the last message of each topic."""
    found = []
    for topic in (name for name in topics if name.startswith("/scene/found/")):
        until = [each.content for each in topics[topic] if each.time_ns <= time_ns]
        found += [entity.id for entity in until[-1].entities] if until else []
    return sorted(found)


def test_a_viewer_that_jumps_in_time_shows_the_finds_until_then(mcap: Path) -> None:
    simulation = ae.Simulation(search(MANY), 1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(400)
        simulation.change("items.mine.count", 2900)
        recording.step(100)
        simulation.change("items.mine.count", 30)
        recording.step(10)
        left = simulation.items["found_s"].to_pylist()
    topics = contents(mcap).topics
    assert set(topics) >= {f"/scene/found/{level}" for level in (0, 1)}
    moments = topics["/run"]
    counts = [each.content["found"] for each in moments]
    assert max(counts) > 500
    for each, count in zip(moments[::7], counts[::7], strict=True):
        if each.time_ns not in {40 * SECOND_NS, 50 * SECOND_NS}:
            assert len(set(found_at(topics, each.time_ns))) == count
    expected = sorted(f"mine/{i}" for i, found_s in enumerate(left) if found_s is not None)
    assert found_at(topics, moments[-1].time_ns) == expected


def test_the_number_of_writes_per_find_is_bounded(mcap: Path) -> None:
    outcome = ae.run(search(MANY), 1, record=mcap)
    topics = contents(mcap).topics
    assert len(topics["/scene/items"]) == 1
    found = [name for name in topics if name.startswith("/scene/found/")]
    written = sum(len(each.content.entities) for name in found for each in topics[name])
    assert 0 < written < 20 * len(found) * sum(each or 0 for each in outcome.found.values())


def test_collisions_and_status_changes_are_in_the_log_and_the_colours(mcap: Path) -> None:
    crowded = search(
        {"robots.rover.count": 20, "robots.rover.collision.max_collisions": 1, **SHORT}
    )
    outcome = ae.run(crowded.replace("world.size_m", [26, 25]), 1, record=mcap)
    topics = contents(mcap).topics
    words = [each.content.message for each in topics["/log"]]
    assert words.count("broken") == outcome.robots_stopped
    assert topics["/run"][-1].content["stopped"] == outcome.robots_stopped
    assert topics["/outcome"][0].content["robots_stopped"] == outcome.robots_stopped


def test_json_messages_conform_to_their_schemas(mcap: Path) -> None:
    simulation = ae.Simulation("open-field", 2)
    with ae.Recording(simulation, mcap, percepts=["rover/0"]) as recording:
        recording.step(5, commands=None)
        recording.step(commands={"rover/2": DRIVE})
    topics, schemas, *_ = contents(mcap)
    declared = {
        topic: schema for topic, schema in schemas.items() if schema.encoding == "jsonschema"
    }
    assert set(declared) == {
        "/run", "/team", "/robots", "/input", "/outcome", "/percept/rover/0", "/command/rover/0",
    }  # fmt: skip
    for topic, schema in declared.items():
        for message in topics[topic]:
            jsonschema.validate(message.content, json.loads(schema.data))


@pytest.mark.parametrize(("every", "steps"), [(1, 25), (10, 25), (10, 30), (100, 7)])
def test_every_nth_step_is_recorded_and_the_first_and_the_last(
    mcap: Path, every: int, steps: int
) -> None:
    with ae.Recording(ae.Simulation("search"), mcap, every=every) as recording:
        recording.step(steps)
    ticks = [each.content["tick"] for each in contents(mcap).topics["/run"]]
    assert ticks == sorted({*range(0, steps, every), steps})
    assert ae.replay(mcap).agrees


def test_a_run_restored_to_an_earlier_step_cannot_be_recorded(mcap: Path) -> None:
    simulation = ae.Simulation("search")
    recording = ae.Recording(simulation, mcap)
    before = simulation.snapshot()
    recording.step(5)
    simulation.restore(before)
    with pytest.raises(InputError, match="restored to an earlier step"):
        recording.step()


def test_all_invalid_arguments_are_reported(tmp_path: Path, mcap: Path) -> None:
    with pytest.raises(InputError) as caught:
        ae.Recording(ae.Simulation("search"), tmp_path / "run", every=0, percepts=["rover/4"])
    assert f"{tmp_path}/run: the name of a recording must end in .mcap" in str(caught.value)
    assert "every = 0: must be a whole number, 1 or more" in str(caught.value)
    assert "'rover/4': must be among the run's robots: rover/0 to rover/3" in str(caught.value)
    assert not (tmp_path / "run").exists()
    with pytest.raises(InputError, match="cannot be written: No such file"):
        ae.run("search", record=tmp_path / "none" / "run.mcap")
    with pytest.raises(InputError, match="must be a Simulation or a ClassicSimulation"):
        ae.Recording("search", mcap)  # type: ignore[arg-type]


@pytest.mark.parametrize("steps", [-1, 1.5, "1", True, None])
def test_a_recording_accepts_the_same_numbers_of_steps_as_a_simulation(
    mcap: Path, steps: Any
) -> None:
    simulation = ae.Simulation("search")
    with ae.Recording(simulation, mcap) as recording:
        for each in (simulation, recording):
            with pytest.raises(InputError, match=r"steps = .*: must be a whole number"):
                each.step(steps)
        assert recording.step(np.int64(2)) == {}  # type: ignore[arg-type]
    assert simulation.tick == 2


def test_a_closed_recording_does_not_step(mcap: Path) -> None:
    simulation = ae.Simulation("search")
    with ae.Recording(simulation, mcap) as recording:
        recording.step(2)
    for act in (recording.step, recording.note, recording.finish):
        with pytest.raises(InputError, match="the recording is closed"):
            act()
    with pytest.raises(InputError, match="the recording is closed"):
        recording.step(commands={"rover/0": DRIVE})
    recording.close()
    assert simulation.tick == 2
    assert ae.replay(mcap).tick == 2


def test_a_recording_never_replaces_a_file_of_its_scenario(tmp_path: Path, mcap: Path) -> None:
    text = (SCENARIOS / "open-field.toml").read_text().replace("open-field.yaml", "map.mcap")
    (tmp_path / "map.mcap").write_bytes((SCENARIOS / "open-field.yaml").read_bytes())
    shutil.copy(SCENARIOS / "open-field.pgm", tmp_path)
    own = tmp_path / "own.mcap"
    own.write_text(text)
    (tmp_path / "link.mcap").symlink_to(own)
    before = {file: file.read_bytes() for file in tmp_path.iterdir()}
    for name in ("own.mcap", "link.mcap", "map.mcap"):
        with pytest.raises(InputError, match=f"{name}: must not be a file that the scenario was"):
            ae.run(own, record=tmp_path / name)
    with pytest.raises(
        InputError, match=r"open-field.pgm: the name of a recording must end in \.mcap"
    ):
        ae.run(own, record=tmp_path / "open-field.pgm")
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before
    ae.run(own, record=mcap)
    assert ae.run(own, record=mcap) == ae.run(own)


def test_a_run_without_robots_is_recorded_without_percepts(mcap: Path) -> None:
    empty = ae.Simulation(search({"robots.rover.count": 0}))
    with pytest.raises(
        InputError, match="'rover/0': must be among the run's robots, and it has no"
    ):
        ae.Recording(empty, mcap, percepts=["rover/0"])
    with ae.Recording(empty, mcap) as recording:
        recording.step(3)
    assert ae.replay(mcap).agrees


FILLS = """
import resource, sys, agent_economy as ae
from agent_economy.recording import RecordingError
simulation = ae.Simulation("search")
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
try:
    with ae.Recording(simulation, sys.argv[1]) as recording:
        recording.finish()
except RecordingError as error:
    print(error)
try:
    recording.step()
except ae.InputError as error:
    print(error)
"""


def test_a_full_disk_is_reported_with_the_file_and_the_remedies(mcap: Path) -> None:
    given = run_python(FILLS, mcap)
    assert (given.returncode, given.stderr) == (0, "")
    full, closed = given.stdout.splitlines()
    assert full.startswith(f"{mcap}: recording stopped: File too large: free some space")
    assert closed.startswith("the recording is closed")
    again = ae.replay(mcap)
    assert (again.agrees, again.is_complete) == (True, False)
    assert again.tick > 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_the_command_line_reports_a_full_disk(mcap: Path) -> None:
    mcap.symlink_to("/dev/full")
    errors = refuse("run", "search", "--record", mcap, code=1)
    assert errors.startswith(f"{mcap}: recording stopped: No space left")
    assert len(errors.splitlines()) == 1
    assert "1 the recording cannot be written" in " ".join(run("run", "--help").stdout.split())


KILLED = """
import sys, agent_economy as ae
from metric import ENDLESS, search
with ae.Recording(ae.Simulation(search(ENDLESS)), sys.argv[1]) as recording:
    while True:
        recording.step()
"""


def test_a_killed_process_leaves_a_readable_recording(mcap: Path) -> None:
    script = [sys.executable, "-c", KILLED, str(mcap)]
    process = subprocess.Popen(script, cwd=Path(__file__).parent)
    try:
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not (mcap.exists() and mcap.stat().st_size > 200_000):
            time.sleep(0.05)
    finally:
        process.kill()
        process.wait()
    again = ae.replay(mcap)
    assert (again.agrees, again.is_complete) == (True, False)
    assert again.tick >= 100
    assert again.scenario.to_dict() == search(ENDLESS).to_dict()


def test_runs_without_a_recording_do_not_import_the_writer() -> None:
    script = (
        "import sys, agent_economy as ae; ae.run('search'); ae.Simulation('search').step();"
        "print([name for name in sys.modules if name.startswith(('mcap', 'google.protobuf'))])"
    )
    assert run_python(script, check=True).stdout.strip() == "[]"


def test_the_command_line_records_and_replays(mcap: Path) -> None:
    args = ("search", "--seed", "7", "--set", "clock.time_limit_s=10", "--every", "5")
    succeed("run", *args, "--record", mcap, "--percepts", "rover/0")
    assert {"/tf", "/percept/rover/0"} < contents(mcap).topics.keys()
    again = run("replay", mcap)
    assert (again.returncode, again.stderr) == (0, "")
    assert again.stdout.startswith("search, seed 7, run 0: reproduced up to step 100")
    result = json.loads(run("replay", mcap, "--json").stdout)
    assert (result["agrees"], result["mismatch_tick"], result["tick"]) == (True, None, 100)
    refuse("replay", "README.md")


def test_the_command_line_reports_a_mismatch(mcap: Path) -> None:
    simulation = ae.Simulation("search")
    with ae.Recording(simulation, mcap) as recording:
        simulation.step(commands={"rover/0": DRIVE})
        recording.step(3)
    given = run("replay", mcap)
    assert given.returncode == 1
    assert "search, seed 0, run 0: differs from the recording from step 2 on" in given.stdout

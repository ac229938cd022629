"""The hash of all percepts and commands, in runs and in recordings."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from command_line import run
from mcap.records import Channel, Message
from metric import search, world
from recorded import contents
from test_python_brains import bundled
from test_recording import DRIVE
from test_recording_damaged import records_of, written

import agent_economy as ae
from agent_economy import InputError, Scenario
from agent_economy.runs.brain import Command

CRUISING = Scenario.loads(
    world("""
clock.time_limit_s = 60
world.size_m = [200, 200]
items.stone = { count = 1, target = false }
[robots.rover]
count = 2
radius_m = 0.2
start = { kind = "fixed", at_m = [[100, 100], [50, 100]] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
brain = { behaviours = [{ kind = "cruise" }] }
""")
)

AHEAD: Command = {
    "motion": {"speed_m_s": 1.0, "turn_rate_rad_s": 0.0},
    "heading_rad": None,
    "requests": [],
    "outbox": [],
}
"""The command that all of its brains give."""

WITH_HEADING: Command = {**AHEAD, "heading_rad": 0.5}
"""The same motion, with a heading that no body of the simulator uses."""


def hashed(scenario: Scenario | str, steps: int = 50, **given: Any) -> int:
    """Return the hash of the decisions of a run after some steps."""
    simulation = ae.Simulation(scenario, 7, **given)
    simulation.hash_decisions()
    simulation.step(steps)
    assert simulation.decision_hash is not None
    return simulation.decision_hash


def edited(source: Path, to: Path, edit: Callable[[dict[str, Any]], None]) -> Path:
    """Write a copy of a recording with edited messages on /run."""
    records = records_of(source)
    channel = next(
        each.id for each in records if isinstance(each, Channel) and each.topic == "/run"
    )

    def of(record: Any) -> Any:
        if not isinstance(record, Message) or record.channel_id != channel:
            return record
        message = json.loads(record.data)
        edit(message)
        return replace(record, data=json.dumps(message).encode())

    return written(to, [of(each) for each in records])


def test_scenarios_that_differ_in_one_obstacle_have_different_hashes_at_0_s() -> None:
    obstacles = search().to_dict()["world"]["obstacles"]
    fewer = ae.Simulation(search({"world.obstacles": obstacles[:-1]}))
    everything = ae.Simulation(search())
    assert (fewer.poses == everything.poses).all()
    assert fewer.hash != everything.hash


def test_decisions_are_hashed_on_request_only_and_change_nothing() -> None:
    plain, simulation = ae.Simulation("search", 7), ae.Simulation("search", 7)
    assert simulation.decision_hash is None
    simulation.hash_decisions()
    assert simulation.decision_hash == 0
    for _ in range(50):
        before = simulation.decision_hash
        simulation.step()
        plain.step()
        assert simulation.hash == plain.hash
        assert simulation.decision_hash != before
    assert plain.decision_hash is None


@pytest.mark.parametrize("name", ["search", "search-beliefs"])
def test_the_same_decisions_have_the_same_hash_wherever_they_are_made(name: str) -> None:
    scenario = Scenario.load(name)
    own = hashed(name)
    assert hashed(name, brains=bundled(scenario)) == own
    assert hashed(name, threads=2) == own
    assert ae.Simulation(name, 8).decision_hash != own


@pytest.mark.parametrize("start", [-1, 2**64, 1.5, "0", True])
def test_a_start_that_is_no_hash_is_refused(start: Any) -> None:
    with pytest.raises(InputError, match="start = .*: must be a whole number from 0 to"):
        ae.Simulation("search").hash_decisions(start)


def test_snapshots_contain_the_hash_of_decisions() -> None:
    simulation = ae.Simulation("search", 7)
    simulation.hash_decisions()
    simulation.step(10)
    kept, at = simulation.snapshot(), simulation.decision_hash
    simulation.step(10)
    later = simulation.decision_hash
    simulation.restore(kept)
    assert simulation.decision_hash == at
    simulation.step(10)
    assert simulation.decision_hash == later


def test_robots_of_the_classic_engine_have_no_decisions(mcap: Path) -> None:
    simulation = ae.ClassicSimulation("classic", 1)
    simulation.hash_decisions()
    with ae.Recording(simulation, mcap) as recording:
        recording.step(20)
    assert simulation.decision_hash is None
    assert "decisions" not in contents(mcap).topics["/run"][-1].content
    assert ae.replay(mcap).agrees


@pytest.mark.parametrize("name", ["search", "search-beliefs", "flock"])
@pytest.mark.parametrize("every", [1, 7])
def test_a_recording_contains_the_hash_of_decisions_of_each_recorded_step(
    mcap: Path, name: str, every: int
) -> None:
    simulation, same = ae.Simulation(name, 7), ae.Simulation(name, 7)
    with ae.Recording(simulation, mcap, every=every) as recording:
        recording.step(30)
    same.hash_decisions()
    read = contents(mcap)
    for each in read.topics["/run"]:
        same.step(each.content["tick"] - same.tick)
        assert each.content["decisions"] == f"{same.decision_hash:016x}"
    assert same.tick == 30
    (end,) = (each.metadata for each in read.metadata if each.name == "agent_economy.end")
    assert end["decisions"] == f"{same.decision_hash:016x}"
    assert (ae.replay(mcap).agrees, ae.replay(mcap).mismatch) == (True, None)


def test_recordings_of_one_run_that_begin_at_different_steps_are_replayed(tmp_path: Path) -> None:
    simulation = ae.Simulation("search", 7)
    first, second = tmp_path / "first.mcap", tmp_path / "second.mcap"
    simulation.step(5)
    with ae.Recording(simulation, first) as outer:
        outer.step(5)
        with ae.Recording(simulation, second) as inner:
            inner.step(5)
            outer.note()
        outer.step(5)
    assert ae.replay(first).agrees
    assert ae.replay(second).agrees


def test_recorded_decisions_of_python_brains_are_replayed(mcap: Path) -> None:
    scenario = Scenario.load("search-beliefs")
    with ae.Recording(ae.Simulation(scenario, 7, brains=bundled(scenario)), mcap) as recording:
        recording.step(30)
    assert ae.replay(mcap).agrees


def test_a_command_that_changes_no_state_is_found_by_a_replay(mcap: Path) -> None:
    def recorded(command: Command) -> ae.recording.Replay:
        simulation = ae.Simulation(CRUISING, 7)
        with ae.Recording(simulation, mcap) as recording:
            recording.step(20)
            simulation.step(commands={"rover/0": command})  # not in the file
            recording.note()
            recording.step(20)
        return ae.replay(mcap)

    assert recorded(AHEAD).agrees
    again = recorded(WITH_HEADING)
    assert (again.agrees, again.mismatch_tick, again.mismatch) == (False, 21, "decisions")
    assert int(again.hash, 16) == int(contents(mcap).topics["/run"][-1].content["hash"], 16)
    given = run("replay", mcap)
    assert given.returncode == 1
    assert "differs from the recording from step 21 on, first in its decisions" in given.stdout
    assert json.loads(run("replay", mcap, "--json").stdout)["mismatch"] == "decisions"


def test_a_command_that_changes_the_state_is_found_in_both_hashes(mcap: Path) -> None:
    simulation = ae.Simulation("search")
    with ae.Recording(simulation, mcap) as recording:
        recording.step(3)
        simulation.step(commands={"rover/0": DRIVE})
        recording.step(3)
    assert ae.replay(mcap).mismatch == "decisions and state"
    given = run("replay", mcap)
    assert "on, first in its decisions and state" in given.stdout


@pytest.mark.parametrize(("entry", "name"), [("decisions", "decisions"), ("hash", "state")])
def test_a_changed_hash_in_a_recording_is_found(
    mcap: Path, tmp_path: Path, entry: str, name: str
) -> None:
    with ae.Recording(ae.Simulation("search", 7), mcap) as recording:
        recording.step(20)

    def edit(message: dict[str, Any]) -> None:
        if message["tick"] == 12:
            message[entry] = f"{int(message[entry], 16) ^ 1:016x}"

    again = ae.replay(edited(mcap, tmp_path / "edited.mcap", edit))
    assert (again.mismatch_tick, again.mismatch) == (12, name)


def test_a_recording_without_decisions_is_compared_by_its_states(
    mcap: Path, tmp_path: Path
) -> None:
    with ae.Recording(ae.Simulation("search", 7), mcap) as recording:
        recording.step(20)
    old = edited(mcap, tmp_path / "old.mcap", lambda message: message.pop("decisions"))
    again = ae.replay(old)
    assert (again.agrees, again.tick) == (True, 20)


def test_a_run_that_is_restored_to_a_state_without_a_hash_is_recorded_without_one(
    mcap: Path,
) -> None:
    simulation = ae.Simulation("search", 7)
    simulation.step(10)
    later = simulation.snapshot()
    simulation = ae.Simulation("search", 7)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(5)
        simulation.restore(later)
        recording.step(5)
    decisions = [each.content["decisions"] for each in contents(mcap).topics["/run"]]
    assert decisions[-1] is None
    assert None not in decisions[:6]
    assert ae.replay(mcap).agrees

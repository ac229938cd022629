"""Python brains decide from the same percepts and at the same steps as those of the scenario."""

import math
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alarm import ringing
from example_brains import AHEAD, SMALL, Ahead, Bumper, Talker
from metric import ENDLESS, FULL, search

import agent_economy as ae
from agent_economy import Brain, InputError, Scenario, Simulation
from agent_economy.runs.brain import Body, Command, Percept


def bundled(scenario: Scenario) -> dict[str, Any]:
    """Return Python brains that delegate to those of the scenario."""
    return {kind: lambda _, kind=kind: Brain.of(scenario, kind) for kind in scenario.robots}


def finished(scenario: Scenario | str, run: int = 2, **given: Any) -> Simulation:
    """Return a finished run."""
    simulation = Simulation(scenario, 7, run, **given)
    simulation.finish()
    return simulation


@pytest.mark.parametrize("name", ["search", "open-field", "small"])
def test_a_bundled_brain_from_python_gives_the_same_run(name: str) -> None:
    scenario = Scenario.loads(SMALL) if name == "small" else Scenario.load(name)
    plain, same = finished(scenario), finished(scenario, brains=bundled(scenario))
    assert same.hash == plain.hash
    assert same.outcome() == plain.outcome() == ae.run(scenario, 7, 2, brains=bundled(scenario))


def test_a_bundled_behaviour_rewritten_in_python_gives_the_same_run() -> None:
    scenario = Scenario.loads(SMALL)
    plain = [finished(scenario, run) for run in range(4)]
    bumpers = [finished(scenario, run, brains={"bumper": Bumper}) for run in range(4)]
    assert [each.hash for each in bumpers] == [each.hash for each in plain]
    assert sum(each.outcome().row["collisions"] for each in plain) > 20, "the robots do bounce"


def test_messages_and_requests_of_a_brain_equal_those_of_commands() -> None:
    scenario = Scenario.loads(SMALL)
    alone, scripted = Simulation(scenario, brains={"bumper": Talker}), Simulation(scenario)
    body: Any = {}
    talkers = {robot: Talker(body) for robot in scripted.robots}
    messages = 0
    for _ in range(300):
        percepts = {robot: scripted.percept(robot) for robot in scripted.robots}
        commands = {name: talkers[name].step(each) for name, each in percepts.items() if each}
        messages += sum(len(command["outbox"]) for command in commands.values())
        scripted.step(commands=commands)
        alone.step()
        assert alone.decided == commands
    assert alone.hash == scripted.hash
    assert messages > 10


def test_each_robot_has_its_own_brain_made_from_its_body() -> None:
    made: list[Talker] = []

    def make(body: Body) -> Talker:
        made.append(Talker(body))
        return made[-1]

    simulation = Simulation(search({"robots.rover.brain.rate_hz": 5}), brains={"rover": make})
    assert len(made) == 4
    assert {brain.body["max_speed_m_s"] for brain in made} == {1.0}
    simulation.step(10)
    assert [brain.steps for brain in made] == [5] * 4


def test_only_the_named_kind_has_python_brains() -> None:
    mixed = Simulation("open-field", brains={"bird": Ahead})
    mixed.step()
    assert list(mixed.decided) == ["bird/0"]


def test_a_command_replaces_the_decision_of_a_python_brain() -> None:
    simulation = Simulation("search", brains={"rover": Ahead})
    simulation.step(commands={"rover/1": AHEAD})
    assert list(simulation.decided) == ["rover/0", "rover/2", "rover/3"]


def test_robots_that_remain_after_a_change_keep_their_brains() -> None:
    made: list[Talker] = []

    def make(body: Body) -> Talker:
        made.append(Talker(body))
        return made[-1]

    simulation = Simulation("search", brains={"rover": make})
    simulation.step(10)
    simulation.change("robots.rover.count", 2)
    simulation.change("robots.rover.count", 3)
    simulation.step(10)
    assert [brain.steps for brain in made] == [10, 10, 5, 5, 5]


def test_runs_of_replicate_start_with_new_brains() -> None:
    table = ae.replicate("search", 3, seed=5, first_run=2, brains={"rover": Talker})
    rows = [ae.run("search", 5, run, brains={"rover": Talker}).row for run in (2, 3, 4)]
    assert table.to_pylist() == rows
    assert table.schema == ae.replicate("search", 1).schema
    assert ae.replicate("search", 0, brains={"rover": Talker}).num_rows == 0


def test_a_run_without_room_is_quarantined_with_python_brains_too() -> None:
    scenario = Scenario.loads(FULL)
    assert ae.run(scenario, brains={"first": Ahead}).status == "quarantined"


def test_a_recording_contains_the_decisions_of_python_brains(tmp_path: Path) -> None:
    scenario = Scenario.loads(SMALL).replace("clock.time_limit_s", 10)
    outcome = ae.run(scenario, 3, record=tmp_path / "talk.mcap", brains={"bumper": Talker})
    again = ae.replay(tmp_path / "talk.mcap")
    assert again.agrees
    assert again.outcome.row == outcome.row


def commanding(what: Any) -> Callable[[Body], Any]:
    """Return a class of brains with a constant command."""

    class Constant(Ahead):
        def step(self, percept: Percept) -> Command:
            del percept
            return what  # type: ignore[no-any-return]

    return Constant


ERRORS: list[tuple[Any, str]] = [
    ([Ahead], r"brains = \[.*\]: must be a dict by the names of kinds"),
    ({"rvoer": Ahead}, r"brains = 'rvoer': must be one of 'rover'; did you mean 'rover'\?"),
    ({7: Ahead}, "brains = 7: must be a dict by the names of kinds"),
    ({"rover": 7}, "brains.rover = 7: must be a Batch, or a class or function that returns"),
    (
        {"rover": lambda body: body},
        r"brains.rover = \{.*: must be a class or function that returns objects",
    ),
    ({"rover": commanding(None)}, r'brains."rover/0".step\(\) = null: must be a dict'),
    (
        {"rover": commanding({"motoin": {}})},
        r"step\(\).motoin is not a known key: .*did you mean motion\?",
    ),
    (
        {"rover": commanding({"motion": {"speed_m_s": math.nan}})},
        r'brains."rover/0".step\(\).motion.speed_m_s = nan: must be a finite number',
    ),
]


@pytest.mark.parametrize(("brains", "expected"), ERRORS)
def test_invalid_brains_are_named(brains: Any, expected: str) -> None:
    with pytest.raises(InputError, match=expected):
        Simulation("search", brains=brains).step()


def test_invalid_arguments_are_named_with_brains_too() -> None:
    for wrong in ({"runs": -1}, {"runs": 1, "first_run": -1}, {"runs": 1, "seed": -1}):
        given: Any = wrong
        with pytest.raises(InputError, match=f"{[*wrong][-1]} = -1: must be a whole number"):
            ae.replicate("search", brains={"rover": Ahead}, **given)


def test_the_classic_engine_takes_no_python_brains() -> None:
    with pytest.raises(InputError, match="engine = 'classic': must be 'metric'"):
        ae.run("classic", brains={"wanderer": Ahead})


def test_huge_commands_are_limited_by_the_body() -> None:
    far = commanding({"motion": {"speed_m_s": 1e308, "turn_rate_rad_s": -1e308}})
    simulation = Simulation("search", brains={"rover": far})
    simulation.step(5)
    assert simulation.speeds.max() <= 1.0
    assert np.isfinite(simulation.poses).all()


class SometimesError(Exception):
    """Raised by brains of these tests."""


def test_exceptions_of_a_brain_leave_the_run_unchanged() -> None:
    should_raise = True

    class Fragile(Talker):
        def step(self, percept: Percept) -> Command:
            if should_raise and percept["time_s"] > 1:
                raise SometimesError
            return AHEAD

    scenario = Scenario.loads(SMALL)
    simulation, plain = (Simulation(scenario, brains={"bumper": make}) for make in (Fragile, Ahead))
    with pytest.raises(SometimesError) as caught:
        simulation.finish()
    assert caught.value.__notes__ == ["in the brain of bumper/0, at 1.3 s"]
    assert traceback.extract_tb(caught.value.__traceback__)[-1].line == "raise SometimesError"
    before = simulation.hash
    with pytest.raises(SometimesError):
        simulation.step()
    assert (simulation.hash, simulation.tick) == (before, 13)
    should_raise = False
    assert (simulation.finish(), simulation.hash) == (plain.finish(), plain.hash)


def test_an_exception_while_making_a_brain_names_the_robot() -> None:
    def make(_: Body) -> Ahead:
        raise SometimesError

    with pytest.raises(SometimesError) as caught:
        Simulation("search", brains={"rover": make})
    assert caught.value.__notes__ == ["while making the brain of rover/0 from its body"]


def test_a_brain_that_accesses_its_run_is_an_error() -> None:
    runs: list[Simulation] = []

    class Cheat(Ahead):
        def step(self, percept: Percept) -> Command:
            assert runs[0].poses.any()
            return super().step(percept)

    runs.append(Simulation("search", brains={"rover": Cheat}))
    with pytest.raises(InputError, match="must not access or step the run that it is part of"):
        runs[0].step()
    assert runs[0].tick == 0


def test_runs_with_python_brains_have_no_snapshots() -> None:
    plain, mine = Simulation("search"), Simulation("search", brains={"rover": Ahead})
    with pytest.raises(InputError, match=r"snapshot: .* in Python = \['rover'\]: must be none"):
        mine.snapshot()
    with pytest.raises(InputError, match=r"restore: .* in Python = \['rover'\]: must be none"):
        mine.restore(plain.snapshot())


def test_an_external_body_cannot_have_a_python_brain() -> None:
    simulation = Simulation("search", brains={"rover": Ahead})
    with pytest.raises(InputError, match="a robot with the brain of the scenario"):
        simulation.step(percepts={"rover/0": {}})


def test_a_signal_stops_runs_with_python_brains() -> None:
    with ringing(0.3):
        ae.replicate(search(ENDLESS), 100, brains={"rover": Ahead})


def test_a_signal_stops_a_brain_that_never_returns() -> None:
    class Stuck(Ahead):
        def step(self, percept: Percept) -> Command:
            while percept:
                pass
            return AHEAD

    simulation = Simulation("search", brains={"rover": Stuck})
    with ringing(0.3):
        simulation.step()
    assert simulation.tick == 0

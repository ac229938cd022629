"""Brains in Python decide as those of the scenario do: the same percepts, the same steps."""

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


def shipped(scenario: Scenario) -> dict[str, Any]:
    """Return brains in Python that hand everything to those of the scenario."""
    return {kind: lambda _, kind=kind: Brain.of(scenario, kind) for kind in scenario.robots}


def finished(scenario: Scenario | str, run: int = 2, **given: Any) -> Simulation:
    """Return a run that is over."""
    simulation = Simulation(scenario, 7, run, **given)
    simulation.finish()
    return simulation


@pytest.mark.parametrize("name", ["search", "open-field", "small"])
def test_the_shipped_brain_in_python_is_the_same_run(name: str) -> None:
    scenario = Scenario.loads(SMALL) if name == "small" else Scenario.load(name)
    plain, same = finished(scenario), finished(scenario, brains=shipped(scenario))
    assert same.hash == plain.hash
    assert same.outcome() == plain.outcome() == ae.run(scenario, 7, 2, brains=shipped(scenario))


def test_a_shipped_behaviour_in_plain_python_is_the_same_run() -> None:
    scenario = Scenario.loads(SMALL)
    plain = [finished(scenario, run) for run in range(4)]
    bumpers = [finished(scenario, run, brains={"bumper": Bumper}) for run in range(4)]
    assert [each.hash for each in bumpers] == [each.hash for each in plain]
    assert sum(each.outcome().row["collisions"] for each in plain) > 20, "they do bounce"


def test_what_a_brain_tells_and_switches_counts_as_if_told_by_hand() -> None:
    scenario = Scenario.loads(SMALL)
    alone, by_hand = Simulation(scenario, brains={"bumper": Talker}), Simulation(scenario)
    body: Any = {}
    talkers = {robot: Talker(body) for robot in by_hand.robots}
    said = 0
    for _ in range(300):
        percepts = {robot: by_hand.percept(robot) for robot in by_hand.robots}
        commands = {robot: talkers[robot].step(told) for robot, told in percepts.items() if told}
        said += sum(len(command["outbox"]) for command in commands.values())
        by_hand.step(commands=commands)
        alone.step()
        assert alone.decided == commands
    assert alone.hash == by_hand.hash
    assert said > 10


def test_each_robot_has_a_brain_of_its_own_made_of_its_body() -> None:
    made: list[Talker] = []

    def make(body: Body) -> Talker:
        made.append(Talker(body))
        return made[-1]

    simulation = Simulation(search({"robots.rover.brain.rate_hz": 5}), brains={"rover": make})
    assert len(made) == 4
    assert {brain.body["max_speed_m_s"] for brain in made} == {1.0}
    simulation.step(10)
    assert [brain.steps for brain in made] == [5] * 4


def test_only_the_kind_that_is_named_has_brains_in_python() -> None:
    mixed = Simulation("open-field", brains={"bird": Ahead})
    mixed.step()
    assert list(mixed.decided) == ["bird/0"]


def test_a_command_from_outside_stands_for_what_a_brain_in_python_would_decide() -> None:
    simulation = Simulation("search", brains={"rover": Ahead})
    simulation.step(commands={"rover/1": AHEAD})
    assert list(simulation.decided) == ["rover/0", "rover/2", "rover/3"]


def test_robots_that_stay_through_a_change_keep_their_brains() -> None:
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


def test_runs_of_replicate_begin_with_new_brains() -> None:
    table = ae.replicate("search", 3, seed=5, first_run=2, brains={"rover": Talker})
    rows = [ae.run("search", 5, run, brains={"rover": Talker}).row for run in (2, 3, 4)]
    assert table.to_pylist() == rows
    assert table.schema == ae.replicate("search", 1).schema
    assert ae.replicate("search", 0, brains={"rover": Talker}).num_rows == 0


def test_a_run_without_room_is_quarantined_with_brains_in_python_too() -> None:
    scenario = Scenario.loads(FULL)
    assert ae.run(scenario, brains={"first": Ahead}).status == "quarantined"


def test_a_recording_holds_what_brains_in_python_decided(tmp_path: Path) -> None:
    scenario = Scenario.loads(SMALL).replace("clock.time_limit_s", 10)
    outcome = ae.run(scenario, 3, record=tmp_path / "talk.mcap", brains={"bumper": Talker})
    again = ae.replay(tmp_path / "talk.mcap")
    assert again.agrees
    assert again.outcome.row == outcome.row


def saying(what: Any) -> Callable[[Body], Any]:
    """Return what makes brains that command something."""

    class Says(Ahead):
        def step(self, percept: Percept) -> Command:
            del percept
            return what  # type: ignore[no-any-return]

    return Says


FAULTS: list[tuple[Any, str]] = [
    ([Ahead], r"brains = \[.*\]: must be a dict by the names of robot kinds"),
    ({"rvoer": Ahead}, r'brains = "rvoer": must be one of "rover"; did you mean "rover"\?'),
    ({7: Ahead}, "brains = 7: must be a dict by the names of robot kinds"),
    ({"rover": 7}, "brains.rover = 7: must be a Batch, or a class or function that returns"),
    (
        {"rover": lambda body: body},
        r"brains.rover = \{.*: must be a class or function that returns objects",
    ),
    ({"rover": saying(None)}, r'brains."rover/0".step\(\) = null: must be a dict'),
    (
        {"rover": saying({"motoin": {}})},
        r"step\(\).motoin is not a known key: .*did you mean motion\?",
    ),
    (
        {"rover": saying({"motion": {"speed_m_s": math.nan}})},
        r'brains."rover/0".step\(\).motion.speed_m_s = nan: must be a finite number',
    ),
]


@pytest.mark.parametrize(("brains", "told"), FAULTS)
def test_what_is_wrong_with_brains_is_told(brains: Any, told: str) -> None:
    with pytest.raises(InputError, match=told):
        Simulation("search", brains=brains).step()


def test_what_is_wrong_with_arguments_is_told_with_brains_too() -> None:
    for wrong in ({"runs": -1}, {"runs": 1, "first_run": -1}, {"runs": 1, "seed": -1}):
        given: Any = wrong
        with pytest.raises(InputError, match=f"{[*wrong][-1]} = -1: must be a whole number"):
            ae.replicate("search", brains={"rover": Ahead}, **given)


def test_engines_without_brains_have_none_in_python_either() -> None:
    with pytest.raises(InputError, match="engine = 'classic': must be 'metric'"):
        ae.run("classic", brains={"wanderer": Ahead})


def test_numbers_beyond_all_bounds_are_what_the_body_can_do_of_them() -> None:
    far = saying({"motion": {"speed_m_s": 1e308, "turn_rate_rad_s": -1e308}})
    simulation = Simulation("search", brains={"rover": far})
    simulation.step(5)
    assert simulation.speeds.max() <= 1.0
    assert np.isfinite(simulation.poses).all()


class SometimesError(Exception):
    """What a brain of these tests raises."""


def test_what_a_brain_raises_comes_out_and_the_run_is_as_before() -> None:
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


def test_a_brain_that_cannot_be_made_is_told_with_its_robot() -> None:
    def make(_: Body) -> Ahead:
        raise SometimesError

    with pytest.raises(SometimesError) as caught:
        Simulation("search", brains={"rover": make})
    assert caught.value.__notes__ == ["while making the brain of rover/0 from its body"]


def test_a_brain_that_looks_at_its_run_is_told_and_nothing_hangs() -> None:
    runs: list[Simulation] = []

    class Cheat(Ahead):
        def step(self, percept: Percept) -> Command:
            assert runs[0].poses.any()
            return super().step(percept)

    runs.append(Simulation("search", brains={"rover": Cheat}))
    with pytest.raises(InputError, match="must not access or step the run that it is part of"):
        runs[0].step()
    assert runs[0].tick == 0


def test_what_brains_in_python_remember_is_in_no_snapshot() -> None:
    plain, mine = Simulation("search"), Simulation("search", brains={"rover": Ahead})
    with pytest.raises(InputError, match=r"snapshot: brains = \['rover'\]: must be none"):
        mine.snapshot()
    with pytest.raises(InputError, match=r"restore: brains = \['rover'\]: must be none"):
        mine.restore(plain.snapshot())


def test_a_body_outside_cannot_have_a_brain_in_python() -> None:
    simulation = Simulation("search", brains={"rover": Ahead})
    with pytest.raises(InputError, match="a robot with the brain of the scenario"):
        simulation.step(percepts={"rover/0": {}})


def test_a_signal_ends_runs_with_brains_in_python_soon() -> None:
    with ringing(0.3):
        ae.replicate(search(ENDLESS), 100, brains={"rover": Ahead})


def test_a_signal_ends_a_brain_that_never_comes_to_an_end() -> None:
    class Stuck(Ahead):
        def step(self, percept: Percept) -> Command:
            while percept:
                pass
            return AHEAD

    simulation = Simulation("search", brains={"rover": Stuck})
    with ringing(0.3):
        simulation.step()
    assert simulation.tick == 0

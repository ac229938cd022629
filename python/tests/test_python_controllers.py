"""Controllers in Python decide from the same percepts as those of the scenario, also in studies."""

import json
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from command_line import run_process
from example_brains import Ahead
from example_controllers import FEW_GOALS, LATE, Late, NoController

import agent_economy as ae
from agent_economy import InputError, Scenario, Simulation, study
from agent_economy.runs.brain import Percept
from agent_economy.server.workspace import Workspace
from agent_economy.study.errors import StudyError

TWO_KINDS = FEW_GOALS.replace("[goals.spot]", '[goals.spot]\nowner = "base"') + (
    "[controllers.reserve]\ncount = 1\nradio = { range_m = 100 }\n"
)


def finished(scenario: Scenario | str, **given: Any) -> Simulation:
    """Return a finished run."""
    simulation = Simulation(scenario, 7, 2, **given)
    simulation.finish()
    return simulation


def rows(folder: Path) -> list[tuple[object, ...]]:
    """Return all runs of a study, in order."""
    return study.open(folder).runs().order("configuration, run").fetchall()


@pytest.mark.parametrize("count", [1, 3])
def test_a_bundled_controller_from_python_gives_the_same_goals_at_the_same_times(
    count: int,
) -> None:
    scenario = Scenario.load("waypoints").replace("controllers.base.count", count)
    controllers = dict.fromkeys(scenario.controllers, ae.Controller)
    plain, same = finished(scenario), finished(scenario, controllers=controllers)
    for column in ("served_s", "served_by", "arrived_s"):
        assert same.goals[column].equals(plain.goals[column])
    assert same.outcome() == plain.outcome()
    assert len(set(plain.goals["served_by"].to_pylist())) > 2


def test_a_controller_of_ones_own_decides_in_whole_runs_as_by_hand(tmp_path: Path) -> None:
    scenario, given = Scenario.load("waypoints"), {"base": ae.Controller}
    whole = finished(scenario, controllers=given)
    by_hand, controller = Simulation(scenario, 7, 2), ae.Controller.of(scenario, "base")
    while not by_hand.is_over:
        percept = by_hand.percept("base/0")
        by_hand.step(commands={"base/0": controller.step(percept)} if percept else None)
    assert whole.outcome() == by_hand.outcome() == ae.run(scenario, 7, 2, controllers=given)
    assert whole.hash == by_hand.hash
    recorded = ae.run(scenario, 7, 2, tmp_path / "run.mcap", controllers=given)
    assert recorded == whole.outcome()


def test_brains_and_controllers_of_ones_own_decide_in_the_same_run() -> None:
    scenario = Scenario.loads(FEW_GOALS)
    brains: Any = {"rover": lambda _: ae.Brain.of(scenario, "rover")}
    both = finished(scenario, brains=brains, controllers={"base": ae.Controller})
    assert both.outcome() == finished(scenario).outcome()


def test_tables_with_controllers_of_ones_own_are_the_same_in_two_processes() -> None:
    scenario, given = Scenario.loads(FEW_GOALS), {"controllers": LATE}
    alone = ae.replicate(scenario, 4, seed=3, **given)  # type: ignore[arg-type]
    half = partial(ae.replicate, scenario, 2, 3, None, **given)  # type: ignore[arg-type]
    with ProcessPoolExecutor(2, get_context("spawn")) as processes:
        halves = list(processes.map(half, (0, 2)))
    assert pa.concat_tables(halves) == alone
    bundled = ae.replicate(scenario, 4, seed=3, controllers={"base": ae.Controller})
    assert bundled == ae.replicate(scenario, 4, seed=3) != alone


def test_a_failed_controller_of_ones_own_is_silent() -> None:
    steps: list[float | None] = []

    class Counted(ae.Controller):
        def step(self, percept: Percept) -> Any:
            steps.append(percept["time_s"])
            return super().step(percept)

    simulation = Simulation(Scenario.loads(FEW_GOALS), 7, controllers={"base": Counted})
    simulation.step(10)
    simulation.fail("base/0")
    simulation.step(10)
    assert len(steps) == 10


class Broken(NoController):
    """Returns what is no command, and raises errors, by the time."""

    def step(self, percept: Percept) -> Any:
        """Return a command that is wrong after a second."""
        time_s = percept["time_s"] or 0
        if time_s >= 2:
            raise ZeroDivisionError
        return {"motion": {"speed_m_s": "fast"}} if time_s >= 1 else {}


def test_what_a_controller_of_ones_own_returns_is_checked_and_a_failure_changes_nothing() -> None:
    simulation = Simulation(Scenario.loads(FEW_GOALS), 7, controllers={"base": Broken})
    with pytest.raises(InputError, match=r'^controllers\."base/0"\.step\(\)\.motion\.speed_m_s'):
        simulation.finish()
    before = simulation.hash, simulation.tick
    with pytest.raises(InputError):
        simulation.step()
    assert (simulation.hash, simulation.tick) == before


def test_an_exception_of_a_controller_names_it() -> None:
    class Failing(Broken):
        def step(self, percept: Percept) -> Any:
            return super().step({**percept, "time_s": 2})

    simulation = Simulation(Scenario.loads(FEW_GOALS), 7, controllers={"base": Failing})
    with pytest.raises(ZeroDivisionError) as caught:
        simulation.step()
    assert caught.value.__notes__ == ["in the controller base/0, at 0 s"]
    wrong: Any = {"base": lambda: None}
    with pytest.raises(TypeError) as caught_while_making:
        Simulation(Scenario.loads(FEW_GOALS), controllers=wrong)
    notes = caught_while_making.value.__notes__
    assert notes == ["while making the controller base/0 from its settings"]


ERRORS = [
    (
        {"brains": {"base": ae.Controller}},
        "brains = 'base': must be one of 'rover'; it is a kind of controllers: "
        "use controllers={'base': ...}",
    ),
    (
        {"controllers": {"rover": Ahead}},
        "controllers = 'rover': must be one of 'base', 'reserve'; it is a kind of robots: "
        "use brains={'rover': ...}",
    ),
    (
        {"controllers": {"bsae": ae.Controller}},
        "controllers = 'bsae': must be one of 'base', 'reserve'; did you mean 'base'?",
    ),
    (
        {"controllers": {7: ae.Controller}},
        "controllers = 7: must be a dict by the names of kinds of controllers",
    ),
    (
        {"controllers": {"base": 7}},
        "controllers.base = 7: must be a class or function that returns a controller when called "
        "with its settings",
    ),
    (
        {"controllers": {"base": ae.Batch(dict)}},  # type: ignore[arg-type]
        "controllers.base = Batch(function=<class 'dict'>): must be a class or function that "
        "returns a controller when called with its settings",
    ),
    (
        {"brains": {"base": 1, "rvoer": 2}, "controllers": {"rover": 3, "reserve": 4}},
        "brains = 'base': must be one of 'rover'; it is a kind of controllers: "
        "use controllers={'base': ...}\n"
        "brains = 'rvoer': must be one of 'rover'; did you mean 'rover'?\n"
        "controllers = 'rover': must be one of 'base', 'reserve'; it is a kind of robots: "
        "use brains={'rover': ...}\n"
        "controllers.reserve = 4: must be a class or function that returns a controller when "
        "called with its settings",
    ),
]


@pytest.mark.parametrize(("given", "expected"), ERRORS)
def test_invalid_controllers_are_named_all_at_once(given: Any, expected: str) -> None:
    scenario = Scenario.loads(TWO_KINDS)
    for call in (Simulation, ae.run, partial(ae.replicate, runs=1), study.make_plan):
        with pytest.raises(InputError) as caught:
            call(scenario, **given)
        assert str(caught.value) == expected
        assert [each["message"] for each in caught.value.errors] == expected.split("\n")


def test_an_object_without_a_step_is_no_controller() -> None:
    given: Any = {"controllers": {"base": NoController}}
    expected = r"controllers\.base = .*: must be a class or function that returns objects with a"
    with pytest.raises(InputError, match=expected):
        Simulation(Scenario.loads(FEW_GOALS), **given)
    plan = study.make_plan(Scenario.loads(FEW_GOALS), runs=2, **given)
    with pytest.raises(StudyError, match=f"configuration 0, run 0: InputError: {expected}"):
        study.run(Scenario.loads(FEW_GOALS), runs=2, compute=plan.engine, **given)


def test_scenarios_without_controllers_take_none() -> None:
    none = "controllers = 'base': must be left out: the scenario has no controllers$"
    with pytest.raises(InputError, match=none):
        Simulation("search", controllers={"base": ae.Controller})
    with pytest.raises(InputError, match="controllers = .*classic robots have no controllers"):
        study.make_plan(Scenario.load("classic"), controllers={"base": ae.Controller})


def test_a_controller_of_ones_own_is_studied_like_that_of_the_scenario(tmp_path: Path) -> None:
    given: Any = {"vary": {"robots.rover.count": "1..2"}, "runs": 4, "seed": 3}
    scenario, folder = Scenario.loads(FEW_GOALS), tmp_path / "python"
    study.run(scenario, **given, out=tmp_path / "rust")
    answer = study.run(scenario, **given, out=folder, controllers={"base": ae.Controller})
    assert rows(folder) == rows(tmp_path / "rust")
    (agents,) = answer.agents
    assert agents.parameter == "controllers"
    assert agents.names == {"base": "agent_economy.runs.controller:Controller"}
    report = (folder / "report.html").read_text("utf-8")
    assert "base = agent_economy.runs.controller:Controller; source " in report
    assert study.resume(folder).agents == answer.agents
    written = [
        json.loads((tmp_path / each / "answer.json").read_text()) for each in ("python", "rust")
    ]
    assert written[0].pop("agents") == [asdict(agents)]
    assert written[0] == written[1]


def test_a_requirement_is_met_with_the_controllers_of_ones_own() -> None:
    given: Any = {"require": "time_s <= 45", "probability": 0.6, "tolerance": 0.3}
    scenario, vary = Scenario.loads(FEW_GOALS), {"robots.rover.count": "1..2"}
    plain, same, late = (
        study.run(scenario, vary=vary, **given, controllers=each)
        for each in (None, {"base": ae.Controller}, LATE)
    )
    assert (same.sentence, same.runs) == (plain.sentence, plain.runs)
    assert late.sentence != plain.sentence
    assert [each.parameter for each in late.agents] == ["controllers"]


def test_a_study_with_another_controller_is_another_study(tmp_path: Path) -> None:
    scenario, given = Scenario.loads(FEW_GOALS), {"runs": 2, "out": tmp_path / "study"}
    study.run(scenario, **given, controllers={"base": ae.Controller})  # type: ignore[arg-type]
    before = rows(tmp_path / "study")
    for other in ({"base": Late}, "example_controllers:LATE", None):
        with pytest.raises(InputError, match="contains another study") as caught:
            study.run(scenario, **given, controllers=other)  # type: ignore[arg-type]
        assert "existing: controllers.names.base = 'agent_economy.runs." in str(caught.value)
    assert rows(tmp_path / "study") == before
    late = study.run(scenario, runs=2, out=tmp_path / "late", controllers=LATE)
    assert rows(tmp_path / "late") != before
    assert [str(each) for each in late.agents] == ["base = example_controllers:Late"]


def test_the_page_does_not_replay_runs_with_controllers_in_python(tmp_path: Path) -> None:
    study.run(Scenario.loads(FEW_GOALS), runs=2, out=tmp_path / "late", controllers=LATE)
    with pytest.raises(InputError, match=r"\(base = .*:Late\), .*Simulation\(\.\.\., controllers="):
        Workspace(tmp_path).member("late", 0)


def test_the_command_studies_controllers_of_a_module(tmp_path: Path) -> None:
    (tmp_path / "few.toml").write_text(FEW_GOALS, "utf-8")
    code = "import agent_economy as ae\nMINE = {'base': ae.Controller}\n"
    (tmp_path / "mine.py").write_text(code, "utf-8")
    given = ("study", "few.toml", "--controllers", "mine:MINE", "--runs", "2")
    done = run_process(*given, "--out", "study", "--workers", "2", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "with the controllers base = mine:MINE.base" in done.stderr
    refused = run_process(*given, "--brains", "mine:MINE", cwd=tmp_path)
    assert refused.returncode == 2
    assert "use controllers={'base': ...}" in refused.stderr
    refused = run_process("study", "--resume", "study", "--controllers", "mine:MINE", cwd=tmp_path)
    assert "--resume: cannot be combined with --controllers" in refused.stderr


def test_runs_with_controllers_in_python_have_no_snapshots() -> None:
    mine = Simulation(Scenario.loads(FEW_GOALS), controllers={"base": ae.Controller})
    with pytest.raises(InputError, match=r"snapshot: .* in Python = \['base'\]: must be none"):
        mine.snapshot()

"""Studies with brains in Python: the same runs, stored, resumed and tightened."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from command_line import COMMAND, refuse, run_process
from example_brains import AHEAD, SMALL, Bumper, Talker

from agent_economy import InputError, Scenario, study
from agent_economy.study.user_code import source_hash

TEAMS = {"robots.bumper.count": "2..4"}
SHORT = SMALL.replace("time_limit_s = 60", "time_limit_s = 12")
CODE = """
import turns

class Turner:
    def __init__(self, body):
        self.body = body

    def step(self, percept):
        turns.check(percept)
        return {"motion": {"speed_m_s": self.body["max_speed_m_s"], "turn_rate_rad_s": turns.RATE}}

BRAINS = {"bumper": Turner}

def twice(percepts, memory):
    return {"motion": {"speed_m_s": 0.3, "turn_rate_rad_s": 0.2}}

IN_BATCH = {"bumper": __import__("agent_economy").Batch(twice)}
"""
TURNS = """
RATE = 0.2

def check(percept):
    pass
"""
COUNTING = """
import os, pathlib, time

RATE = 0.2

def check(percept):
    own = pathlib.Path(f"process-{os.getpid()}")
    if not own.exists():
        own.touch()
        time.sleep(2)  # one process could make all runs before another has begun
"""
FAILING = TURNS.replace("    pass", "    1 / (5 - percept['time_s'])")


def rows(folder: Path) -> list[tuple[object, ...]]:
    """Return all runs of a study, in order."""
    return study.open(folder).runs().order("configuration, run").fetchall()


@pytest.fixture
def code(tmp_path: Path) -> Path:
    """Return a folder with a scenario, a module with brains, and a module that it imports."""
    (tmp_path / "my_brains.py").write_text(CODE, "utf-8")
    (tmp_path / "turns.py").write_text(TURNS, "utf-8")
    text = SHORT + '[study]\nvary = { "robots.bumper.count" = "2..4" }\n'
    (tmp_path / "small.toml").write_text(text, "utf-8")
    return tmp_path


def command(code: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run a study as a user does."""
    return run_process("study", *arguments, cwd=code)


def test_a_brain_in_python_that_decides_alike_has_the_same_runs_on_any_workers(
    tmp_path: Path,
) -> None:
    given: Any = {"vary": TEAMS, "runs": 8, "seed": 3}
    scenario = Scenario.loads(SHORT)
    study.run(scenario, **given, out=tmp_path / "rust")
    answer = study.run(scenario, **given, out=tmp_path / "python", brains={"bumper": Bumper})
    assert rows(tmp_path / "python") == rows(tmp_path / "rust")
    (agents,) = answer.agents
    assert (agents.parameter, agents.names) == ("brains", {"bumper": "example_brains:Bumper"})
    assert "example_brains:Bumper" in (tmp_path / "python/report.html").read_text("utf-8")
    # The same in one process, and by other numbers of workers.
    plan = study.load_plan(tmp_path / "python")
    study.run_plan(plan, tmp_path / "one", compute=plan.engine)
    with plan.engine.in_processes(3) as workers:
        study.run_plan(plan, tmp_path / "three", compute=workers.columns)
    for name in ("one", "three"):
        assert rows(tmp_path / name) == rows(tmp_path / "python")
        same = (tmp_path / name / "answer.json").read_bytes()
        assert same == (tmp_path / "python/answer.json").read_bytes()


def test_a_study_with_brains_uses_all_processors(code: Path) -> None:
    (code / "turns.py").write_text(COUNTING, "utf-8")
    given = ("small.toml", "--brains", "my_brains:BRAINS", "--runs", "12", "--out", "study")
    assert command(code, *given).returncode == 0
    assert len(list(code.glob("process-*"))) == os.cpu_count()


def test_a_killed_study_resumes_with_its_brains_and_ends_with_the_same_bytes(code: Path) -> None:
    given = ("small.toml", "--brains", "my_brains:BRAINS", "--runs", "40")
    assert command(code, *given, "--out", "whole").returncode == 0
    process = subprocess.Popen(
        [*COMMAND, "study", *given, "--out", "killed", "--workers", "2"],
        cwd=code,
        stderr=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    staged = code / "killed/staging.runs"
    deadline = time.monotonic() + 60
    while not (staged.exists() and staged.stat().st_size > 0) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not (code / "killed/answer.json").exists()
    assert command(code, "--resume", "killed").returncode == 0
    for name in ("answer.json", "study.toml"):
        assert (code / "killed" / name).read_bytes() == (code / "whole" / name).read_bytes()
    assert rows(code / "killed") == rows(code / "whole")


def test_runs_of_changed_code_are_never_mixed(code: Path) -> None:
    given = ("small.toml", "--brains", "my_brains:BRAINS", "--delta", "0.5")
    assert command(code, *given, "--out", "study").returncode == 0
    before = rows(code / "study")
    (code / "turns.py").write_text(TURNS.replace("0.2", "0.3"), "utf-8")
    # In an imported module, too.
    refused = command(code, *given, "--out", "study")
    assert refused.returncode == 2
    assert "contains another study" in refused.stderr
    assert "source = " in refused.stderr
    # What is finished stays readable; what needs more runs is refused.
    assert command(code, "--resume", "study").returncode == 0
    refused = command(code, "--resume", "study", "--confidence", "0.9999999")
    assert refused.returncode == 2
    assert re.search(r"the source of bumper = my_brains:BRAINS.bumper has changed", refused.stderr)
    assert rows(code / "study") == before
    (code / "turns.py").write_text(TURNS, "utf-8")
    assert command(code, "--resume", "study", "--confidence", "0.9999999").returncode == 0
    after = rows(code / "study")
    assert len(after) > len(before)
    assert set(before) <= set(after)


def test_a_failing_brain_ends_the_study_with_its_place_and_keeps_the_runs(code: Path) -> None:
    (code / "turns.py").write_text(FAILING, "utf-8")
    given = ("small.toml", "--brains", "my_brains:BRAINS", "--runs", "20", "--out", "study")
    failed = command(code, *given)
    assert failed.returncode == 1
    assert re.search(
        r"configuration \d, run \d+, in the brain of bumper/0, at 5 s: "
        r"ZeroDivisionError: .*turns\.py:5\)",
        failed.stderr,
    )
    assert "Traceback" not in failed.stderr


def test_a_batch_is_studied_too(code: Path) -> None:
    given = ("small.toml", "--brains", "my_brains:IN_BATCH", "--runs", "3", "--out", "study")
    done = command(code, *given)
    assert done.returncode == 0, done.stderr
    assert "with the brains bumper = my_brains:IN_BATCH.bumper" in done.stderr


def test_brains_of_a_script_resume_from_the_command_line(code: Path) -> None:
    script = CODE.replace("BRAINS =", "GIVEN =") + (
        "\nif __name__ == '__main__':\n"
        "    from agent_economy import Batch, study\n"
        "    given = {'runs': 3, 'out': 'study'}\n"
        "    study.run('small.toml', **given, brains={'bumper': Turner})\n"
        "    given = {'runs': 3, 'out': 'batch'}\n"
        "    study.run('small.toml', **given, brains={'bumper': Batch(twice)})\n"
    )
    (code / "my_script.py").write_text(script, "utf-8")
    done = subprocess.run(
        [sys.executable, "my_script.py"], cwd=code, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    plans = [study.load_plan(code / name) for name in ("study", "batch")]
    assert [str(*each.engine.agents) for each in plans] == [
        "bumper = my_script:Turner",
        "bumper = Batch(my_script:twice)",
    ]
    (code / "study/answer.json").unlink()
    resumed = command(code, "--resume", "study")
    assert resumed.returncode == 0, resumed.stderr


def test_brains_that_other_processes_cannot_import_are_refused() -> None:
    class Local(Bumper):
        pass

    scenario = Scenario.loads(SHORT)
    made: Any
    for made in (Local, lambda _: AHEAD):
        with pytest.raises(InputError, match=r"brains.bumper = .*at the top level of a module"):
            study.make_plan(scenario, brains={"bumper": made})
    code = (
        "from agent_economy import study\n"
        "class Mine:\n"
        "    def __init__(self, body): pass\n"
        "    def step(self, percept): return {}\n"
        "study.run('search', brains={'rover': Mine})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "which is not a file, as in an interactive session" in done.stderr


@pytest.mark.parametrize(
    ("brains", "error"),
    [
        ({"rover": Bumper}, "brains = 'rover': must be one of 'bumper'"),
        ({"bumper": 3}, r"brains\.bumper = 3: must be a Batch, or a class"),
        ("example_brains:NONE", r"the module example_brains \(.*\) has no NONE"),
        ("example_brains:SMALL", r"brains: example_brains:SMALL = .*must be a dict by the names"),
        ("no_such_module:BRAINS", "there is no module no_such_module"),
        ("example_brains", "must be MODULE:NAME"),
        (3, r"brains = 3: must be a dict .*or MODULE:NAME"),
    ],
)
def test_invalid_brains_are_refused_before_any_run(brains: Any, error: str) -> None:
    with pytest.raises(InputError, match=error):
        study.make_plan(Scenario.loads(SHORT), brains=brains)


def test_classic_robots_have_no_brains() -> None:
    with pytest.raises(InputError, match="brains = .*classic robots have no brains"):
        study.make_plan(Scenario.load("classic"), brains={"bumper": Bumper})
    assert "--brains" in refuse("study", "--resume", "nothing", "--brains", "example_brains:X")


def test_plans_without_brains_keep_their_identity() -> None:
    plan = study.make_plan(Scenario.loads(SHORT).replace("study.vary", TEAMS), runs=3)
    assert "brains" not in plan.text()
    other = study.make_plan(
        Scenario.loads(SHORT).replace("study.vary", TEAMS), runs=3, brains={"bumper": Talker}
    )
    assert other.identity != plan.identity


def source_of(folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, **files: str) -> str:
    """Return the hash of a module, of files given by path with __ for /."""
    for place, text in files.items():
        path = folder / f"{place.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    monkeypatch.syspath_prepend(folder)
    for module in [each for each in sys.modules if each.partition(".")[0] in ("own", "first")]:
        del sys.modules[module]
    return source_hash("brains", [name])


@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("own.brains", {"own__brains": "from .helper import X", "own__helper": "X = 1"}),
        ("own.sub.brains", {"own__sub__brains": "from ..helper import X", "own__helper": "X = 1"}),
        ("own", {"own": "def f():\n    from other_of_own import X", "other_of_own": "X = 1"}),
        ("own", {"own": "from first.second import helper", "first__second__helper": "X = 1"}),
        ("own", {"own": "import first.second.helper", "first__second__helper": "X = 1"}),
    ],
)
@pytest.mark.parametrize("with_init", [False, True])
def test_the_hash_covers_what_a_module_imports_from_any_kind_of_package(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    files: dict[str, str],
    with_init: bool,  # noqa: FBT001  (a case)
) -> None:
    if with_init:
        # Also beside the module: the folder is that of a package, too.
        for folder in (tmp_path, *(tmp_path / place for place in ("own", "own/sub", "first"))):
            folder.mkdir(exist_ok=True)
            (folder / "__init__.py").touch()
    if (tmp_path / "own").is_dir() and name == "own":
        (tmp_path / "own/__init__.py").unlink()
    first = source_of(tmp_path, monkeypatch, name, **files)
    assert source_of(tmp_path, monkeypatch, name, **files) == first
    changed = {place: text.replace("X = 1", "X = 2") for place, text in files.items()}
    assert source_of(tmp_path, monkeypatch, name, **changed) != first


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("raise ValueError('boom')", r"ValueError: boom \(.*faulty\.py:1\)"),
        ("def f(:", "SyntaxError: .*faulty.py, line 1"),
        ("import no_such_thing", "ModuleNotFoundError: No module named 'no_such_thing'"),
        ("import sys; sys.exit('bye')", "SystemExit: bye"),
    ],
)
def test_a_module_that_cannot_be_imported_is_refused_in_one_line(
    code: Path, text: str, error: str
) -> None:
    (code / "faulty.py").write_text(text, "utf-8")
    refused = command(code, "small.toml", "--brains", "faulty:BRAINS")
    assert refused.returncode == 2
    assert re.fullmatch(
        f"brains = 'faulty:BRAINS': .*cannot be imported: {error}.*\n", refused.stderr
    )


def test_what_brains_print_and_how_they_end_does_not_look_like_an_answer(code: Path) -> None:
    (code / "turns.py").write_text(TURNS.replace("pass", "print('hello')"), "utf-8")
    given = ("small.toml", "--brains", "my_brains:BRAINS", "--runs", "2", "--json")
    done = command(code, *given, "--out", "printing")
    assert done.returncode == 0
    assert json.loads(done.stdout)["runs"] == 6
    assert "hello" in done.stderr
    (code / "turns.py").write_text(TURNS.replace("pass", "raise SystemExit(0)"), "utf-8")
    failed = command(code, *given, "--out", "exiting")
    assert failed.returncode == 1
    assert re.search(r"in the brain of bumper/0|SystemExit: 0 .*turns\.py:5", failed.stderr)


def test_modules_of_the_working_folder_replace_no_other_module(code: Path) -> None:
    (code / "random.py").write_text("raise ValueError('not this one')", "utf-8")
    # `python -m` puts the working folder first, the command does not.
    program = [str(Path(sys.executable).with_name("agent-economy")), "study", "small.toml"]
    for brains in ([], ["--brains", "my_brains:BRAINS"]):
        given = [*program, "--runs", "2", "--workers", "1", "--out", f"study{len(brains)}", *brains]
        done = subprocess.run(given, cwd=code, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr

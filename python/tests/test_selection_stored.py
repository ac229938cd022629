"""A selection for any function keeps its runs in a folder."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import slow_sampler
from command_line import run_python

from agent_economy import InputError, study
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.workspace import Workspace
from agent_economy.study import Selection, select_best
from agent_economy.study.arguments import Floats
from agent_economy.study.sampling.sampler import LANE, Sampler
from agent_economy.study.selection import Integers

SHARES = np.array([0.3, 0.5, 0.55, 0.4])

CPUS = os.cpu_count() or 1


class Counted:
    """A sampler that counts its runs, and can fail."""

    def __init__(self) -> None:
        """Start without runs, and do not fail."""
        self.runs: list[tuple[int, int]] = []
        self.fails_after: float = np.inf
        self.error: BaseException = ZeroDivisionError()

    def __call__(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        """Return merits of 0 and 1."""
        if len(self.runs) > self.fails_after:
            raise self.error
        numbers = range(first_run, first_run + runs)
        self.runs += [(each, run) for each in configurations.tolist() for run in numbers]
        return merits(configurations, first_run, runs)

    method = __call__


def merits(configurations: Integers, first_run: int, runs: int, better: float = 0) -> Floats:
    """Return merits of 0 and 1; run r of all configurations shares its uniform number."""
    uniforms = np.random.Generator(np.random.PCG64(7).advance(first_run)).random(runs)
    return (uniforms < SHARES[configurations][:, np.newaxis] + better).astype(np.float64)


def selected(sampler: Sampler, out: Path | None = None, **changes: Any) -> Selection:
    """Return a selection of a sampler."""
    arguments: dict[str, Any] = {"k": 4, "bounds": (0, 1), "delta": 0.02, **changes}
    return select_best(sampler, out=out, **arguments)


def stored(folder: Path) -> set[tuple[int, int]]:
    """Return the configuration and number of each stored run."""
    return set(study.open(folder).runs().project("configuration, run").fetchall())


def test_a_selection_that_is_killed_continues_and_computes_no_stored_run_again(
    tmp_path: Path,
) -> None:
    folder, logs = tmp_path / "kept", [tmp_path / "one.log", tmp_path / "two.log"]

    def started(log: Path, run_s: float) -> "subprocess.Popen[str]":
        command = [sys.executable, slow_sampler.__file__, str(folder)]
        environment = {**os.environ, "LOG": str(log), "RUN_S": str(run_s)}
        return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)

    def computed(log: Path) -> list[tuple[int, int]]:
        lines = map(json.loads, log.read_text().splitlines())
        return [
            (each, first + run)
            for group, first, runs in lines
            for each in group
            for run in range(runs)
        ]

    with started(logs[0], 0.05) as process:
        give_up_s = time.monotonic() + 60
        while not (folder / "staging.runs").exists() and time.monotonic() < give_up_s:
            time.sleep(0.01)
        process.kill()
    assert process.returncode == -signal.SIGKILL
    kept = stored(folder)
    assert 0 < len(kept) < 40  # in the middle of the first round
    with started(logs[1], 0) as process:
        printed = process.communicate()[0]
    whole = slow_sampler.selected(None)
    assert printed.strip() == str(whole)
    again = computed(logs[1])
    assert kept.isdisjoint(again)
    assert len(again) == len(set(again)) == whole.runs.sum() - len(kept)
    assert kept <= set(computed(logs[0]))
    assert len(stored(folder)) == whole.runs.sum()


@pytest.mark.parametrize("common", [True, False])
@pytest.mark.parametrize("error", [KeyboardInterrupt(), ZeroDivisionError()])
def test_an_error_of_the_sampler_or_ctrl_c_loses_no_finished_run(
    tmp_path: Path, error: BaseException, common: Any
) -> None:
    changes = {"common_random_numbers": common, "seed": 3}
    sampler = Counted()
    sampler.fails_after, sampler.error = 60, error
    with pytest.raises(type(error)):
        selected(sampler, tmp_path, **changes)
    kept, computed = stored(tmp_path), len(sampler.runs)
    assert computed - 2 * CPUS <= len(kept) <= computed  # The others are of the call that failed.
    sampler.fails_after = np.inf
    assert selected(sampler, tmp_path, **changes) == selected(merits, **changes)
    again = [(each, run % LANE) for each, run in sampler.runs[computed:]]
    assert len(again) == len(set(again)) > 0
    assert kept.isdisjoint(again)
    assert stored(tmp_path) == kept.union(again)


def test_a_finished_selection_computes_nothing_and_another_question_only_what_is_missing(
    tmp_path: Path,
) -> None:
    sampler = Counted()
    first = selected(sampler, tmp_path, max_runs=100)
    done = len(sampler.runs)
    assert selected(sampler, tmp_path, max_runs=100) == first
    assert len(sampler.runs) == done == first.runs.sum() <= 100
    changes: list[dict[str, Any]] = [
        {},
        {"confidence": 0.999},
        {"delta": 0.01},
        {"guarantee": "pgs"},
        {"max_runs": 100},
    ]
    for change in changes:
        found = selected(sampler, tmp_path, **change)
        assert found == selected(merits, **change)
        assert len(sampler.runs) == len(set(sampler.runs)) >= found.runs.sum()
    assert selected(sampler, tmp_path, max_runs=100) == first


def other(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return the merits of another sampler."""
    return merits(configurations, first_run, runs)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"k": 3}, "existing: k = 4\n  requested: k = 3"),
        (
            {"bounds": (0, 2)},
            r"existing: bounds = \[0.0, 1.0\]\n  requested: bounds = \[0.0, 2.0\]",
        ),
        ({"bounds": [(0, 1)] * 3 + [(0.5, 1)]}, "the bounds of single configurations differ"),
        ({"seed": 1}, "existing: seed = 0\n  requested: seed = 1"),
        ({"common_random_numbers": False}, "common_random_numbers = True\n.*= False"),
        ({"sampler": other}, "sampler = 'test_selection_stored:merits'\n.*:other'"),
        ({"sampler": partial(merits, better=0.1)}, r"arguments = \[\]\n.*\['better=0.1'\]"),
        (
            {"sampler": lambda each, first, runs: merits(each, first, runs, 0.1)},
            ":merits'\n.*<lambda> in line",
        ),
    ],
)
def test_what_has_other_runs_is_refused_and_named(
    tmp_path: Path, change: dict[str, Any], words: str
) -> None:
    selected(merits, tmp_path, max_runs=40)
    before = (tmp_path / "study.toml").read_bytes()
    arguments = {"sampler": merits, "out": tmp_path, "max_runs": 40, **change}
    with pytest.raises(InputError, match=f"use another folder, or remove it\n  .*{words}"):
        selected(**arguments)
    assert (tmp_path / "study.toml").read_bytes() == before


SOURCE = """
import numpy as np
import helper

class Half:
    def __call__(self, configurations, first_run, runs):
        return np.full((len(configurations), runs), helper.VALUE)

    def method(self, configurations, first_run, runs):
        return self(configurations, first_run, runs)

def sample(configurations, first_run, runs):
    return Half()(configurations, first_run, runs)
"""

KINDS: list[Callable[[Any], Sampler]] = [
    lambda module: module.sample,
    lambda module: partial(module.sample),
    lambda module: module.Half(),
    lambda module: module.Half().method,
    lambda module: partial(module.Half().method),
]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("file", ["own_sampler.py", "helper.py"])
def test_a_sampler_whose_source_was_changed_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str, kind: Any
) -> None:
    (tmp_path / "own_sampler.py").write_text(SOURCE)
    (tmp_path / "helper.py").write_text("VALUE = 0.5\n")
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("own_sampler", "helper"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import own_sampler  # type: ignore[import-not-found]  # noqa: PLC0415

    sampler, folder = kind(own_sampler), tmp_path / "out"
    first = selected(sampler, folder, max_runs=40)
    assert selected(sampler, folder, max_runs=40) == first
    with (tmp_path / file).open("a") as text:
        text.write("\n# changed\n")
    with pytest.raises(InputError, match=r"the source of the sampler, .* was changed$"):
        selected(sampler, folder, max_runs=40)


INTERACTIVE = """
from agent_economy import InputError, study

def sample(configurations, first_run, runs):
    return [[0.5] * runs for _ in configurations]

sample.__module__ = {!r}
arguments = dict(bounds=(0, 1), delta=0.1, max_runs=40)
print(study.select_best(sample, 4, **arguments).best)
try:
    study.select_best(sample, 4, out={!r}, **arguments)
except InputError as error:
    print(error)
"""


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("__main__", "sampler: is defined in __main__, which is not a file"),
        (None, "sampler: is defined in builtins, which is not a file"),
        ("no_such_module", "sampler = 'no_such_module': there is no module no_such_module"),
    ],
)
def test_a_sampler_without_a_source_file_is_refused_only_with_a_folder(
    tmp_path: Path, module: str | None, words: str
) -> None:
    given = run_python(INTERACTIVE.format(module, str(tmp_path / "out")))
    best, error = given.stdout.splitlines()
    assert best == "0"
    assert error.startswith(words)
    assert not (tmp_path / "out").exists()


def rough(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return merits a little outside of their bounds; some are not finite."""
    numbers = np.arange(first_run, first_run + runs) % LANE
    found = np.where(configurations == 1, 1 + 1e-10, 0.25)[:, np.newaxis].repeat(runs, axis=1)
    found[configurations == 2] = np.where(numbers == 0, np.nan, 0.25)
    found[configurations == 3] = np.where(numbers % 2, -np.inf, 0.5)
    return found


def test_the_folder_is_read_as_that_of_a_study(tmp_path: Path) -> None:
    found = selected(rough, tmp_path, seed=7, delta=0.1)
    runs = study.open(tmp_path).runs()
    assert runs.columns == ["configuration", "run", "merit", "quarantined"]
    rows = runs.aggregate(
        "configuration, min(run), max(run) + 1, sum(quarantined::int), max(merit)"
    ).order("configuration")
    assert rows.fetchall() == [
        (each, 0, int(found.runs[each]), int(found.quarantined[each]), most)
        for each, most in enumerate([0.25, 1 + 1e-10, 0.25, 0.5])
    ]
    assert found.quarantined.sum() > 0
    assert found.mean[1] == 1
    assert (
        selected(rough, tmp_path, seed=7, delta=0.1) == found == selected(rough, seed=7, delta=0.1)
    )


def test_a_folder_of_a_selection_is_no_study(tmp_path: Path) -> None:
    folder = tmp_path / "studies" / "classic"
    found = selected(merits, folder)
    readers: list[Callable[[Path], object]] = [
        study.load_plan,
        study.resume,
        study.rebuild,
        study.load_answer,
        lambda place: study.run("classic", delta=0.3, out=place),
    ]
    for reader in readers:
        with pytest.raises(InputError, match="is a selection by select_best, not a study: "):
            reader(folder)
    workspace = Workspace(tmp_path)
    manager = StudyManager(workspace)
    assert manager.listed() == []
    with pytest.raises(InputError, match="must be the id of a study in the list"):
        manager.of("studies/classic")
    assert manager.id_of(study.make_plan(workspace.load("classic"))) != "studies/classic"
    assert selected(merits, folder) == found


def test_a_folder_of_a_study_is_no_selection(tmp_path: Path) -> None:
    vary = {"robots.wanderer.count": "1..2"}
    study.run("classic", vary=vary, runs=2, out=tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    with pytest.raises(InputError, match="contains a study, not a selection by select_best"):
        selected(merits, tmp_path)
    now = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert {path: now.get(path) for path in before} == before
    study.resume(tmp_path)
    assert (tmp_path / "answer.json").read_bytes() == before[tmp_path / "answer.json"]


@pytest.mark.parametrize("ending", ["[data", "", "format = 1"])
def test_a_damaged_folder_is_named(tmp_path: Path, ending: str) -> None:
    selected(merits, tmp_path, max_runs=40)
    question = (tmp_path / "study.toml").read_text().splitlines()[0]
    (tmp_path / "study.toml").write_text(f"{question}\n{ending}")
    with pytest.raises(InputError, match=r"its study.toml is damaged: restore it"):
        selected(merits, tmp_path, max_runs=40)


def test_a_folder_of_a_newer_version_is_refused(tmp_path: Path) -> None:
    selected(merits, tmp_path, max_runs=40)
    text = (tmp_path / "study.toml").read_text()
    (tmp_path / "study.toml").write_text(text.replace("format = 1", "format = 2"))
    with pytest.raises(InputError, match="format = 2: must be 1: update this program"):
        selected(merits, tmp_path, max_runs=40)


def test_a_merit_outside_of_its_bounds_is_an_error_and_not_stored(tmp_path: Path) -> None:
    def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
        return merits(configurations, first_run, runs) * (1 + (first_run > 0))

    with pytest.raises(InputError, match=r"had a merit of 2: must be from 0 to 1, its bounds"):
        selected(sample, tmp_path)
    assert study.open(tmp_path).runs().filter("merit > 1").fetchall() == []

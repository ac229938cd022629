"""Output names only files that were written."""

import re
from pathlib import Path
from typing import Any

import pytest
from command_line import run

from agent_economy.cli import answer_table
from agent_economy.study.engine import Engine
from agent_economy.study.run_block import Columns, RunBlock

TEAMS = ("--only-vary", "--vary", "robots.wanderer.count=1..6")
REQUIRED = ("--require", "time_s <= 60", "--probability", "0.7", "--tolerance", "0.1")
NAMED = re.compile(r"\S*(?:answer\.json|report\.html)")


@pytest.fixture(autouse=True)
def short_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave configurations out of the table."""
    monkeypatch.setattr(answer_table, "MAX_ROWS", 1)


def interrupt_after(runs: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupt the study when some runs are computed."""
    compute, computed = Engine.__call__, [0]

    def interrupted(self: Engine, block: RunBlock) -> Columns:
        if computed[0] >= runs:
            raise KeyboardInterrupt
        computed[0] += block.rows
        return compute(self, block)

    monkeypatch.setattr(Engine, "__call__", interrupted)


def named(result: Any) -> set[str]:
    """Return the files that output names."""
    return set(NAMED.findall(result.stdout + result.stderr))


def test_a_finished_study_names_its_files(tmp_path: Path) -> None:
    result = run("study", "classic", *TEAMS, "--runs", "2", "--out", "made", cwd=tmp_path)
    assert result.returncode == 0
    assert named(result) == {"answer.json", "made/report.html"}
    assert (tmp_path / "made/answer.json").is_file()
    assert (tmp_path / "made/report.html").is_file()
    as_json = run("study", "--resume", "made", "--json", cwd=tmp_path)
    assert not named(as_json)


@pytest.mark.parametrize("question", [("--delta", "0.01"), REQUIRED])
@pytest.mark.parametrize("runs", [0, 60])
@pytest.mark.parametrize("form", [(), ("--json",)])
def test_a_stopped_study_names_no_answer(
    question: tuple[str, ...],
    runs: int,
    form: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    interrupt_after(runs, monkeypatch)
    result = run("study", "classic", *TEAMS, *question, *form, "--out", "made", cwd=tmp_path)
    assert result.returncode == 130
    assert not named(result)
    if question is REQUIRED and runs and not form:
        assert re.search("and [0-9] more *\n", result.stdout)
    assert "--resume made" in result.stderr
    assert (tmp_path / "made/study.toml").is_file()


def test_a_report_that_cannot_be_written_is_not_named_as_written(tmp_path: Path) -> None:
    (tmp_path / "made/report.html").mkdir(parents=True)
    result = run("study", "classic", *TEAMS, "--runs", "2", "--out", "made", cwd=tmp_path)
    assert result.returncode == 1
    assert result.stdout == ""
    assert "made/report.html: cannot be written (Is a directory)" in result.stderr
    assert not (tmp_path / "made/answer.json").exists()


def test_a_table_of_runs_that_cannot_be_written_is_not_named_as_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("agent_economy.whole_file.put_in_place", full)
    result = run("replicate", "classic", "--runs", "2", "--out", "runs.csv", cwd=tmp_path)
    assert result.returncode == 1
    assert result.stdout == ""
    assert result.stderr.endswith("runs.csv: cannot be written (No space left on device)\n")
    assert list(tmp_path.iterdir()) == []

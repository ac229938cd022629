"""The command line, as a user meets it."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

COMMAND = [sys.executable, "-m", "agent_economy"]


def run(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command and wait for it."""
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False
    )


def test_version_names_the_program() -> None:
    given = run("--version")
    assert given.returncode == 0
    assert given.stdout.startswith("agent-economy 0.")


@pytest.mark.parametrize("command", [["--help"], ["study", "--help"]])
def test_help_has_an_example(command: list[str]) -> None:
    given = run(*command)
    assert given.returncode == 0
    assert "Example: agent-economy study scenarios/classic.toml" in given.stdout.replace("\n", " ")


def test_study_prints_table_answer_and_path_and_leaves_its_files(
    classic_toml: Path, tmp_path: Path
) -> None:
    given = run("study", classic_toml, "--runs", "300", cwd=tmp_path)
    assert given.returncode == 0, given.stderr
    assert "behind best" in given.stdout
    assert "Send " in given.stdout
    assert "Report: studies/classic/report.html" in given.stdout
    assert "8 robots: 2,400 of 2,400 runs" in given.stderr
    left = sorted(file.name for file in (tmp_path / "studies/classic").iterdir())
    assert left == ["answer.json", "report.html", "runs.parquet"]


def test_options_go_before_the_file(classic_toml: Path, tmp_path: Path) -> None:
    options = ["--vary", "robots.wanderer.count=2,5", "--runs", "100", "--contact", "ahead"]
    more = ["--merit", "appendix", "--seed", "9", "--out", str(tmp_path / "here"), "--json"]
    given = run("study", classic_toml, *options, *more)
    assert given.returncode == 0, given.stderr
    answer = json.loads(given.stdout)
    assert [team["robots"] for team in answer["teams"]] == [2, 5]
    assert answer["scenario"]["contact"] == "ahead"
    assert answer["scenario"]["merit"]["name"] == "appendix"
    assert answer["teams"][0]["runs"] == 100
    assert answer["seed"] == 9
    assert answer == json.loads((tmp_path / "here/answer.json").read_text())


def test_the_same_seed_leaves_the_same_bytes(classic_toml: Path, tmp_path: Path) -> None:
    for folder in ("a", "b"):
        assert (
            run("study", classic_toml, "--runs", "50", "--out", tmp_path / folder).returncode == 0
        )
    for name in ("answer.json", "report.html", "runs.parquet"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--contact", "nose"], '--contact: contact = "nose": must be one of "neighbour"'),
        (
            ["--vary", "robots.wanderer.count=0"],
            "--vary: robots.wanderer.count = 0: must be a whole number from 1 to 250",
        ),
        (["--vary", "robots.wanderer.count=8..1"], "must be a text of values"),
        (["--merit", "time=-1,robot=-2"], "--merit: merit.robot = -2: must be one of the known"),
        (["--merit", "paints=-1"], "--merit: merit.paints = -1: must be given a max"),
        (["--vary", "robots.rover.count=1..3"], "did you mean robots.wanderer.count?"),
        (["--vary", "8"], "--vary = '8': must be PATH=VALUES"),
        (
            ["--vary", "robots.wanderer.count=1", "--vary", "robots.wanderer.count=2"],
            "--vary robots.wanderer.count: is given twice",
        ),
        (["--runs", "-5"], "--runs: study.runs = -5: must be a whole number from 2"),
        (["--merit", "best"], '--merit: merit = "best": must be one of "equation-5.2", "appendix"'),
        (["--seed", "-1"], "Invalid value for '--seed'"),
        (["--runs", "many"], "Invalid value for '--runs'"),
    ],
)
def test_bad_options_are_told_and_leave_nothing(
    options: list[str], part: str, classic_toml: Path, tmp_path: Path
) -> None:
    given = run("study", classic_toml, *options, cwd=tmp_path)
    assert given.returncode == 2
    assert part in " ".join(given.stderr.replace("│", " ").split())
    assert "Traceback" not in given.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_missing_scenario_is_told(tmp_path: Path) -> None:
    given = run("study", "none.toml", cwd=tmp_path)
    assert given.returncode == 2
    assert given.stderr.strip() == "none.toml: cannot be read: No such file or directory"


def test_an_output_folder_that_cannot_be_is_told_before_any_run(
    classic_toml: Path, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder")
    given = run("study", classic_toml, "--out", tmp_path / "file")
    assert given.returncode == 2
    assert "must be a folder to write in" in given.stderr
    assert "runs/s" not in given.stderr


def test_a_folder_where_a_file_belongs_is_told_before_any_run(
    classic_toml: Path, tmp_path: Path
) -> None:
    (tmp_path / "report.html").mkdir()
    given = run("study", classic_toml, "--out", tmp_path)
    assert given.returncode == 2
    assert "report.html in it is a folder" in given.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


def test_ctrl_c_ends_within_a_second_says_what_was_done_and_leaves_no_file(
    classic_toml: Path, tmp_path: Path
) -> None:
    options = ["--runs", "1000000", "--out", str(tmp_path / "out")]
    process = subprocess.Popen(
        [*COMMAND, "study", str(classic_toml), *options],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"FORCE_COLOR": "1"},
    )
    try:
        while not (tmp_path / "out").exists() and process.poll() is None:
            time.sleep(0.02)
        time.sleep(1.5)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        seconds = time.monotonic() - begin
    finally:
        process.kill()
    assert process.returncode == 130
    # The promise is one second; the bound allows for a busy machine.
    assert seconds < 3
    assert re.search(r"Stopped after [\d,]+ runs; nothing was written\.", errors)
    assert "Traceback" not in errors
    assert list((tmp_path / "out").iterdir()) == []


def test_ctrl_c_while_modules_load_leaves_no_traceback() -> None:
    interrupted_at_numpy = """
import sys

class CtrlC:
    def find_spec(self, name, *_):
        if name == "numpy":
            raise KeyboardInterrupt

sys.meta_path.insert(0, CtrlC())
from agent_economy.__main__ import main
main()
"""
    command = [sys.executable, "-c", interrupted_at_numpy]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert given.returncode == 130
    assert given.stderr == "\nStopped.\n"


def test_a_summary_is_text_and_not_markup(classic_toml: Path, tmp_path: Path) -> None:
    odd = tmp_path / "odd.toml"
    summary = "A [/oops] <b>test</b>"
    text = classic_toml.read_text()
    odd.write_text(text.replace("The 2003 experiment: four", f"{summary}: four"))
    given = run("study", odd, "--runs", "10", "--out", tmp_path / "out")
    assert given.returncode == 0, given.stderr
    assert summary in given.stdout
    assert "<b>test" not in (tmp_path / "out/report.html").read_text()


def test_any_encoding_of_the_terminal_will_do(classic_toml: Path, tmp_path: Path) -> None:
    environment = os.environ | {"PYTHONIOENCODING": "latin-1", "LC_ALL": "C"}
    command = [*COMMAND, "study", str(classic_toml), "--runs", "10", "--out", str(tmp_path)]
    given = subprocess.run(command, capture_output=True, env=environment, check=False, timeout=60)
    assert given.returncode == 0, given.stderr


def test_a_study_that_is_killed_leaves_the_last_ones_files_whole(
    classic_toml: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    assert run("study", classic_toml, "--runs", "50", "--out", out).returncode == 0
    before = {file.name: file.read_bytes() for file in out.iterdir()}
    options = ["--runs", "1000000", "--seed", "1", "--out", str(out)]
    process = subprocess.Popen([*COMMAND, "study", str(classic_toml), *options])
    time.sleep(1.5)
    process.kill()
    process.wait(timeout=20)
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before

"""The command line: its output, files and exit codes."""

import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from command_line import COMMAND, refuse, run, run_process, run_python, succeed

from agent_economy import cli


def test_version_names_the_program() -> None:
    given = run_process("--version")
    assert given.returncode == 0
    assert re.fullmatch(r"agent-economy 0\.[\d.]+ \((release|fast|dev) build\)\n", given.stdout)
    assert run("--version").stdout == given.stdout


@pytest.mark.parametrize(
    ("command", "unloaded"),
    [
        ("--version", ["typer", "numpy"]),
        ("--help", ["rich", "numpy"]),
        ("run search", ["agent_economy.study", "pandas"]),
        ("run classic --record run.mcap", ["agent_economy.study", "pandas"]),
        ("replicate search --runs 10 --out runs.parquet", ["pandas"]),
        ("study classic --runs 100", ["altair", "pandas"]),
    ],
)
def test_commands_load_only_what_they_need(
    command: str, unloaded: list[str], tmp_path: Path
) -> None:
    program = f"""
import atexit, sys
sys.argv[1:] = {command.split()!r}
atexit.register(lambda: print([name for name in {unloaded!r} if name in sys.modules]))
from agent_economy.__main__ import main
main()
"""
    given = run_python(program, cwd=tmp_path, check=True)
    assert given.stdout.splitlines()[-1] == "[]"


def test_each_command_is_listed_with_its_description() -> None:
    listed = run("--help").stdout
    for name, description in cli.COMMANDS.items():
        assert re.search(rf"^  {name} +{re.escape(description)}$", listed, re.MULTILINE)
        assert cli.load(name).name == name


@pytest.mark.parametrize(
    "command",
    [None, *cli.COMMANDS],
)
def test_help_has_an_example(command: str | None) -> None:
    given = run(*filter(None, [command]), "--help")
    assert given.returncode == 0
    assert "Example: agent-economy " in given.stdout.replace("\n", " ")
    assert "Exit codes" in given.stdout or command is None


def test_study_prints_table_answer_and_path_and_leaves_its_files(
    classic_toml: Path, tmp_path: Path
) -> None:
    given = run_process("study", classic_toml, "--delta", "0.3", cwd=tmp_path)
    assert given.returncode == 0, given.stderr
    for part in ("behind", "best", "Send", "with 95% confidence", "Report: studies/classic/"):
        assert part in " ".join(given.stdout.split())
    assert "8 configurations; delta 0.3, confidence 0.95, indifference" in given.stderr
    assert re.search(r"round \d+: [\d,]+ runs, \d of 8 remaining.*; eliminated: ", given.stderr)
    left = {file.name for file in (tmp_path / "studies/classic").iterdir()}
    assert left >= {"answer.json", "report.html", "study.toml", "ledger.sqlite", "blocks"}


def test_options_replace_values_of_the_file(classic_toml: Path, tmp_path: Path) -> None:
    options = ["--vary", "robots.wanderer.count=2,5", "--runs", "100", "--set", "contact=ahead"]
    more = ["--merit", "appendix", "--seed", "9", "--out", str(tmp_path / "here"), "--json"]
    given = succeed("study", classic_toml, *options, *more)
    answer = json.loads(given.stdout)
    assert [each["values"] for each in answer["results"]] == [
        {"robots.wanderer.count": 2},
        {"robots.wanderer.count": 5},
    ]
    assert ["contact", "ahead"] in answer["scenario"]["facts"]
    assert answer["scenario"]["merit"]["name"] == "appendix"
    assert answer["results"][0]["runs"] == 100
    assert answer["seed"] == 9
    assert given.stdout == (tmp_path / "here/answer.json").read_text()


def test_a_value_of_set_replaces_the_files_and_is_stored(
    classic_toml: Path, tmp_path: Path
) -> None:
    options = ["--set", "clock.time_limit_s=60", "--set", "study.vary.robots.wanderer.count=2,3"]
    given = succeed("study", classic_toml, *options, "--runs", "20", "--json", "--out", tmp_path)
    answer = json.loads(given.stdout)
    assert answer["scenario"]["time_limit_s"] == 60
    assert [each["label"] for each in answer["results"]] == ["2 wanderers", "3 wanderers"]
    again = run("study", "--resume", tmp_path, "--json")
    assert again.stdout == given.stdout


def test_check_reports_valid_scenarios(classic_toml: Path, tmp_path: Path) -> None:
    given = run("check", classic_toml, "classic", cwd=tmp_path)
    assert (given.returncode, given.stderr) == (0, "")
    right = "valid: engine classic, factorial: 8 configurations"
    assert given.stdout.splitlines() == [f"{classic_toml}: {right}", f"classic: {right}"]
    listed = run("check", classic_toml, "--json")
    assert (listed.returncode, json.loads(listed.stdout)) == (0, [])
    assert list(tmp_path.iterdir()) == []


def test_check_prints_how_long_a_round_takes_and_when_lost_goals_are_offered_again() -> None:
    lines = succeed("check", "waypoints").stdout.splitlines()
    (line,) = [line for line in lines if line.startswith("    controllers.base: ")]
    assert "after an award, the next waits at most 0.60 s" in line
    assert "open goals have an owner or are reported" in line


def test_check_reports_all_errors_of_all_files(classic_toml: Path, tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text(classic_toml.read_text().replace("count = 4", "cuont = 4"))
    wide = tmp_path / "wide.toml"
    wide.write_text(
        classic_toml.read_text().replace('"1..8"', '"1..250", "clock.time_limit_s" = "1..1000"')
    )
    files = [bad, tmp_path / "none.toml", classic_toml, wide]
    given = run("check", *files, "--set", "study.delta=0.5")
    assert given.returncode == 2
    assert given.stdout.count("valid: ") == 1
    lines = given.stderr.splitlines()
    assert lines[0].startswith(f"{bad}:18: robots.wanderer.cuont is not a known key: expected")
    missing = f"{bad}:17: robots.wanderer.count is missing: expected a whole number"
    assert lines[1].startswith(missing)
    assert lines[2] == f"{tmp_path}/none.toml: cannot be read: No such file or directory"
    assert "250 x 1000 values = 250000 configurations: must be at most 100000" in lines[3]
    assert len(lines) == 4
    listed = run("check", *files, "--json")
    assert listed.returncode == 2
    errors_of = json.loads(listed.stdout)
    assert [error["file"] for error in errors_of] == list(map(str, [bad, bad, files[1], wide]))
    assert errors_of[0] == {
        "severity": "error",
        "origin": f"{bad}:18",
        "file": str(bad),
        "line": 18,
        "path": "robots.wanderer.cuont",
        "value": "4",
        "allowed": "one of count",
        "suggestion": "count",
        "message": lines[0],
    }


def test_bundled_scenarios_are_listed_and_valid(tmp_path: Path) -> None:
    given = succeed("scenarios", cwd=tmp_path)
    rows = json.loads(run("scenarios", "--json", cwd=tmp_path).stdout)
    engines = {row["name"]: row["engine"] for row in rows}
    assert {"bender": "metric", "classic": "classic"}.items() <= engines.items()
    for line, row in zip(given.stdout.splitlines(), rows, strict=True):
        assert line.split(maxsplit=2) == [row["name"], row["engine"], row["summary"]]
        assert Path(row["file"]).is_file()
    succeed("check", *(row["name"] for row in rows), cwd=tmp_path)


def test_weights_on_the_command_line_define_the_merit(classic_toml: Path, tmp_path: Path) -> None:
    weights = ["--merit", "time=-0.03,robots=-0.2,failed=-5", "--json", "--runs", "20"]
    given = run("study", classic_toml, *weights, "--out", tmp_path / "a")
    named = run("study", classic_toml, "--json", "--runs", "20", "--out", tmp_path / "b")
    one, two = (json.loads(each.stdout)["results"] for each in (given, named))
    assert one == two


def test_the_same_seed_gives_the_same_bytes_with_any_workers(
    classic_toml: Path, tmp_path: Path
) -> None:
    where: dict[str, list[str]] = {"a": [], "b": ["--workers", "2"]}
    for folder, options in where.items():
        given = run("study", classic_toml, "--delta", "0.3", *options, "--out", tmp_path / folder)
        assert given.returncode == 0, given.stderr
    for name in ("answer.json", "report.html", "study.toml"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    a, b = (
        {block.name: block.read_bytes() for block in (tmp_path / folder / "blocks").iterdir()}
        for folder in "ab"
    )
    assert a == b


def test_a_finished_study_is_reported_watched_and_resumed_at_a_higher_confidence(
    classic_toml: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    succeed("study", classic_toml, "--delta", "0.3", "--out", out)
    before = (out / "answer.json").read_bytes()
    (out / "answer.json").unlink()
    (out / "report.html").unlink()

    answered = succeed("report", out, "--json")
    assert answered.stdout.encode() == before == (out / "answer.json").read_bytes()
    assert (out / "report.html").exists()

    watched = succeed("watch", out)
    assert "1 of 8 remaining" in watched.stderr
    assert watched.stdout == "The study is finished.\n"

    tightened = succeed("study", "--resume", out, "--confidence", "0.999")
    assert "with 99.9% confidence" in " ".join(tightened.stdout.split())


def test_each_question_has_its_own_folder(classic_toml: Path, tmp_path: Path) -> None:
    questions: list[list[str]] = [[], ["--seed", "1"], [], ["--seed", "1"], ["--merit", "appendix"]]
    for options in questions:
        given = run("study", classic_toml, "--delta", "0.5", *options, cwd=tmp_path)
        assert given.returncode == 0, given.stderr
    # A different merit is a different question about the same runs.
    folders = sorted(folder.name for folder in (tmp_path / "studies").iterdir())
    assert len(folders) == 2
    assert folders[0] == "classic"
    assert re.fullmatch(r"classic-[0-9a-f]{8}", folders[1])


@pytest.mark.parametrize("option", [["--seed", "0"], ["--guarantee", "pgs"], ["--delta", "0"]])
def test_resume_reads_the_question_from_the_folder_only(option: list[str], tmp_path: Path) -> None:
    assert "--resume: cannot be combined with" in refuse("study", "--resume", tmp_path, *option)


@pytest.mark.parametrize("command", [["report"], ["watch"], ["study", "--resume"]])
def test_a_folder_without_a_study_is_an_error(command: list[str], tmp_path: Path) -> None:
    assert f"{tmp_path}" in refuse(*command, tmp_path)


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--set", "contact=nose"], '--set contact: contact = "nose": must be one of "neighbour"'),
        (["--set", "contact='nose'"], '--set contact: contact = "nose": must be one of'),
        (
            ["--set", "clock.time_limit_s=-5"],
            "--set clock.time_limit_s: clock.time_limit_s = -5: must be a number",
        ),
        (["--set", "clock.time_limit_s={a=1}"], "clock.time_limit_s = {...}: must be a number"),
        (["--set", "clock.caps=5"], "clock.caps is not a known key: expected one of"),
        (["--set", "clock.time_limit_s"], "--set = 'clock.time_limit_s': must be PATH=VALUE"),
        (
            ["--set", "clock.time_limit_s=1", "--set", "clock.time_limit_s=2"],
            "--set clock.time_limit_s: occurs twice: expected once",
        ),
        (
            ["--vary", "robots.wanderer.count=0"],
            "--vary: robots.wanderer.count = 0: must be a whole number from 1 to 250",
        ),
        (["--vary", "robots.wanderer.count=8..1"], "must be a string of values"),
        (["--merit", "time=-1,robot=-2"], "--merit: merit.robot is not a known key"),
        (["--merit", "paints=-1"], "--merit: merit.paints = -1: must be a table with a max"),
        (["--vary", "robots.rover.count=1..3"], "did you mean robots.wanderer.count?"),
        (["--vary", "8"], "--vary = '8': must be PATH=VALUES"),
        (
            ["--vary", "robots.wanderer.count=1", "--vary", "robots.wanderer.count=2"],
            "--vary robots.wanderer.count: occurs twice",
        ),
        (["--runs", "-5"], "runs = -5: must be a whole number from 2"),
        (["--delta", "0"], "delta = 0.0: must be a number above 0"),
        (["--delta", "nan"], "delta = nan: must be"),
        (["--confidence", "95"], "such as 0.95; did you mean 0.95?"),
        (["--confidence", "1"], "confidence = 1.0: must be a number from 0.5 to below 1, such as"),
        (["--guarantee", "sure"], "Invalid value for '--guarantee'"),
        (["--design", "lhs"], "--design: study.design"),
        (["--more", "0.99"], "No such option: --more"),
        (["--resume", "there"], "--resume: cannot be combined with"),
        (["--max-runs", "5"], "max_runs = 5: must be a whole number of 80 or more"),
        (["--workers", "0"], "Invalid value for '--workers'"),
        (["--workers", "2", "--dask", "tcp://127.0.0.1:1"], "expected one of them"),
        (["--merit", "best"], '--merit: merit = "best": must be one of "equation-5.2", "appendix"'),
        (["--seed", "-1"], "Invalid value for '--seed'"),
        (["--runs", "many"], "Invalid value for '--runs'"),
    ],
)
def test_invalid_options_are_named_and_create_no_files(
    options: list[str], part: str, classic_toml: Path, tmp_path: Path
) -> None:
    errors = refuse("study", classic_toml, *options, cwd=tmp_path)
    assert part in " ".join(errors.replace("│", " ").split())
    assert list(tmp_path.iterdir()) == []


def test_a_missing_scenario_is_named(tmp_path: Path) -> None:
    errors = refuse("study", "none.toml", cwd=tmp_path)
    assert errors.strip() == "none.toml: cannot be read: No such file or directory"


def test_a_study_needs_a_scenario() -> None:
    assert "SCENARIO is missing: expected a TOML file" in refuse("study")


def test_an_invalid_output_folder_is_reported_before_the_first_run(
    classic_toml: Path, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder")
    errors = refuse("study", classic_toml, "--out", tmp_path / "file")
    assert str(tmp_path / "file") in errors
    assert "round" not in errors


def test_ctrl_c_stops_within_a_second_and_the_study_can_be_resumed(
    classic_toml: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    options = ["--delta", "0.0001", "--vary", "clock.paints_per_s=56,56.01", "--out", str(out)]
    process = subprocess.Popen(
        [*COMMAND, "study", str(classic_toml), *options],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"FORCE_COLOR": "1"},
    )
    try:
        while len(list(out.glob("blocks/*"))) < 3 and process.poll() is None:
            time.sleep(0.02)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
        seconds = time.monotonic() - begin
    finally:
        process.kill()
    assert process.returncode == 130
    # The documented limit is one second; this one allows for a busy machine.
    assert seconds < 3
    assert re.search(r"Stopped after [\d,]+ runs; all are stored\.", errors)
    assert f"agent-economy study --resume {out}" in errors.replace("\n", "")
    assert "Traceback" not in errors
    assert not (out / "answer.json").exists()
    assert "is not finished" in refuse("report", out)
    succeed("study", "--resume", out)


def test_a_running_study_is_watched_and_excludes_a_second_process(
    classic_toml: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    options = ["--delta", "0.00001", "--vary", "clock.paints_per_s=56,56.001", "--out", str(out)]
    process = subprocess.Popen(
        [*COMMAND, "study", str(classic_toml), *options], stderr=subprocess.DEVNULL
    )
    try:
        while not list(out.glob("blocks/*")) and process.poll() is None:
            time.sleep(0.02)
        watcher = subprocess.Popen(
            [*COMMAND, "watch", str(out)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        second = run("study", "--resume", out)
    finally:
        process.kill()
        process.wait()
    printed, errors = watcher.communicate(timeout=60)
    assert second.returncode == 1
    assert "another process is using it" in second.stderr
    # The study was killed: it is not finished, and no process runs it.
    assert watcher.returncode == 1
    assert "remaining" in errors
    assert f"no process is working on it. Resume with: agent-economy study --resume {out}" in errors
    assert printed == ""


def test_a_damaged_study_has_its_own_exit_code(classic_toml: Path, tmp_path: Path) -> None:
    succeed("study", classic_toml, "--delta", "0.5", "--out", tmp_path)
    block = min((tmp_path / "blocks").iterdir())
    data = bytearray(block.read_bytes())
    data[len(data) // 2] ^= 1
    block.write_bytes(data)
    for command in (["study", "--resume"], ["report"]):
        assert str(block) in refuse(*command, tmp_path, code=1)


def test_the_table_of_an_answer_fits_into_eighty_columns(
    classic_toml: Path, tmp_path: Path
) -> None:
    environment = os.environ | {"COLUMNS": "80", "FORCE_COLOR": "1", "NO_COLOR": "1"}
    given = subprocess.run(
        [*COMMAND, "study", str(classic_toml), "--runs", "20", "--out", str(tmp_path)],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
        timeout=60,
    )
    lines = re.sub(r"\x1b\[[0-9;]*m", "", given.stdout).splitlines()
    assert sum("4 wanderers" in line and "-" in line for line in lines) == 1
    assert max(len(line) for line in lines if "wanderer" in line) <= 80


def test_ctrl_c_while_modules_load_leaves_no_traceback() -> None:
    interrupted_at_numpy = """
import sys

class CtrlC:
    def find_spec(self, name, *_):
        if name == "numpy":
            raise KeyboardInterrupt

sys.meta_path.insert(0, CtrlC())
sys.argv[1:] = ["scenarios"]
from agent_economy.__main__ import main
main()
"""
    given = run_python(interrupted_at_numpy)
    assert given.returncode == 130
    assert given.stderr == "Stopped.\n"


def test_a_summary_is_not_interpreted_as_markup(classic_toml: Path, tmp_path: Path) -> None:
    odd = tmp_path / "odd.toml"
    summary = "A [/oops] <b>test</b>"
    text = classic_toml.read_text()
    odd.write_text(text.replace("The 2003 experiment: four", f"{summary}: four"))
    given = succeed("study", odd, "--runs", "10", "--out", tmp_path / "out")
    assert summary in given.stdout
    assert "<b>test" not in (tmp_path / "out/report.html").read_text()


def test_any_encoding_of_the_terminal_works(classic_toml: Path, tmp_path: Path) -> None:
    environment = os.environ | {"PYTHONIOENCODING": "latin-1", "LC_ALL": "C"}
    command = [*COMMAND, "study", str(classic_toml), "--runs", "10", "--out", str(tmp_path)]
    given = subprocess.run(command, capture_output=True, env=environment, check=False, timeout=60)
    assert given.returncode == 0, given.stderr

"""The commands that run scenarios: their output, files and exit codes."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pyarrow as pa
import pytest
from command_line import COMMAND, refuse, run, succeed
from metric import ENDLESS, FULL, world
from pyarrow import csv, parquet

import agent_economy as ae
from agent_economy import Scenario
from agent_economy.runs.reasons import REASONS
from agent_economy.study.answer.any_answer import expect_best
from agent_economy.types.brain import Reason

CROWDED = world("""
clock.time_limit_s = 5
world.size_m = [3, 3]
items.mine.count = 1
[robots.rover]
count = 8
radius_m = 0.4
drive.max_speed_m_s = 0.5
sensors.sonar = { kind = "range", rays = 8, range_m = 3 }
sensors.detector = { kind = "items", range_m = 0.5 }
""")
"""Seven of the first twenty runs have no room for eight rovers."""


def test_run_prints_the_outcome() -> None:
    given = run("run", "search", "--seed", "7", "--run", "1")
    outcome = ae.run("search", 7, 1)
    assert (given.returncode, given.stderr) == (0, "")
    lines = [" ".join(line.split()) for line in given.stdout.splitlines()]
    assert lines[0] == f"search, seed 7, run 1: {outcome.status}"
    assert f"mine found {outcome.found['mine']} of 4" in lines
    assert f"time {outcome.time_s:.1f} s of 120 s" in lines
    assert f"energy {outcome.energy_j:,.0f} J" in lines
    assert "nan" not in given.stdout.lower()


def test_run_as_json_is_the_row_of_replicate() -> None:
    given = succeed("run", "search", "--run", "3", "--seed", "5", "--json")
    row = ae.replicate("search", 1, seed=5, first_run=3).to_pylist()[0]
    printed = json.loads(given.stdout)
    assert printed == {"seed": 5, "status": ae.run("search", 5, 3).status, **row}


def test_run_accepts_the_classic_engine_and_values() -> None:
    given = run("run", "classic", "--set", "robots.wanderer.count=9", "--json")
    assert json.loads(given.stdout)["robots"] == 9
    shown = run("run", "classic")
    assert "item found" in shown.stdout
    assert "energy" not in shown.stdout


def test_replicate_prints_means_and_writes_a_table(tmp_path: Path) -> None:
    out = tmp_path / "runs.parquet"
    given = succeed("replicate", "search", "--runs", "30", "--seed", "4", "--out", out)
    expected = ae.replicate("search", 30, 4)
    assert parquet.read_table(out).equals(expected)
    assert [file.name for file in tmp_path.iterdir()] == ["runs.parquet"]
    rows = {line.split()[0]: line.split() for line in given.stdout.splitlines() if line.split()}
    share = sum(expected["complete"].to_pylist()) / 30
    assert rows["complete"][1:3] == ["30", f"{share:.4g}"]
    assert rows["time_s"][1] == "30"
    assert given.stdout.splitlines()[0].strip() == "search, seed 4, 30 runs"
    assert given.stdout.splitlines()[-1] == f"All runs: {out}"


def test_replicate_as_json_has_an_interval_of_each_mean(tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    options = ["--runs", "25", "--threads", "1", "--json", "--out", str(out)]
    given = succeed("replicate", "classic", *options)
    printed = json.loads(given.stdout)
    assert (printed["scenario"], printed["seed"], printed["runs"]) == ("classic", 0, 25)
    columns = {each["column"]: each for each in printed["columns"]}
    assert columns["time_s"]["low"] < columns["time_s"]["mean"] < columns["time_s"]["high"]
    assert columns["time_s"]["minimum"] <= columns["time_s"]["low"]
    assert 0 <= columns["complete"]["low"] <= columns["complete"]["mean"] <= 1
    assert csv.read_csv(out)["paints"].equals(ae.replicate("classic", 25)["paints"])


def test_a_single_run_has_a_mean_with_a_wide_interval() -> None:
    printed = json.loads(run("replicate", "search", "--runs", "1", "--json").stdout)
    time_s = next(each for each in printed["columns"] if each["column"] == "time_s")
    assert time_s["mean"] == ae.run("search").time_s
    assert 0 <= time_s["low"] < time_s["mean"] - 30
    assert time_s["mean"] < time_s["high"] <= 120


def test_the_times_of_finds_are_in_files_and_json_but_not_in_tables(tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    shown = succeed("replicate", "search", "--runs", "20", "--out", out).stdout
    assert "found_mine" in shown
    assert "found_mine_1_s" not in shown
    assert "mine_1" not in succeed("run", "search").stdout
    times = csv.read_csv(out)["found_mine_4_s"]
    assert times.equals(ae.replicate("search", 20)["found_mine_4_s"])
    assert 0 < times.null_count < 20
    found = summary("search", "--runs", "20")["found_mine_4_s"]
    assert found["runs"] == 20 - times.null_count
    assert found["mean"] == pytest.approx(np.mean(times.drop_null().to_numpy()))
    printed = json.loads(succeed("run", "search", "--seed", "1", "--run", "1", "--json").stdout)
    assert printed["found_mine_4_s"] is ae.run("search", 1, 1).row["found_mine_4_s"] is None


def test_tables_of_goals_without_items_have_no_rows_of_items() -> None:
    few = ("waypoints", "--set", "goals.spot.count=2", "--set", "robots.rover.count=2")
    shown = succeed("replicate", *few, "--runs", "2").stdout
    assert "served_twice" in shown
    assert not {"found", "missed", "false_alarms"} & set(shown.split())
    assert "false alarms" not in succeed("run", *few).stdout
    columns = json.loads(succeed("replicate", *few, "--runs", "2", "--json").stdout)["columns"]
    assert "found" in [row["column"] for row in columns]


def test_goals_that_no_robot_can_serve_are_printed_with_the_reason() -> None:
    few = ("run", "waypoints", "--set", "goals.spot.count=2", "--set", "clock.time_limit_s=60")
    silent = (*few, "--set", "robots.rover.radio.range_m=1")
    assert succeed(*silent).stdout.count("Goal spot/1: no robot is in range.\n") == 1
    printed = json.loads(succeed(*silent, "--json").stdout)["unserved_goals"]
    assert printed == [{"goal": f"spot/{index}", "reason": "no_robot"} for index in range(2)]
    assert "Goal" not in succeed(*few).stdout
    assert json.loads(succeed(*few, "--json").stdout)["unserved_goals"] == []


def test_each_reason_of_an_unserved_goal_has_words() -> None:
    assert set(REASONS) == set(get_args(Reason))


def test_goals_without_a_working_controller_are_printed() -> None:
    few = ("run", "waypoints", "--set", "goals.spot.count=2", "--set", "clock.time_limit_s=10")
    failed = (*few, "--set", "controllers.base.failed=[0]")
    assert "Goal spot/1: no controller works that could own it.\n" in succeed(*failed).stdout


def summary(*arguments: str | Path) -> dict[str, dict[str, Any]]:
    """Return the summary of `replicate` by column, and the number of runs that it counts."""
    printed = json.loads(succeed("replicate", *arguments, "--json").stdout)
    columns = {each.pop("column"): each for each in printed["columns"]}
    return {**columns, "head": {key: printed[key] for key in ("runs", "quarantined")}}


def test_intervals_contain_possible_values_only_and_have_a_width(tmp_path: Path) -> None:
    never = tmp_path / "never.toml"
    never.write_text(CROWDED.replace("count = 8", "count = 1").replace("= 0.5", "= 0.001"))
    found = summary(never, "--runs", "20")
    assert found["complete"]["mean"] == 0
    # As up to 17% of runs may be complete, the mean time may be below the time limit.
    assert found["time_s"]["low"] < found["time_s"]["mean"] == found["time_s"]["high"] == 5
    assert found["merit"]["low"] == pytest.approx(found["merit"]["mean"])
    assert found["merit"]["mean"] < found["merit"]["high"] < 0
    assert found["found"] == found["found_mine"]
    assert (found["found"]["low"], found["robots_stopped"]["low"]) == (0, 0)
    assert 0 < found["found"]["high"] < 1
    assert (found["robots"]["low"], found["robots"]["high"]) == (1, 1)
    assert (found["false_alarms"]["low"], found["false_alarms"]["high"]) == (None, None)
    few = summary(never, "--runs", "3")
    for name, column in few.items():
        if name != "head" and column["low"] is not None:
            assert column["low"] <= column["mean"] <= column["high"]


def test_quarantined_runs_count_as_the_worst_and_are_counted(tmp_path: Path) -> None:
    crowded = tmp_path / "crowded.toml"
    crowded.write_text(CROWDED)
    found = summary(crowded, "--runs", "20")
    assert found["head"] == {"runs": 20, "quarantined": 7}
    runs = [row for row in ae.replicate(crowded, 20).to_pylist() if row["complete"] is not None]
    assert len(runs) == 13
    time_s = (sum(row["time_s"] for row in runs) + 7 * 5) / 20
    assert found["time_s"]["mean"] == pytest.approx(time_s)
    assert found["complete"]["mean"] == sum(row["complete"] for row in runs) / 20
    assert found["merit"]["minimum"] == pytest.approx(-0.03 * 5 - 0.2 * 8 - 5)
    assert [found[name]["runs"] for name in ("found", "missed", "merit")] == [20] * 3
    assert [found[name]["runs"] for name in ("distance_m", "collisions")] == [13] * 2
    assert found["found_mine_1_s"]["runs"] == sum(row["found_mine"] > 0 for row in runs)
    answer = expect_best(ae.study.run(Scenario.load(crowded), runs=20))
    assert answer.results[0].time_s.value == pytest.approx(found["time_s"]["mean"])
    assert answer.results[0].merit.value == pytest.approx(found["merit"]["mean"])
    note = succeed("replicate", crowded, "--runs", "20").stderr
    assert "\n7 of 20 runs were quarantined (robots.rover: the run has no room for" in note


def test_energy_without_a_battery_is_not_counted(tmp_path: Path) -> None:
    crowded = tmp_path / "crowded.toml"
    crowded.write_text(CROWDED.replace("count = 8", "count = 2"))
    assert "not counted: no robot has a battery" in succeed("run", crowded).stdout
    assert "not counted" in succeed("replicate", crowded, "--runs", "2").stdout
    assert ae.run(crowded).energy_j is None
    assert summary(crowded, "--runs", "2")["energy_j"]["mean"] is None
    assert "not counted" not in succeed("run", "search").stdout


def test_quarantined_runs_are_reported(tmp_path: Path) -> None:
    full = tmp_path / "full.toml"
    full.write_text(FULL)
    printed = json.loads(run("replicate", full, "--runs", "3", "--json").stdout)
    assert printed["quarantined"] == 3
    alone = run("run", full)
    assert alone.returncode == 0
    assert "run 0: quarantined" in alone.stdout
    assert "robots.second: the run has no room for second/0" in alone.stderr
    outcome = ae.run(full)
    printed = json.loads(run("run", full, "--json").stdout)
    assert printed == {"seed": 0, "status": "quarantined", **outcome.row}
    errors = refuse("run", full, "--record", "none.mcap", cwd=tmp_path)
    assert "the run has no room for second/0" in errors


def test_a_recording_instead_of_a_scenario_suggests_replay(tmp_path: Path) -> None:
    recorded = tmp_path / "run.mcap"
    short = ["--set", "clock.time_limit_s=1", "--record", str(recorded)]
    succeed("run", "search", *short)
    for command in ("run", "replicate", "check", "study"):
        given = run(command, recorded, cwd=tmp_path)
        assert given.returncode == 2
        assert f"agent-economy replay {recorded}" in given.stderr + given.stdout


@pytest.mark.parametrize(
    ("arguments", "printed"),
    [
        (
            ["run", "search", "--set", "robots.rovr.radius_m=3"],
            "--set robots.rovr.radius_m: robots.rovr.radius_m = 3: must be in an existing entry of "
            "robots: rover; a new entry also needs count and drive; did you mean "
            "robots.rover.radius_m?",
        ),
        (
            ["study", "search", "--vary", "robots.rovr.count=1..3"],
            '--vary: robots.rovr.count = "1..3": must be in an existing entry of robots: rover; '
            "did you mean robots.rover.count?",
        ),
        (
            ["study", "search", "--vary", "robots.rover.sensors.camra.range_m=1..3"],
            "entry of robots.rover.sensors: camera, compass, gps, lidar; "
            "did you mean robots.rover.sensors.camera.range_m?",
        ),
        (["run", "search", "--set", "robots.scout.model=ugv"], "a new entry also needs count"),
        (
            ["study", "search", "--vary", "robots.rover.count=1..100000"],
            "must be at most 10000 values; it has 100000",
        ),
        (["run", "serach"], "did you mean search?"),
        (["run", "search", "--set", "robots.rover.cuont=3"], "did you mean count?"),
        (["run", "search", "--run", "9223372036854775807"], "run = 9223372036854775807: must be"),
        (["run", "search", "--record", "search.toml"], "name of a recording must end in .mcap"),
        (["run", "search", "--every", "1"], "--every: requires --record FILE"),
        (
            ["run", "search", "--percepts", "no/1", "--every", "5"],
            "--every and --percepts: requires --record FILE",
        ),
        (["replicate", "search", "--out", "runs.txt"], "must end in one of .parquet, .csv"),
        (["replicate", "search", "--out", "none/runs.csv"], "must be in an existing folder"),
        (["replicate", "search", "--runs", "0"], "--runs"),
        (["replicate", "search", "--out", "/proc/x.parquet"], "is not writable"),
    ],
)
def test_invalid_arguments_are_named(arguments: list[str], printed: str, tmp_path: Path) -> None:
    assert printed in " ".join(refuse(*arguments, cwd=tmp_path).split())
    assert list(tmp_path.iterdir()) == []


def test_an_unwritable_table_is_reported_before_the_first_run(tmp_path: Path) -> None:
    (tmp_path / "runs.csv").mkdir()
    # This number of runs would exceed the timeout of `run`.
    errors = refuse("replicate", "search", "--runs", "10000000", "--out", tmp_path / "runs.csv")
    assert errors == f"--out {tmp_path}/runs.csv: must be a file; it is a folder\n"
    assert [file.name for file in tmp_path.iterdir()] == ["runs.csv"]


@pytest.mark.parametrize("command", ["run", "replicate"])
def test_long_runs_print_their_progress_and_ctrl_c_stops_them(command: str, tmp_path: Path) -> None:
    out = ["--out", str(tmp_path / "runs.csv")] if command == "replicate" else []
    endless = [f"--set={path}={json.dumps(value)}" for path, value in ENDLESS.items()]
    values = endless if command == "run" else ["--runs", "10000000"]
    with subprocess.Popen(
        [*COMMAND, command, "search", *values, *out],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"COLUMNS": "200"},
    ) as process:
        assert process.stderr
        first = process.stderr.readline()
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    assert " of 1" in first
    assert " left" in first
    assert process.returncode == 130
    # The documented limit is one second; this one allows for a busy machine.
    assert time.monotonic() - begin < 3
    assert errors.endswith("Stopped.\n")
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == []


def test_a_written_table_has_the_types_of_the_api(tmp_path: Path) -> None:
    out = tmp_path / "runs.parquet"
    run("replicate", "search", "--runs", "2", "--out", out)
    assert parquet.read_schema(out).field("complete").type == pa.bool_()


def test_out_and_record_write_through_a_link_to_its_target(tmp_path: Path) -> None:
    (disk := tmp_path / "disk").mkdir()
    (disk / "runs.csv").touch()
    for name in ("runs.csv", "new.parquet", "run.mcap"):
        (tmp_path / name).symlink_to(disk / name)
    for name in ("runs.csv", "new.parquet"):
        succeed("replicate", "flock", "--runs", "2", "--out", tmp_path / name)
    succeed("run", "flock", "--record", tmp_path / "run.mcap")
    assert all(path.is_symlink() for path in tmp_path.iterdir() if path != disk)
    sizes = {path.name: path.stat().st_size > 0 for path in disk.iterdir()}
    assert sizes == {"runs.csv": True, "new.parquet": True, "run.mcap": True}


@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("none/runs.csv", "No such file or directory"),
        ("runs.csv", "Too many levels of symbolic links"),
        ("/dev/null", "it is a pipe or a device"),
        (".", "must be a file; it is a folder"),
    ],
)
def test_a_link_that_leads_to_no_file_is_refused_and_stays(
    tmp_path: Path, target: str, reason: str
) -> None:
    (tmp_path / "runs.csv").symlink_to(target)
    assert reason in refuse("replicate", "search", "--out", tmp_path / "runs.csv")
    assert (tmp_path / "runs.csv").readlink() == Path(target)
    assert Path("/dev/null").is_char_device()

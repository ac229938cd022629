"""The command stop with real drives, from other environments than theirs.

Only in a network of its own may a test stop all drives: elsewhere it would stop those of the user
that runs the tests.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from bare_timer import repeated_if_late
from command_line import COMMAND
from live_bench import Bench, driving, emulated, fleet_text
from other_programs import in_own_network, needs_abstract, needs_network

from agent_economy.live.clock import now_s
from agent_economy.live.local_socket import HAS_ABSTRACT

VARIABLES = ("XDG_RUNTIME_DIR", "TMPDIR", "HOME", "USER")


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """Emulate a robot."""
    with emulated(tmp_path_factory.mktemp("emulator")) as bench:
        yield bench


@pytest.fixture
def fleet(bench: Bench, tmp_path: Path) -> Path:
    """Write a fleet file of the emulated robot."""
    path = tmp_path / "fleet.toml"
    path.write_text(fleet_text(bench), encoding="utf-8")
    return path


def stop(pid: int, *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Stop one drive from an environment without the usual variables."""
    environment = {name: text for name, text in os.environ.items() if name not in VARIABLES}
    command = [*COMMAND, "stop", "--process", str(pid), *arguments]
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
        env=environment | variables,
        cwd="/",
    )


@needs_abstract
@repeated_if_late
def test_stop_finds_a_drive_of_another_runtime_folder(
    bench: Bench, fleet: Path, tmp_path: Path
) -> None:
    with driving(fleet) as drive:
        drive.wait_until_moving()
        began_s = now_s()
        done = stop(drive.process.pid, XDG_RUNTIME_DIR=str(tmp_path / "other"))
        assert done.returncode == 0, done.stderr
        assert f"(process {drive.process.pid}): emergency stop" in done.stdout
        assert drive.wait() == 3
        assert bench.stops_after(0, began_s)[0] - began_s < 2


@needs_abstract
@repeated_if_late
def test_stop_finds_a_drive_whose_folder_is_gone_and_the_drive_is_listed_again(
    fleet: Path, tmp_path: Path
) -> None:
    with driving(fleet) as drive:
        drive.wait_until_moving()
        shutil.rmtree(tmp_path / f"agent-economy-{os.geteuid()}")
        assert stop(drive.process.pid, TMPDIR="/nowhere").returncode == 0
        time.sleep(1.0)
        assert drive.running().pid == drive.process.pid
        assert drive.wait() == 3
    assert not list(tmp_path.rglob("*.json"))


@needs_abstract
def test_a_drive_that_is_suspended_is_reported_with_its_process(fleet: Path) -> None:
    with driving(fleet, headless=False) as drive:
        drive.wait_for(lambda each: each["type"] == "event")
        loop = drive.loop_pid()
        try:
            os.kill(loop, signal.SIGSTOP)  # It would end the other.
            drive.process.send_signal(signal.SIGSTOP)
            done = stop(drive.process.pid)
            rows = json.loads(stop(drive.process.pid, "--json").stdout)
        finally:
            drive.process.send_signal(signal.SIGCONT)
            os.kill(loop, signal.SIGCONT)
    assert done.returncode == 1
    assert not done.stdout
    assert f"process {drive.process.pid}): no answer" in done.stderr
    assert "press Ctrl-C in its terminal" in done.stderr
    assert [(row["pid"], row["is_stopped"]) for row in rows] == [(drive.process.pid, False)]


def test_stop_without_a_drive_is_no_success_and_states_where_it_looked() -> None:
    done = stop(os.getpid())
    assert done.returncode == 1
    assert not done.stdout
    assert f"No drive with process {os.getpid()}" in done.stderr
    assert "Looked at: " in done.stderr
    assert json.loads(stop(os.getpid(), "--json").stdout) == []


def test_a_second_drive_of_a_robot_is_refused_in_every_environment(
    bench: Bench, fleet: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other"
    other.mkdir()
    shutil.copy(fleet, other)
    with driving(fleet) as first:
        first.wait_until_moving()
        with driving(other / fleet.name) as second:
            assert second.wait() == 2
            message = second.events[-1]["message"]
    assert f"127.0.0.1:{bench.robots[0]['motors']} is being driven by another" in message
    if HAS_ABSTRACT:
        assert f"(process {first.process.pid} of user " in message


TWO_DRIVES = """
import json, os, subprocess, sys
from pathlib import Path
from live_bench import driving, emulated, fleet_text
from command_line import COMMAND
from wire_faults import lanes

folder = Path(sys.argv[1])
fleets = [folder / name / "fleet.toml" for name in ("one", "two")]
scenario = str(lanes(folder, 2))
with emulated(folder, robots=2, arguments=("--scenario", scenario)) as bench:
    for number, fleet in enumerate(fleets):
        fleet.parent.mkdir()
        fleet.write_text(fleet_text(bench, scenario=scenario, robots=[number]))
    with driving(fleets[0], headless=False) as one, driving(fleets[1], headless=False) as two:
        drives = (one, two)
        for drive in drives:
            drive.wait_for(lambda each: each["type"] == "event")
        done = subprocess.run([*COMMAND, "stop", "--json"], stdout=subprocess.PIPE, text=True)
        rows = {row["pid"]: row for row in json.loads(done.stdout)}
        assert all(rows[drive.process.pid]["is_stopped"] for drive in drives), rows
        for drive in drives:
            assert drive.ask("/state")[1]["is_stopped"]
print("stopped")
"""


@needs_abstract
@needs_network
def test_stop_without_a_process_stops_all_drives_of_the_user(tmp_path: Path) -> None:
    command = in_own_network(sys.executable, "-c", TWO_DRIVES, str(tmp_path))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=120, check=False, env=environment
    )
    assert done.stdout == "stopped\n", done.stderr


CPU = """
import resource, statistics, subprocess, sys
times_s = []
for _ in range(5):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([*sys.argv[1:]], capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    times_s.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
print(statistics.median(times_s))
"""


def test_stop_takes_little_processor_time() -> None:
    command = [sys.executable, "-c", CPU, *COMMAND, "stop", "--process", str(os.getpid())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert float(done.stdout) < 0.2


def test_stop_loads_neither_the_libraries_of_the_command_line_nor_the_engine() -> None:
    code = (
        "import sys\n"
        "from agent_economy.__main__ import main\n"
        f"sys.argv = ['agent-economy', 'stop', '--process', '{os.getpid()}']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "bad = {'typer', 'pydantic', 'numpy', 'agent_economy._core', 'asyncio'}\n"
        "print(*bad & set(sys.modules))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not done.stdout.strip()

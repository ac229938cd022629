"""The commands drive and stop, against an emulated fleet: bad input, refused robots, and Ctrl-C."""

import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from command_line import COMMAND
from live_bench import STOP_LINE, Bench, driving, emulated, fleet_text
from wire_faults import lanes

from agent_economy.live.clock import now_s
from agent_economy.live.replay import read_drive, replay
from agent_economy.recording.live_topics import TICKS

STEP_S = 0.1


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """Emulate two robots."""
    folder = tmp_path_factory.mktemp("emulator")
    scenario = lanes(folder, 2)
    with emulated(folder, robots=2, arguments=("--scenario", str(scenario))) as bench:
        yield bench


def fleet_of(bench: Bench, folder: Path, **options: Any) -> Path:
    """Write a fleet file of emulated robots."""
    path = folder / "fleet.toml"
    scenario = str(bench.log.parent / "lanes.toml")
    path.write_text(fleet_text(bench, scenario=scenario, **options), encoding="utf-8")
    return path


def refused_port() -> int:
    """Return a port on which nothing listens."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


@repeated_if_late
def test_a_robot_that_refuses_connections_is_named_and_the_other_drives_until_ctrl_c(
    bench: Bench, tmp_path: Path
) -> None:
    fleet = fleet_of(bench, tmp_path)
    text, port = fleet.read_text(), bench.robots[1]["motors"]
    fleet.write_text(text.replace(f"motors = {port}", f"motors = {refused_port()}"))
    with driving(fleet) as drive:
        drive.wait_until_moving("bender/0")
        refused = drive.wait_for(
            lambda each: "refused" in each.get("reasons", {}).get("lost_link", "")
        )
        assert refused["robot"] == "bender/1"
        bench.wait_for_motion(1)
        stopped_s = now_s()
        drive.process.send_signal(signal.SIGINT)
        assert drive.wait() == 130
    assert bench.stops_after(0, stopped_s)[0] - stopped_s < 2
    assert not bench.moves_after(0, bench.stops_after(0, stopped_s)[0])
    assert not bench.moves_after(1, 0.0)


def processor_s(process: int) -> float:
    """Return the processor time of a process so far."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
def test_a_drive_that_waits_for_its_robots_leaves_the_processor_free(
    bench: Bench, tmp_path: Path
) -> None:
    fleet = fleet_of(bench, tmp_path)
    text = fleet.read_text()
    for robot in bench.robots:
        text = text.replace(f"motors = {robot['motors']}", f"motors = {refused_port()}")
    fleet.write_text(text)
    with driving(fleet) as drive:
        drive.wait_for(lambda each: each["type"] == "event")
        before_s = processor_s(drive.process.pid)
        time.sleep(3)
        # A loop without a pause uses as much as it gets: a second at least.
        assert processor_s(drive.process.pid) - before_s < 0.6


@repeated_if_late
def test_a_drive_whose_warden_is_suspended_ends_with_the_reason(
    bench: Bench, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with driving(fleet_of(bench, tmp_path)) as drive:
        drive.wait_until_moving("bender/0")
        loop = Path(f"/proc/{drive.loop_pid()}/cmdline")
        drive.process.send_signal(signal.SIGSTOP)
        assert drive.wait() == -signal.SIGKILL
        deadline_s = now_s() + 20
        while loop.exists() and loop.read_bytes() and now_s() < deadline_s:
            time.sleep(0.1)
    assert "was silent for more than 0.3 s" in capfd.readouterr().err


@repeated_if_late
def test_a_second_drive_of_a_robot_is_refused(bench: Bench, tmp_path: Path) -> None:
    fleet = fleet_of(bench, tmp_path, robots=[0])
    with driving(fleet) as first:
        first.wait_until_moving("bender/0")
        with driving(fleet) as second:
            assert second.wait() == 2
            text = str(second.events[-1])
            assert f"127.0.0.1:{bench.robots[0]['motors']}" in text
            assert "is being driven" in text
            assert not second.record.exists()  # nothing was driven: the name is free again
        assert first.process.poll() is None
        bench.wait_for_motion(1)
        stopped_s = now_s()
        first.process.send_signal(signal.SIGTERM)
        assert first.wait() == 130
    assert bench.lines(0)[-1]["line"] == STOP_LINE
    assert bench.stops_after(0, stopped_s)
    end = first.events[-1]
    assert (end["type"], end["exit_code"], end["unconfirmed"]) == ("end", 130, [])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["missing.toml", "--headless", "--arm"], "missing.toml"),
        (["fleet.toml", "--headless"], "--headless needs --arm"),
        (["fleet.toml", "--arm"], "--arm needs --headless"),
    ],
)
def test_bad_input_ends_a_drive_with_a_message_and_exit_code_2(
    arguments: list[str], words: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [*COMMAND, "drive", *arguments], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


@repeated_if_late
def test_a_drive_makes_up_for_a_late_step_without_a_burst(bench: Bench, tmp_path: Path) -> None:
    with driving(fleet_of(bench, tmp_path, robots=[0])) as drive:
        drive.wait_until_moving("bender/0")
        time.sleep(4)  # the time until the first step is made up for, too
        loop = drive.loop_pid()
        os.kill(loop, signal.SIGSTOP)
        time.sleep(0.2)
        os.kill(loop, signal.SIGCONT)
        time.sleep(4)
        drive.process.send_signal(signal.SIGINT)
        assert drive.wait() == 130
    end = drive.events[-1]
    assert end["was_late"]
    assert end["late_steps"] >= 1
    assert 0.1 < end["max_behind_s"] < 2
    recorded = read_drive(drive.record)
    assert recorded is not None
    ticks = [message for topic, message in recorded.messages if topic == TICKS]
    start_s = float((recorded.values or {})["start_s"])
    assert all(other["t"] - one["t"] >= 0.09 - 1e-6 for one, other in pairwise(ticks))
    assert max(each["behind_s"] for each in ticks[30:]) > 0.1
    longest_s = max(each["behind_s"] for each in ticks)
    assert longest_s == pytest.approx(end["max_behind_s"], abs=1e-5)
    for each in ticks:
        # Simulated time, after the step, is never ahead of the clock.
        behind_s = each["t"] - start_s - (each["tick"] + 1) * STEP_S
        assert behind_s > -1e-6
        assert each["behind_s"] == pytest.approx(behind_s, abs=1e-6)
    assert ticks[-1]["behind_s"] < 0.05
    assert replay(drive.record).agrees

"""What a recording replaces: never that of a drive, which cannot be made again."""

import os
import re
import socket
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier
from typing import Any

import pytest
from command_line import refuse, succeed
from metric import search
from recorded_drive import made
from test_recording import SHORT

import agent_economy as ae
from agent_economy import InputError, Simulation
from agent_economy.live import fleet
from agent_economy.live.emulator.log import opened
from agent_economy.live.loop.log import Log, LogOptions
from agent_economy.recording.output import BLOCK_BYTES, MARK, create_new
from agent_economy.server.recordings.writer import rename_complete
from agent_economy.whole_file import temporary_file

DRIVE = [sys.executable, "-m", "agent_economy", "drive", "bender", "--headless", "--arm"]


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return made(tmp_path_factory.mktemp("drive") / "drive.mcap", steps=5).read_bytes()


def recording(path: Path) -> None:
    ae.Recording(Simulation(search(SHORT)), path)


def run_of_api(path: Path) -> None:
    ae.run(search(SHORT), record=path)


def run_of_shell(path: Path) -> None:
    raise InputError(refuse("run", "search", "--record", path))


@pytest.mark.parametrize("write", [recording, run_of_api, run_of_shell])
@pytest.mark.parametrize("damage", ["none", "cut", "zeros", "header", "half written"])
def test_nothing_replaces_the_recording_of_a_drive_even_a_damaged_one(
    write: Callable[[Path], None], damage: str, drive: bytes, mcap: Path
) -> None:
    before = {
        "none": drive,
        "cut": drive[: len(drive) * 2 // 3],
        "zeros": drive[: len(drive) // 2] + bytes(BLOCK_BYTES),
        "header": bytes(200) + drive[200:],
        "half written": drive[: drive.index(MARK) + len(MARK)],
    }[damage]
    mcap.write_bytes(before)
    with pytest.raises(InputError, match=r"run\.mcap: is the recording of a drive, .*: choose an"):
        write(mcap)
    assert mcap.read_bytes() == before


def test_a_link_to_the_recording_of_a_drive_protects_it_too(
    drive: bytes, mcap: Path, tmp_path: Path
) -> None:
    original = tmp_path / "original.mcap"
    original.write_bytes(drive)
    mcap.symlink_to(original)
    (hard := tmp_path / "hard.mcap").hardlink_to(original)
    for path in (mcap, hard):
        with pytest.raises(InputError, match="is the recording of a drive"):
            recording(path)
    assert original.read_bytes() == drive


def test_a_saved_run_of_a_page_replaces_no_drive(drive: bytes, tmp_path: Path) -> None:
    def saved() -> Path:
        with temporary_file(tmp_path, ".mcap") as file:
            file.write(b"new")
            file.flush()
            return rename_complete(file, "run")

    final = saved()
    assert saved() == final  # the same run again
    final.write_bytes(drive)
    with pytest.raises(InputError, match="is the recording of a drive"):
        saved()
    assert final.read_bytes() == drive
    assert list(tmp_path.iterdir()) == [final]


def test_the_log_of_an_emulator_replaces_no_drive(drive: bytes, tmp_path: Path) -> None:
    (path := tmp_path / "log").write_bytes(drive)
    with pytest.raises(InputError, match="is the recording of a drive"):
        opened(path)
    assert path.read_bytes() == drive


@pytest.mark.parametrize("place", [0, BLOCK_BYTES - len(MARK) // 2, BLOCK_BYTES, 3 * BLOCK_BYTES])
def test_a_drive_is_recognised_wherever_its_name_is_in_the_file(place: int, mcap: Path) -> None:
    mcap.write_bytes(bytes(place) + MARK)
    with pytest.raises(InputError, match="is the recording of a drive"):
        recording(mcap)


def test_other_files_are_replaced_also_through_links(mcap: Path, tmp_path: Path) -> None:
    target = tmp_path / "target.mcap"
    mcap.symlink_to(target)  # a link to nothing, then to a run
    for _ in range(2):
        run_of_api(mcap)
        assert mcap.is_symlink()
        assert ae.replay(target).agrees
    target.write_bytes(b"agent_economy.live" * 10**6)
    run_of_api(mcap)
    assert ae.replay(target).agrees


def test_a_folder_and_a_pipe_are_refused_at_once(mcap: Path, tmp_path: Path) -> None:
    mcap.mkdir()
    refuse("run", "search", "--record", mcap)
    os.mkfifo(pipe := tmp_path / "pipe.mcap")
    assert "is a pipe" in refuse("run", "search", "--record", pipe)
    with socket.socket(socket.AF_UNIX) as served:
        served.bind(str(tmp_path / "socket.mcap"))
        refuse("run", "search", "--record", tmp_path / "socket.mcap")


def existing(kind: str, path: Path) -> Path:
    match kind:
        case "recording":
            made(path, steps=1)
        case "file":
            path.write_text("precious")
        case "empty file":
            path.touch()
        case "folder":
            path.mkdir()
        case "pipe":
            os.mkfifo(path)
        case "link to nothing":
            path.symlink_to("nothing")
        case "link to a file":
            (path.parent / "file").write_text("precious")
            path.symlink_to("file")
        case "full device":
            path.symlink_to("/dev/full")
    return path


KINDS = (
    *("recording", "file", "empty file", "folder", "pipe"),
    *("link to nothing", "link to a file", "full device"),
)


@pytest.mark.parametrize("kind", KINDS)
def test_a_drive_never_replaces_a_file(kind: str, mcap: Path) -> None:
    before = state(existing(kind, mcap))
    done = subprocess.run(
        [*DRIVE, "--record", str(mcap)], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 2
    assert re.match(
        rf"{mcap}: (exists already|is a .*): a drive never replaces a file", done.stderr
    )
    assert len(done.stderr.splitlines()) == 1
    assert state(mcap) == before


def state(path: Path) -> tuple[Any, ...]:
    facts = path.lstat()
    content = path.read_bytes() if path.is_file() else b""
    return facts.st_ino, facts.st_mode, facts.st_size, content, sorted(path.parent.iterdir())


def test_a_default_name_counts_up_past_everything_that_exists(tmp_path: Path) -> None:
    for number, kind in enumerate(KINDS, 1):
        name = "fleet.mcap" if number == 1 else f"fleet-{number}.mcap"
        if kind != "link to a file":
            existing(kind, tmp_path / name)
    path = tmp_path / "fleet.mcap"
    assert made(LogOptions(path, is_numbered=True)) == tmp_path / "fleet-7.mcap"
    assert made(LogOptions(path, is_numbered=True)) == tmp_path / "fleet-9.mcap"


def test_of_drives_that_begin_at_once_each_has_its_own_file(mcap: Path) -> None:
    threads = 16
    barrier = Barrier(threads)

    def begin(_: int) -> Path:
        barrier.wait()
        return create_new(mcap, is_numbered=True)

    with ThreadPoolExecutor(threads) as pool:
        assert len(set(pool.map(begin, range(threads)))) == threads


def test_a_name_that_cannot_be_a_recording_leaves_no_file(tmp_path: Path) -> None:
    loaded = fleet.load("bender")
    simulation = Simulation(loaded.scenario, external=["bender/0"])
    for name in ("run.txt", "missing/run.mcap", f"{'long' * 80}.mcap", "nul\0.mcap"):
        with pytest.raises(InputError):
            Log(simulation, LogOptions(tmp_path / name, is_numbered=True), loaded, 0.0)
    assert not list(tmp_path.iterdir())


def test_a_run_can_be_recorded_again(mcap: Path) -> None:
    for seed in ("1", "2"):
        succeed("run", "search", "--seed", seed, "--set", "clock.time_limit_s=1", "--record", mcap)
    assert ae.replay(mcap).seed == 2

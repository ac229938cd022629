"""Programs that write one file at the same time neither mix nor break it."""

import errno
import os
import shutil
import signal
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from command_line import refuse, succeed
from conftest import ROOT
from metric import search
from test_recording import SHORT

import agent_economy as ae
from agent_economy import InputError, Simulation
from agent_economy.live.emulator.log import Log
from agent_economy.study.report import script
from agent_economy.study.store.folder import write_whole
from agent_economy.whole_file import remove_abandoned, replacing

WRITES = """
import sys, time
from pathlib import Path
from agent_economy.study.store.folder import write_whole
path, letter, ready = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
(ready / letter).touch()
while len(list(ready.iterdir())) < 2:
    time.sleep(0.001)
for number in range(60):
    write_whole(path, letter.encode() * 300_000)
"""

DIES = """
import os, signal, sys
from pathlib import Path
from agent_economy.whole_file import replacing
with replacing(Path(sys.argv[1])) as stream:
    stream.write(b"half")
    stream.flush()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def begun(code: str, *arguments: object) -> subprocess.Popen[bytes]:
    """Start a Python program."""
    return subprocess.Popen([sys.executable, "-c", code, *map(str, arguments)])


def names(folder: Path) -> set[str]:
    """Return the names in a folder."""
    return {path.name for path in folder.iterdir()}


def test_what_two_programs_write_at_once_is_always_whole(tmp_path: Path) -> None:
    (ready := tmp_path / "ready").mkdir()
    (place := tmp_path / "place").mkdir()
    path = place / "answer.json"
    write_whole(path, b"c" * 300_000)
    writers = [begun(WRITES, path, letter, ready) for letter in "ab"]
    seen = set()
    while any(writer.poll() is None for writer in writers):
        data = path.read_bytes()
        assert data == data[:1] * 300_000
        seen.add(data[:1])
    assert [writer.wait() for writer in writers] == [0, 0]
    assert {b"a", b"b"} <= seen
    assert names(place) == {"answer.json"}


def test_a_killed_writer_leaves_the_old_file_and_what_the_next_one_removes(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    path.write_text("old")
    assert begun(DIES, path).wait() == -signal.SIGKILL
    assert path.read_text() == "old"
    assert len(names(tmp_path)) == 2
    succeed("replicate", "classic", "--runs", "2", "--out", path)
    assert names(tmp_path) == {"runs.csv"}
    assert path.read_text().startswith('"run"')


def test_two_tables_of_runs_with_one_name_are_both_whole(tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    command = [sys.executable, "-m", "agent_economy", "replicate", "classic", "--out", str(out)]
    programs = [
        subprocess.Popen([*command, "--runs", runs], stdout=subprocess.DEVNULL)
        for runs in ("100", "200")
    ]
    assert [program.wait() for program in programs] == [0, 0]
    assert len(out.read_text().splitlines()) in {101, 201}
    assert names(tmp_path) == {"runs.csv"}


def test_a_file_that_is_being_written_is_not_removed_as_abandoned(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    (tmp_path / ".unfinished-1").touch()
    with replacing(path) as stream:
        remove_abandoned(tmp_path)
        stream.write(b"new")
        assert len(names(tmp_path)) == 1
    assert path.read_bytes() == b"new"


@pytest.mark.parametrize("fails", ["fsync", "replace"])
def test_a_file_that_cannot_be_written_stays_as_it_was(
    fails: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = tmp_path / "answer.json"
    path.write_text("old")
    monkeypatch.setattr(os if fails == "fsync" else Path, fails, full)
    with pytest.raises(InputError, match=r"answer.json: cannot be written \(No space left"):
        write_whole(path, b"new")
    assert path.read_text() == "old"
    assert names(tmp_path) == {"answer.json"}


def test_a_folder_that_is_gone_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"gone/answer.json: cannot be written \(No such file"):
        write_whole(tmp_path / "gone" / "answer.json", b"new")


def test_any_name_that_a_file_can_have_is_written(tmp_path: Path) -> None:
    for name in ("n" * 255, "-x", "a b", "*", "[1]", "a\nb", "ü" * 127):
        write_whole(tmp_path / name, b"new")
        assert (tmp_path / name).read_bytes() == b"new"


def test_written_files_have_the_permissions_of_new_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    before = os.umask(0o027)
    try:
        script.keep("charts")
        write_whole(tmp_path / "answer.json", b"new")
    finally:
        os.umask(before)
    for path in (script.cache_file(), tmp_path / "answer.json"):
        assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_two_recordings_do_not_write_one_file(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with ae.Recording(Simulation(search(SHORT)), path) as recording:
        recording.step(5)
        with pytest.raises(InputError, match=r"run\.mcap: is being written, by another program"):
            ae.Recording(Simulation(search(SHORT), seed=1), path)
        assert "is being written" in refuse("run", "search", "--record", path)
        recording.finish()
    assert ae.replay(path).agrees


def test_two_emulators_do_not_write_one_log(tmp_path: Path) -> None:
    path = tmp_path / "log"
    log = Log(path)
    log.add("connected", 0, "sonar")
    with pytest.raises(InputError, match="is being written"):
        Log(path)
    log.close()
    assert len(path.read_text().splitlines()) == 1
    Log(path).close()
    assert path.read_text() == ""


def program(folder: Path, name: str, code: str) -> None:
    """Create a program of Python."""
    path = folder / name
    path.write_text(f"#!{sys.executable}\n{code}")
    path.chmod(0o755)


def both(command: list[str], folder: Path, environment: dict[str, str]) -> list[Any]:
    """Run a command twice at the same time; return the exit codes."""
    programs = [subprocess.Popen(command, cwd=folder, env=environment) for _ in range(2)]
    return [each.wait(60) for each in programs]


@pytest.mark.skipif(shutil.which("make") is None, reason="make is missing")
def test_two_builds_write_the_schema_of_the_page_whole(tmp_path: Path) -> None:
    shutil.copy(ROOT / "Makefile", tmp_path)
    for folder in ("crates/protocol/examples", "crates/protocol/src", "crates/py/build"):
        (tmp_path / folder).mkdir(parents=True)
    for file in ("Cargo.toml", "Cargo.lock", "crates/protocol/Cargo.toml"):
        (tmp_path / file).touch()
    (tmp_path / "crates/protocol/examples/page_schema.rs").touch()
    prints = "import time\nfor _ in range(5):\n    print('{', flush=True)\n    time.sleep(0.1)\n"
    program(tmp_path, "cargo", prints)
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    command = ["make", "--silent", "--always-make", "target/page.schema.json"]
    assert both(command, tmp_path, environment) == [0, 0]
    assert (tmp_path / "target/page.schema.json").read_text() == "{\n" * 5
    assert names(tmp_path / "target") == {"page.schema.json"}


def test_two_builds_of_the_page_take_turns(tmp_path: Path) -> None:
    for folder in ("packaging", "web/node_modules", "python/agent_economy"):
        (tmp_path / folder).mkdir(parents=True)
    shutil.copy(ROOT / "packaging/backend.py", tmp_path / "packaging")
    (tmp_path / "web/package-lock.json").touch()
    (tmp_path / "web/node_modules/.package-lock.json").touch()
    builds = "import os, time\nos.mkdir('dist')\ntime.sleep(0.5)\nopen('dist/index.html', 'w')\n"
    program(tmp_path, "npm", builds)
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    assert both([sys.executable, "packaging/backend.py"], tmp_path, environment) == [0, 0]
    page = tmp_path / "python/agent_economy/web"
    assert names(page) == {"index.html", "built-from.txt"}
    assert names(page.parent) == {"web"}

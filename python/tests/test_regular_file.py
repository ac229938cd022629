"""Pipes, sockets and devices where a regular file is expected: nothing waits for them."""

import os
import shutil
import signal
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from command_line import refuse, succeed
from small_study import run_plan
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy import study
from agent_economy.regular_file import IRREGULAR, descriptor_of, open_regular
from agent_economy.server.studies.manager import StudyManager
from agent_economy.server.workspace import Workspace

LIMIT_S = 60
"""A test that waits for a pipe ends then, with a traceback."""


@pytest.fixture(autouse=True)
def limited() -> Iterator[None]:
    """End a test that waits for a pipe."""
    before = signal.signal(signal.SIGALRM, lambda *_: pytest.fail("it waits"))
    signal.alarm(LIMIT_S)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished study."""
    folder = tmp_path_factory.mktemp("answered") / "study"
    run_plan(folder)
    return folder


@pytest.fixture
def finished(answered: Path, tmp_path: Path) -> Path:
    """Return a copy of that study, which a test may damage."""
    return Path(shutil.copytree(answered, tmp_path / "study"))


def as_pipe(file: Path) -> Path:
    """Replace a file by a named pipe."""
    file.unlink(missing_ok=True)
    os.mkfifo(file)
    return file


@pytest.mark.parametrize("kind", ["pipe", "socket", "device"])
def test_only_regular_files_are_opened(tmp_path: Path, kind: str) -> None:
    file = tmp_path / kind
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "device":
        file.symlink_to("/dev/zero")
    else:
        with socket.socket(socket.AF_UNIX) as listening:
            listening.bind(str(file))
    with pytest.raises(OSError, match=IRREGULAR):
        open_regular(file)
    with pytest.raises(OSError, match=IRREGULAR):
        descriptor_of(file, os.O_RDWR | os.O_CREAT)


def test_a_pipe_that_takes_the_place_of_a_file_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("agent_economy.regular_file.check_regular", as_pipe)
    with pytest.raises(OSError, match=IRREGULAR):
        open_regular(tmp_path / "file")


def test_a_folder_and_an_impossible_name_are_errors_of_the_disk(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError):
        open_regular(tmp_path)
    with pytest.raises(OSError, match="null"):
        open_regular(Path("a\0b"))


@pytest.mark.parametrize("command", [["report"], ["watch"], ["study", "--resume"]])
@pytest.mark.parametrize("name", ["study.toml", "ledger.sqlite", "ledger.sqlite-wal"])
def test_commands_refuse_a_study_that_has_a_pipe(
    finished: Path, command: list[str], name: str
) -> None:
    as_pipe(finished / name)
    errors = refuse(*command, finished)
    assert errors.splitlines()[-1] == f"{finished / name}: cannot be read: {IRREGULAR}"


def test_a_block_file_that_is_a_pipe_is_refused(finished: Path) -> None:
    block = as_pipe(min((finished / "blocks").iterdir()))
    assert f"{block}: cannot be read: {IRREGULAR}" in refuse("report", finished)
    with pytest.raises(ae.InputError, match=IRREGULAR):
        study.open(finished).runs()


def test_a_lock_that_is_a_pipe_is_refused_and_locks_nothing(finished: Path) -> None:
    lock = as_pipe(finished / ".lock")
    assert f"{lock}: cannot be read: {IRREGULAR}" in refuse("study", "--resume", finished)
    assert not study.is_locked(finished)


def test_a_report_that_is_a_pipe_is_not_written(finished: Path) -> None:
    report = as_pipe(finished / "report.html")
    errors = refuse("study", "--resume", finished, code=1)
    assert f"{report}: cannot be written (it is a pipe or a device)" in errors
    assert report.is_fifo()


def test_an_unfinished_file_that_is_a_pipe_does_no_harm(finished: Path, answered: Path) -> None:
    as_pipe(finished / ".unfinished-report.html")
    succeed("report", finished)
    assert (finished / "report.html").read_bytes() == (answered / "report.html").read_bytes()


def test_a_recording_that_is_a_pipe_is_refused(tmp_path: Path) -> None:
    pipe = as_pipe(tmp_path / "run.mcap")
    assert refuse("replay", pipe) == f"{pipe}: cannot be read: {IRREGULAR}\n"


def test_the_usual_folder_of_a_study_may_contain_a_pipe(tmp_path: Path) -> None:
    (tmp_path / "studies" / "classic").mkdir(parents=True)
    as_pipe(tmp_path / "studies" / "classic" / "study.toml")
    errors = refuse("study", "classic", "--delta", "0.3", cwd=tmp_path)
    assert f"studies/classic/study.toml: cannot be read: {IRREGULAR}" in errors


def test_the_lists_of_the_server_wait_for_no_pipe(client: TestClient, tmp_path: Path) -> None:
    for name in ("p.toml", "p.mcap", "p.pgm"):
        as_pipe(tmp_path / name)
    (tmp_path / "unread").mkdir()
    as_pipe(tmp_path / "unread" / "study.toml")
    assert all(row["where"] == "bundled" for row in client.get("/api/scenarios").json())
    (row,) = client.get("/api/recordings").json()
    assert row["error"] == f"cannot be read: {IRREGULAR}"
    assert client.get("/api/recordings/file", params={"id": "p.mcap"}).status_code == 404
    assert client.get("/api/studies").json()["studies"] == []


@pytest.mark.parametrize("name", ["answer.json", "ledger.sqlite"])
def test_a_study_that_has_a_pipe_is_listed_with_its_error(finished: Path, name: str) -> None:
    (finished / "answer.json").unlink()
    as_pipe(finished / name)
    (row,) = StudyManager(Workspace(finished.parent)).listed()
    assert row["state"] == "damaged"
    assert row["message"] == f"{finished / name}: cannot be read: {IRREGULAR}"


def test_a_study_with_a_lock_that_is_a_pipe_is_listed(finished: Path) -> None:
    as_pipe(finished / ".lock")
    (row,) = StudyManager(Workspace(finished.parent)).listed()
    assert row["state"] == "answered"

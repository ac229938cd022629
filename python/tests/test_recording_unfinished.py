"""A recording that a program is still writing is not a truncated one."""

import json
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from command_line import refuse, succeed
from page_client import Page
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy.whole_file import is_being_written

NAME = "run.mcap"

WRITER = """
import sys
import agent_economy as ae
with ae.Recording(ae.Simulation("search-beliefs", 7), sys.argv[1], flush_s=1.0) as recording:
    recording.step(60)
    print("written", flush=True)
    sys.stdin.readline()
"""
"""Writes six seconds of a run, and closes the recording when it gets a line."""


@pytest.fixture
def writer(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Return a program that is writing a recording in the server's folder."""
    command, pipe = [sys.executable, "-c", WRITER, str(tmp_path / NAME)], subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        try:
            assert process.stdout
            assert process.stdout.readline() == "written\n"
            yield process
        finally:
            process.kill()


def row(client: TestClient) -> dict[str, Any]:
    """Return the only row of the list of recordings."""
    (only,) = client.get("/api/recordings").json()
    assert isinstance(only, dict)
    return only


def test_a_recording_in_progress_is_listed_with_its_length_so_far_until_it_is_complete(
    client: TestClient, writer: subprocess.Popen[str]
) -> None:
    run = row(client)["run"]
    assert (run["is_being_written"], run["steps"], row(client)["error"]) == (True, None, None)
    assert 5.0 <= run["length_s"] <= 6.0
    writer.communicate("\n", timeout=60)
    run = row(client)["run"]
    assert (run["is_being_written"], run["steps"]) == (False, 60)
    assert run["length_s"] == pytest.approx(6.0)


def test_a_recording_whose_program_was_killed_is_truncated(
    client: TestClient, writer: subprocess.Popen[str]
) -> None:
    writer.kill()
    writer.wait(60)
    run = row(client)["run"]
    assert (run["is_being_written"], run["steps"], run["length_s"]) == (False, None, None)


@pytest.mark.usefixtures("writer")
def test_a_recording_in_progress_opens_and_is_marked(page: Page) -> None:
    page.send("open", recording=NAME, tick=0)
    assert page.wait_for("opened")["recording"]["is_being_written"]
    assert page.wait_for("state", tick=0)["latest_tick"] >= 50


@pytest.mark.usefixtures("writer")
def test_replay_states_that_a_recording_is_still_being_written(tmp_path: Path) -> None:
    printed = succeed("replay", tmp_path / NAME).stdout
    assert "; the recording is still being written: it ends at step " in printed
    assert "truncated" not in printed
    answer = json.loads(succeed("replay", tmp_path / NAME, "--json").stdout)
    assert (answer["is_being_written"], answer["is_complete"]) == (True, False)


def test_a_recording_of_which_nothing_is_on_the_disk_yet_is_being_written(
    client: TestClient, tmp_path: Path
) -> None:
    fcntl = pytest.importorskip("fcntl")
    with (tmp_path / NAME).open("wb") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        words = "; it is still being written: try again later"
        assert row(client)["error"].endswith(words)
        assert refuse("replay", tmp_path / NAME).endswith(f"{words}\n")
    assert "still being written" not in row(client)["error"]


@pytest.mark.usefixtures("writer")
def test_looking_at_a_recording_leaves_its_writer_the_lock(tmp_path: Path) -> None:
    for _ in range(1000):
        assert is_being_written(tmp_path / NAME)
    with pytest.raises(ae.InputError, match="is being written"):
        ae.Recording(ae.Simulation("search-beliefs", 7), tmp_path / NAME)


def test_looking_at_a_recording_keeps_no_program_from_replacing_it(tmp_path: Path) -> None:
    file, has_ended = tmp_path / NAME, threading.Event()
    file.touch()

    def look() -> None:
        while not has_ended.is_set():
            is_being_written(file)

    looking = threading.Thread(target=look)
    looking.start()
    try:
        for _ in range(50):
            ae.Recording(ae.Simulation("search-beliefs", 7), file).close()
    finally:
        has_ended.set()
        looking.join()


def test_what_is_no_file_is_not_being_written(tmp_path: Path) -> None:
    assert not is_being_written(tmp_path)
    assert not is_being_written(tmp_path / "none.mcap")

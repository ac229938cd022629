"""Runs that a page saves, and recordings that it opens."""

import os
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

import pytest
from page_client import WS, Page
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy import _core
from agent_economy.runs.brain import Command
from agent_economy.runs.stepped import Change
from agent_economy.server import Workspace
from agent_economy.server.recordings.store import FOLDER, RecordingStore
from agent_economy.server.recordings.writer import RecordingWriter
from agent_economy.server.runs.timeline import Timeline

COUNT = "robots.rover.count"
FOREVER_S = 60.0


@pytest.fixture
def slowly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have each step that is saved take so long that there is time to stop."""

    def size_of_step(_: ae.Simulation) -> int:
        time.sleep(0.01)
        return 1

    monkeypatch.setattr("agent_economy.server.recordings.writer.size_of_step", size_of_step)


def saved(page: Page) -> dict[str, Any]:
    """Save a run, and return its recording's row."""
    page.send("save")
    row = page.wait_for("saved")["recording"]
    assert isinstance(row, dict)
    return row


def changed(page: Page) -> dict[str, Any]:
    """Open a run that is changed twice, and return its last state."""
    page.open(changes=[[40, COUNT, 7]], tick=60)
    page.send("change", path="robots.rover.radius_m", value=0.3)
    return page.step(10, to=70)


def until_there_are(files: int, folder: Path) -> None:
    # The limit only ends a test that hangs: a busy machine takes seconds.
    for _ in range(6000):
        if len(list(folder.glob(f"{FOLDER}/*"))) == files:
            return
        time.sleep(0.01)
    pytest.fail(f"there are not {files} files in a minute")


def turning(turn_rate_rad_s: float) -> Command:
    motion = {"speed_m_s": 0.5, "turn_rate_rad_s": turn_rate_rad_s}
    return cast("Command", {"motion": motion, "requests": [], "outbox": []})


def begun(tick: int = 30) -> Timeline:
    timeline = Timeline(ae.Scenario.load("search-beliefs"), 7, 0, [Change(10, COUNT, 6)])
    assert timeline.seek(tick, FOREVER_S)
    return timeline


def loaded(path: Path) -> Timeline:
    which, recorded = RecordingStore(Workspace(path.parent)).load(path.name)
    return Timeline(which.scenario, which.seed, which.run, recorded=recorded)


def test_a_saved_run_is_the_displayed_run_with_all_its_changes(page: Page, tmp_path: Path) -> None:
    state = changed(page)
    row = saved(page)
    assert (row["run"]["steps"], row["run"]["seed"], row["error"]) == (70, "7", None)
    again = ae.replay(tmp_path / row["id"])
    assert again.agrees
    assert again.is_complete
    assert (again.tick, again.hash) == (70, state["hash"])


def test_a_saved_classic_run_is_the_displayed_run_and_can_be_opened(
    page: Page, client: TestClient, tmp_path: Path
) -> None:
    page.open(scenario="classic", tick=60)
    page.send("change", path="robots.wanderer.count", value=7)
    page.send("change", path="clock.paints_per_s", value=28)
    state = page.step(40, to=100)
    row = saved(page)
    assert client.get("/api/recordings").json() == [row]
    assert row["run"].items() >= {"scenario": "classic.toml", "steps": 100}.items()
    assert row["error"] is None
    assert row["run"]["length_s"] == pytest.approx(60 / 56 + 40 / 28)
    again = ae.replay(tmp_path / row["id"])
    assert (again.agrees, again.tick, again.hash) == (True, 100, state["hash"])
    opened = page.open_recording(row["id"], tick=100)
    assert (opened["hash"], opened["latest_tick"]) == (state["hash"], 100)
    assert opened["mismatch_tick"] is None
    page.send("undo")
    assert page.wait_for("setting")["step_s"] == 1 / 56
    assert saved(page)["id"] != row["id"]


def test_a_classic_run_that_differs_from_its_recording_is_reported_with_its_tick(
    page: Page, tmp_path: Path
) -> None:
    path = tmp_path / "behind.mcap"
    simulation, other = (ae.ClassicSimulation("classic", seed) for seed in (7, 8))
    with ae.Recording(simulation, path) as recording:
        recording.step(30)
        other.step(31)
        # The recording does not contain this: from here on it is another run.
        simulation._run.restore(other._run.snapshot())
        recording.step(20)
    state = page.open_recording("behind.mcap", tick=40)
    assert state["mismatch_tick"] == ae.replay(path).mismatch_tick == 32


def test_the_same_run_saved_again_is_the_same_file(page: Page, client: TestClient) -> None:
    changed(page)
    assert saved(page)["id"] == saved(page)["id"]
    assert len(client.get("/api/recordings").json()) == 1


def test_a_recording_is_opened_at_any_tick_and_continues(page: Page) -> None:
    state = changed(page)
    name = saved(page)["id"]
    page.send("open", recording=name, tick=50)
    opened = page.wait_for("opened")
    assert (opened["seed"], opened["recording"]["id"]) == ("7", name)
    setting = page.wait_for("setting")
    assert (setting["log"], setting["changes"]) == (None, [[40, COUNT, 7]])
    assert page.wait_for("state", tick=50)["latest_tick"] == 70
    last = page.seek(70)
    assert (last["hash"], last["mismatch_tick"]) == (state["hash"], None)
    page.send("step", steps=5)
    page.wait_for("state", tick=75, latest_tick=75)


def test_a_recording_with_other_changes_is_opened_as_that_run(page: Page) -> None:
    changed(page)
    name = saved(page)["id"]
    page.send("open", recording=name, tick=45)
    page.wait_for("state", tick=45)
    page.send("change", path=COUNT, value=2)
    log = page.wait_for("setting", log=[[40, COUNT, 7], [45, COUNT, 2]])["log"]
    state = page.step(15, to=60)
    assert page.open_recording(name, changes=log, tick=60)["hash"] == state["hash"]


def test_external_percepts_are_replayed(tmp_path: Path) -> None:
    path = tmp_path / "outside.mcap"
    with ae.Recording(ae.Simulation("search-beliefs", 7), path) as recording:
        recording.step(10)
        for turn_rate_rad_s in (1.0, -1.0, 0.5):
            recording.step(commands={"rover/0": turning(turn_rate_rad_s)})
        recording.step(10)
        expected = recording.simulation.hash
    timeline = loaded(path)
    for tick in (23, 5, 23):
        assert timeline.seek(tick, FOREVER_S)
    assert timeline.simulation.hash == expected
    assert timeline.recorded.mismatch_tick is None
    again = RecordingWriter(timeline.history, tmp_path).write()
    assert again is not None
    assert ae.replay(again).hash == f"{expected:016x}"


def test_a_run_that_differs_from_its_recording_is_reported_with_its_tick(tmp_path: Path) -> None:
    path = tmp_path / "behind.mcap"
    simulation = ae.Simulation("search-beliefs", 7)
    with ae.Recording(simulation, path) as recording:
        recording.step(10)
        # The recording does not contain this command.
        simulation.step(commands={"rover/0": turning(1.0)})
        recording.step(10)
    timeline = loaded(path)
    assert timeline.seek(21, FOREVER_S)
    assert timeline.recorded.mismatch_tick == ae.replay(path).mismatch_tick


@pytest.mark.usefixtures("slowly")
def test_a_cancelled_recording_leaves_no_file(page: Page, tmp_path: Path) -> None:
    page.open()
    page.finish()
    page.send("save")
    page.wait_for("saving")
    page.send("cancel_save")
    assert page.wait_for("saved")["recording"] is None
    assert list((tmp_path / FOLDER).iterdir()) == []


@pytest.mark.usefixtures("slowly")
def test_one_recording_at_a_time_is_saved(page: Page) -> None:
    page.open()
    page.finish()
    page.send("save")
    assert "one recording at a time" in page.refusal("save")
    assert page.wait_for("saved")["recording"]["error"] is None


@pytest.mark.usefixtures("slowly")
def test_a_page_that_disconnects_leaves_no_file(client: TestClient, tmp_path: Path) -> None:
    with client.websocket_connect(WS) as socket:
        page = Page(socket)
        page.open()
        page.finish()
        page.send("save")
        until_there_are(1, tmp_path)
    until_there_are(0, tmp_path)


SAVES = """
import sys, time
from pathlib import Path
import agent_economy as ae
from agent_economy.server.recordings import writer
from agent_economy.server.recordings.history import RunHistory

def size_of_step(_):
    time.sleep(0.05)
    return 1

writer.size_of_step = size_of_step
history = RunHistory(ae.Scenario.load("classic"), 1, 0, (), {}, 100_000)
writer.RecordingWriter(history, Path(sys.argv[1])).write()
"""


@contextmanager
def another_that_saves(folder: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Have another process save a run that takes long."""
    before = set(folder.iterdir())
    process = subprocess.Popen([sys.executable, "-c", SAVES, str(folder)])
    try:
        deadline = time.monotonic() + 30
        while not any(file.stat().st_size for file in set(folder.iterdir()) - before):
            assert time.monotonic() < deadline
            time.sleep(0.02)
        yield process
    finally:
        process.kill()
        process.wait()


@pytest.mark.skipif(sys.platform == "win32", reason="no file locks")
def test_files_of_a_killed_server_are_removed_and_those_being_written_are_kept(
    tmp_path: Path,
) -> None:
    with another_that_saves(tmp_path) as killed:
        killed.kill()
        killed.wait()
    (left,) = tmp_path.iterdir()
    with another_that_saves(tmp_path) as living:
        assert not left.exists()
        (written,) = tmp_path.iterdir()
        size = written.stat().st_size
        file = RecordingWriter(begun(5).history, tmp_path).write()
        assert file is not None
        assert set(tmp_path.iterdir()) == {written, file}
        assert living.poll() is None
        assert written.stat().st_size >= size


def test_without_locks_nothing_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agent_economy.whole_file.fcntl", None)
    (left := tmp_path / ".unfinished-1.mcap").touch()
    file = RecordingWriter(begun(5).history, tmp_path).write()
    assert set(tmp_path.iterdir()) == {left, file}


def test_files_that_only_look_temporary_are_kept(tmp_path: Path) -> None:
    (folder := tmp_path / ".unfinished-folder.mcap").mkdir()
    (link := tmp_path / ".unfinished-link.mcap").symlink_to(tmp_path / "elsewhere")
    (other := tmp_path / ".unfinished-notes.txt").touch()
    file = RecordingWriter(begun(5).history, tmp_path).write()
    assert set(tmp_path.iterdir()) == {folder, link, other, file}


def test_a_run_that_is_too_long_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agent_economy.server.recordings.writer.MAX_ROBOT_STEPS", 100)
    with pytest.raises(ae.InputError, match="maximum is 100 robot steps"):
        RecordingWriter(begun(30).history, tmp_path).write()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_without_write_permission_is_reported(page: Page, tmp_path: Path) -> None:
    (tmp_path / FOLDER).write_text("not a folder")
    page.open(tick=5)
    page.send("save")
    state = page.wait_for("refused", about="save")["errors"][0]["message"]
    assert f"{FOLDER}: cannot be written" in state


def test_a_link_out_of_the_folder_is_rejected(
    page: Page, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    (tmp_path / FOLDER).symlink_to(tmp_path_factory.mktemp("elsewhere"))
    page.open(tick=5)
    assert "not below the folder" in page.refusal("save")


def test_a_full_disk_is_reported_and_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        message = "No space left on device"
        raise OSError(28, message)

    history = begun().history
    monkeypatch.setattr("agent_economy.recording.file.Output.flush", full)
    with pytest.raises(ae.InputError, match="cannot be written: No space left"):
        RecordingWriter(history, tmp_path).write()
    assert list(tmp_path.iterdir()) == []


def test_recordings_are_listed_newest_first_with_their_runs(
    client: TestClient, tmp_path: Path
) -> None:
    (tmp_path / "deep" / "er").mkdir(parents=True)
    names = ["deep/er/first.mcap", "second.mcap", "cut.mcap", "damaged.mcap", ".hidden.mcap"]
    for age, name in enumerate(names):
        path = tmp_path / name
        ae.run("search-beliefs", seed=2**64 - 1, run=age, record=path)
        os.utime(path, (1000 - age, 1000 - age))
    whole = (tmp_path / "cut.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "damaged.mcap").write_bytes(b"no recording at all")
    for age, name in enumerate(names):
        os.utime(tmp_path / name, (1000 - age, 1000 - age))
    rows = client.get("/api/recordings").json()
    assert [row["id"] for row in rows] == names[:4]
    steps = ae.replay(tmp_path / names[0]).tick
    of = rows[0]["run"]
    assert (of["scenario"], of["seed"], of["run"]) == ("search-beliefs.toml", str(2**64 - 1), "0")
    assert of["steps"] == steps
    assert of["length_s"] == pytest.approx(steps / 10)
    assert rows[2]["run"]["steps"] is None
    assert "not an MCAP file" in rows[3]["error"]


def test_a_truncated_recording_is_opened_up_to_its_end(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "cut.mcap"
    ae.run("search-beliefs", seed=7, record=path)
    whole = path.read_bytes()
    path.write_bytes(whole[: 2 * len(whole) // 3])
    edge = page.open_recording("cut.mcap")["latest_tick"]
    assert edge > 0
    assert page.seek(edge)["mismatch_tick"] is None


@pytest.mark.parametrize(
    "name", ["../secret.mcap", "/etc/passwd", "link.mcap", "nothing.mcap", "a\0b.mcap", "search"]
)
def test_no_recording_outside_of_the_folder_is_opened_or_sent(
    client: TestClient, page: Page, tmp_path: Path, name: str
) -> None:
    secret = tmp_path.parent / "secret.mcap"
    secret.write_bytes(b"secret")
    (tmp_path / "link.mcap").symlink_to(secret)
    assert client.get("/api/recordings/file", params={"id": name}).status_code == 404
    assert "below the folder" in page.refusal("open", recording=name)


def test_a_recording_can_be_downloaded(client: TestClient, page: Page, tmp_path: Path) -> None:
    page.open(tick=5)
    name = saved(page)["id"]
    state = client.get("/api/recordings/file", params={"id": name})
    assert state.content == (tmp_path / name).read_bytes()
    assert "attachment" in state.headers["content-disposition"]


def exported(page: Page) -> str:
    page.send("export")
    text = page.wait_for("exported")["text"]
    assert isinstance(text, str)
    return text


def test_the_exported_scenario_contains_the_changes(page: Page) -> None:
    page.open(tick=20)
    obstacles = ae.Scenario.load("search-beliefs").to_dict()["world"]["obstacles"]
    page.send("change", path="robots.rover.sensors.camera.range_m", value=2.5)
    page.send("change", path="world.obstacles", value=obstacles[1:])
    text = exported(page)
    expected = ae.Scenario.load("search-beliefs")
    expected = expected.replace("robots.rover.sensors.camera.range_m", 2.5)
    expected = expected.replace("world.obstacles", obstacles[1:])
    assert ae.Scenario.loads(text).to_dict() == expected.to_dict()
    assert text.startswith("# From search-beliefs, seed 7, run 0, at tick 20 (2 s).\n")


def test_an_unchanged_scenario_is_exported_with_its_comments(page: Page) -> None:
    page.open()
    source = ae.Scenario.load("search-beliefs").source.text
    assert exported(page).endswith(source)
    assert tomllib.loads(exported(page)) == tomllib.loads(source)


def test_a_setting_contains_the_values_of_robot_models_and_the_item_kinds(page: Page) -> None:
    page.open(scenario="open-field")
    setting = [each for each in page.received if each["type"] == "setting"][-1]
    source = ae.Scenario.load("open-field").source
    assert setting["document"] == _core.read_filled(source)
    assert {"radius_m", "drive"} <= setting["document"]["robots"]["rover"].keys()
    assert setting["item_kinds"] == sorted(setting["document"]["items"])

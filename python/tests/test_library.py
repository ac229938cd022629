"""Titles, notes, tags, copies and deletions of studies, recordings and scenarios."""

import fcntl
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from page_client import OWN
from small_study import run_plan
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy import study
from agent_economy.scenario import bundled
from agent_economy.server import Workspace, app
from agent_economy.server.library.kinds import KINDS

Response = dict[str, Any]

TEXT = ae.Scenario.load("search").source.text

IDS = {"studies": "studies/one", "recordings": "recordings/one.mcap", "scenarios": "mine/one.toml"}
KIND_NAMES = list(IDS)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with one entry of each kind."""
    folder = tmp_path_factory.mktemp("made")
    run_plan(folder / IDS["studies"])
    for name in ("recordings", "mine"):
        (folder / name).mkdir()
    ae.run("flock", record=folder / IDS["recordings"])
    (folder / IDS["scenarios"]).write_text(TEXT)
    return folder


@pytest.fixture
def folder(tmp_path: Path, made: Path) -> Path:
    """Return the server's folder, with one entry of each kind."""
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path


def post(client: TestClient, address: str, **body: Any) -> Response:
    response = client.post(f"/api/library/{address}", json=body)
    assert response.status_code == 200, response.text
    answer: Response = response.json()
    return answer


def refused(client: TestClient, address: str, **body: Any) -> str:
    response = client.post(f"/api/library/{address}", content=json.dumps(body))
    assert response.status_code == 422, response.text
    return " ".join(error["message"] for error in response.json()["errors"])


def listed(client: TestClient, kind: str) -> dict[str, Response]:
    rows = client.get(f"/api/library/{kind}").raise_for_status().json()["entries"]
    return {row["id"]: row for row in rows if not row["is_bundled"]}


def ids_of_page(client: TestClient, kind: str) -> set[str]:
    """Return the ids in the list of the page, without bundled scenarios."""
    rows = client.get(f"/api/{kind}").raise_for_status().json()
    rows = rows["studies"] if isinstance(rows, dict) else rows
    return {row["id"] for row in rows if row.get("where") != "bundled"}


def files_in(folder: Path) -> dict[str, bytes]:
    """Return the content of all files that are not hidden."""
    found = (file for file in folder.rglob("*") if file.is_file())
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in found
        if not any(part.startswith(".") for part in file.relative_to(folder).parts)
    }


def test_every_kind_of_entry_is_tested() -> None:
    assert [kind.name for kind in KINDS] == KIND_NAMES


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_a_title_a_note_and_tags_are_kept_and_change_neither_the_id_nor_a_file_of_the_entry(
    client: TestClient, folder: Path, kind: str
) -> None:
    before = files_in(folder)
    tags = ["wind", "for the paper"]
    row = post(client, f"{kind}/label", id=IDS[kind], title=" First try ", tags=[*tags, "wind", ""])
    assert (row["id"], row["title"], row["note"], row["tags"]) == (IDS[kind], "First try", "", tags)
    row = post(client, f"{kind}/label", id=IDS[kind], note="Two\nlines")
    assert (row["title"], row["note"], row["tags"]) == ("First try", "Two\nlines", tags)
    with TestClient(app(Workspace(folder), "127.0.0.1"), OWN) as other:
        assert listed(other, kind)[IDS[kind]] == row
        assert other.get(f"/api/library/{kind}/entry", params={"id": IDS[kind]}).json() == row
    assert files_in(folder).items() > before.items()
    post(client, f"{kind}/label", id=IDS[kind], title="", note="", tags=[])
    assert files_in(folder) == before


def test_a_renamed_study_is_resumed_from_its_folder_and_keeps_its_identity(
    client: TestClient, folder: Path
) -> None:
    place = folder / IDS["studies"]
    identity = study.load_plan(place).identity
    post(client, "studies/label", id=IDS["studies"], title="Renamed")
    assert study.load_plan(place).identity == identity
    answer = (place / "answer.json").read_bytes()
    study.resume(place)
    assert (place / "answer.json").read_bytes() == answer
    assert listed(client, "studies")[IDS["studies"]]["title"] == "Renamed"


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_a_label_moves_with_the_folder(
    client: TestClient, folder: Path, tmp_path_factory: pytest.TempPathFactory, kind: str
) -> None:
    post(client, f"{kind}/label", id=IDS[kind], title="Moved")
    there = tmp_path_factory.mktemp("there") / "copy"
    shutil.copytree(folder, there)
    with TestClient(app(Workspace(there), "127.0.0.1"), OWN) as other:
        assert listed(other, kind)[IDS[kind]]["title"] == "Moved"


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_sizes_are_those_of_the_files(client: TestClient, folder: Path, kind: str) -> None:
    post(client, f"{kind}/label", id=IDS[kind], note="x" * 999)
    path = folder / IDS[kind]
    files = [path] if path.is_file() else [each for each in path.rglob("*") if each.is_file()]
    expected = sum(file.stat().st_size for file in files if file.name != "label.json")
    assert listed(client, kind)[IDS[kind]]["bytes"] == expected


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_a_deleted_entry_comes_back_with_undo(client: TestClient, folder: Path, kind: str) -> None:
    post(client, f"{kind}/label", id=IDS[kind], title="Mine", tags=["a"])
    before, row = files_in(folder), listed(client, kind)[IDS[kind]]
    deleted = post(client, f"{kind}/delete", id=IDS[kind])
    assert deleted.items() >= {"kind": kind, "id": IDS[kind], "title": "Mine"}.items()
    assert IDS[kind] not in ids_of_page(client, kind)
    assert listed(client, kind) == {}
    assert "is not in the trash" not in refused(client, f"{kind}/delete", id=IDS[kind])
    with TestClient(app(Workspace(folder), "127.0.0.1"), OWN) as other:
        assert post(other, "undo", token=deleted["token"])["id"] == IDS[kind]
    assert files_in(folder) == before
    assert listed(client, kind)[IDS[kind]] == row
    assert list((folder / ".agent-economy" / "trash").iterdir()) == []
    assert "is not in the trash any more" in refused(client, "undo", token=deleted["token"])


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_undo_is_refused_while_the_name_is_taken(
    client: TestClient, folder: Path, made: Path, kind: str
) -> None:
    deleted = post(client, f"{kind}/delete", id=IDS[kind])
    path = folder / IDS[kind]
    (shutil.copytree if (made / IDS[kind]).is_dir() else shutil.copy)(made / IDS[kind], path)
    assert f"{IDS[kind]}: exists again" in refused(client, "undo", token=deleted["token"])
    path.rename(folder / "elsewhere")
    post(client, "undo", token=deleted["token"])
    assert IDS[kind] in ids_of_page(client, kind)


def test_an_entry_comes_back_to_a_folder_that_was_removed(client: TestClient, folder: Path) -> None:
    deleted = post(client, "recordings/delete", id=IDS["recordings"])
    (folder / "recordings").rmdir()
    post(client, "undo", token=deleted["token"])
    assert (folder / IDS["recordings"]).is_file()


def test_a_copy_of_a_study_has_its_question_and_none_of_its_runs(
    client: TestClient, folder: Path
) -> None:
    post(client, "studies/label", id=IDS["studies"], title="Mine", tags=["a"])
    row = post(client, "studies/duplicate", id=IDS["studies"])
    assert (row["id"], row["title"], row["tags"]) == ("studies/one-copy", "Copy of Mine", ["a"])
    plans = [study.load_plan(folder / each) for each in (IDS["studies"], row["id"])]
    assert plans[0].identity == plans[1].identity
    rows = {each["id"]: each for each in client.get("/api/studies").json()["studies"]}
    assert (rows[row["id"]]["state"], rows[row["id"]]["runs"]) == ("stopped", 0)
    study.resume(folder / row["id"])
    answers = [(folder / each / "answer.json").read_bytes() for each in rows]
    assert answers[0] == answers[1]


@pytest.mark.parametrize("kind", ["recordings", "scenarios"])
def test_a_copy_of_a_file_has_its_bytes_and_a_free_name(
    client: TestClient, folder: Path, kind: str
) -> None:
    first, second, third = (
        post(client, f"{kind}/duplicate", id=name)["id"]
        for name in (IDS[kind], IDS[kind], IDS[kind].replace("one", "one-copy"))
    )
    names = [IDS[kind].replace("one", f"one-copy{ending}") for ending in ("", "-2", "-3")]
    assert [first, second, third] == names
    assert {(folder / name).read_bytes() for name in (IDS[kind], *names)} == {
        (folder / IDS[kind]).read_bytes()
    }
    assert ids_of_page(client, kind) == {IDS[kind], *names}


def test_bundled_scenarios_can_be_duplicated_only(client: TestClient, tmp_path: Path) -> None:
    for name, file in bundled.scenarios().items():
        for change in ("delete", "label"):
            assert "is bundled" in refused(client, f"scenarios/{change}", id=name, title="x")
        copy = post(client, "scenarios/duplicate", id=name)["id"]
        assert copy == f"{name}-copy.toml"
        assert (tmp_path / copy).read_bytes() == file.read_bytes()
        Workspace(tmp_path).load(copy)
    assert all(file.is_file() for file in bundled.scenarios().values())


def test_a_map_of_a_bundled_scenario_replaces_no_file_of_the_user(
    client: TestClient, tmp_path: Path
) -> None:
    (tmp_path / "open-field.yaml").write_text("mine")
    assert "open-field.yaml: exists with other content" in refused(
        client, "scenarios/duplicate", id="open-field"
    )
    assert (tmp_path / "open-field.yaml").read_text() == "mine"


def test_a_running_study_is_not_deleted(client: TestClient, folder: Path) -> None:
    with (folder / IDS["studies"] / ".lock").open("w") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        assert "one: is running: stop it first" in refused(
            client, "studies/delete", id=IDS["studies"]
        )
        post(client, "studies/label", id=IDS["studies"], title="Running")
    assert listed(client, "studies")[IDS["studies"]]["title"] == "Running"
    post(client, "studies/delete", id=IDS["studies"])


def test_a_recording_that_is_being_written_is_neither_deleted_nor_copied(
    client: TestClient, tmp_path: Path
) -> None:
    with ae.Recording(ae.Simulation("flock", 7), tmp_path / "new.mcap") as recording:
        recording.step(3)
        for change in ("delete", "duplicate"):
            assert "new.mcap: is being written" in refused(
                client, f"recordings/{change}", id="new.mcap"
            )
    post(client, "recordings/delete", id="new.mcap")


OUTSIDE_IDS: list[Any] = [
    "../secret.toml",
    "../secret.mcap",
    "../secret",
    "mine/../../secret.toml",
    "mine/../mine/one.toml",
    "./mine/one.toml",
    "mine//one.toml",
    "/etc/passwd",
    "link/secret.toml",
    "link/secret.mcap",
    "link",
    "secret-link.toml",
    ".hidden/one.toml",
    ".agent-economy/trash",
    "mine/one.toml\0",
    "mine",
    "x" * 300 + ".toml",
    "x/" * 5000,
    "no\nsuch.mcap",
    "\ud800.toml",
    ".",
    "",
    "other.toml",
    7,
    None,
    ["mine/one.toml"],
    {},
]


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_no_id_leads_out_of_the_folder_or_to_what_is_in_no_list(folder: Path, kind: str) -> None:
    served = folder / "served"
    (served / ".hidden").mkdir(parents=True)
    shutil.copytree(folder / "mine", served / "mine")
    shutil.copy(folder / "mine/one.toml", served / ".hidden")
    shutil.copytree(folder / "studies/one", folder / "secret")
    shutil.copy(folder / "mine/one.toml", folder / "secret.toml")
    shutil.copy(folder / "recordings/one.mcap", folder / "secret.mcap")
    (served / "link").symlink_to(folder)
    (served / "secret-link.toml").symlink_to(folder / "secret.toml")
    (served / "other.toml").write_text("a = 1\n")
    before = files_in(folder)
    with TestClient(app(Workspace(served), "127.0.0.1"), OWN) as client:
        for name in OUTSIDE_IDS:
            for change in ("label", "duplicate", "delete"):
                assert refused(client, f"{kind}/{change}", id=name, title="x")
            if isinstance(name, str) and name.isprintable():
                response = client.get(f"/api/library/{kind}/entry", params={"id": name})
                assert response.status_code == 422
    assert files_in(folder) == before


def test_the_server_s_folder_itself_is_not_deleted(made: Path, tmp_path: Path) -> None:
    shutil.copytree(made / IDS["studies"], tmp_path, dirs_exist_ok=True)
    with TestClient(app(Workspace(tmp_path), "127.0.0.1"), OWN) as client:
        for change in ("delete", "duplicate"):
            assert "folder itself cannot be" in refused(client, f"studies/{change}", id=".")
        assert post(client, "studies/label", id=".", title="All")["title"] == "All"


BAD_LABELS: list[Response] = [
    {"title": 7},
    {"title": None},
    {"title": "x" * 201},
    {"title": "x" * 900_000},
    {"title": "a\nb"},
    {"title": "a\0b"},
    {"title": "\ud800"},
    {"title": "a\u202eb"},
    {"note": "x" * 10_001},
    {"note": "a\x1bb"},
    {"note": []},
    {"tags": "a"},
    {"tags": {"a": 1}},
    {"tags": [7]},
    {"tags": ["x" * 61]},
    {"tags": ["a,b"]},
    {"tags": ["a\nb"]},
    {"tags": [f"tag {i}" for i in range(10_000)]},
    {"tags": ["\udfff"]},
]


@pytest.mark.parametrize("label", BAD_LABELS, ids=lambda label: repr(label)[:40])
def test_a_bad_label_is_refused_with_its_limit(
    client: TestClient, folder: Path, label: Response
) -> None:
    before = files_in(folder)
    message = refused(client, "scenarios/label", id=IDS["scenarios"], **label)
    assert "must be" in message
    assert len(message) < 300
    assert files_in(folder) == before


def odd_request(client: TestClient, address: str, content: bytes) -> int:
    return client.post(f"/api/library/{address}", content=content).status_code


def test_requests_that_are_no_objects_are_refused(client: TestClient) -> None:
    for content in (b"", b"[]", b"7", b"\xff", b"{", b"[" * 99_999):
        assert odd_request(client, "studies/delete", content) == 422
        assert odd_request(client, "undo", content) == 422
    assert odd_request(client, "studies/label", b"x" * 2_000_000) == 413
    assert client.post("/api/library/robots/delete", json={}).status_code in (404, 405)
    for token in (None, 7, "", "..", "../../x", "0" * 32, "\ud800", ["a"]):
        assert refused(client, "undo", token=token)


def removed(file: Path) -> Path:
    """Remove a file, and return its path."""
    file.unlink()
    return file


DAMAGES: dict[str, Callable[[Path], object]] = {
    "no JSON": lambda file: file.write_text("{"),
    "a list": lambda file: file.write_text("[]"),
    "a number as title": lambda file: file.write_text('{"title": 7}'),
    "a lone surrogate": lambda file: file.write_text('{"title": "\\ud800"}'),
    "many tags": lambda file: file.write_text(json.dumps({"tags": list("ab") * 5000})),
    "bytes": lambda file: file.write_bytes(b"\xff\xfe"),
    "deep": lambda file: file.write_text("[" * 99_999),
    "large": lambda file: os.truncate(file, 2**40),
    "a pipe": lambda file: os.mkfifo(removed(file)),
    "a folder": lambda file: removed(file).mkdir(),
    "a link out": lambda file: removed(file).symlink_to("/etc/hostname"),
    "a circle": lambda file: removed(file).symlink_to(file.name),
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("kind", KIND_NAMES)
def test_a_damaged_label_is_reported_and_kept_when_another_one_is_set(
    client: TestClient, folder: Path, kind: str, damage: str
) -> None:
    post(client, f"{kind}/label", id=IDS[kind], title="Good")
    path = folder / IDS[kind]
    file = path / "label.json" if path.is_dir() else path.with_name(f"{path.name}.label.json")
    DAMAGES[damage](file)
    row = listed(client, kind)[IDS[kind]]
    assert (row["title"], row["tags"]) == ("", [])
    assert file.name in row["error"]
    assert IDS[kind] in ids_of_page(client, kind)
    if damage in {"a link out", "a circle"}:
        assert "a file here" in refused(client, f"{kind}/label", id=IDS[kind], title="New")
        return
    assert post(client, f"{kind}/label", id=IDS[kind], title="New")["title"] == "New"
    assert os.path.lexists(file.with_name(f"{file.name}.damaged"))
    assert listed(client, kind)[IDS[kind]]["error"] is None


def test_what_a_newer_program_adds_to_a_label_stays(client: TestClient, folder: Path) -> None:
    file = folder / "mine" / "one.toml.label.json"
    file.write_text('{"title": "Old", "stars": 5}')
    post(client, "scenarios/label", id=IDS["scenarios"], title="")
    assert json.loads(file.read_text()) == {"title": "", "note": "", "tags": [], "stars": 5}


def test_a_link_in_place_of_the_folder_of_the_library_writes_nothing_elsewhere(
    folder: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    outside = tmp_path_factory.mktemp("outside")
    (folder / ".agent-economy").symlink_to(outside)
    with TestClient(app(Workspace(folder), "127.0.0.1"), OWN) as client:
        assert "a folder here" in refused(client, "scenarios/delete", id=IDS["scenarios"])
    assert list(outside.iterdir()) == []
    assert (folder / IDS["scenarios"]).is_file()


@pytest.mark.parametrize(
    "record", ["{", "[]", "7", '{"kind": "scenarios", "id": "../x.toml"}', "null"]
)
def test_a_damaged_record_of_a_deletion_is_refused_and_nothing_is_lost(
    client: TestClient, folder: Path, record: str
) -> None:
    token = post(client, "scenarios/delete", id=IDS["scenarios"])["token"]
    place = folder / ".agent-economy" / "trash" / token
    (place / "entry.json").write_text(record)
    assert "is damaged" in refused(client, "undo", token=token)
    assert (place / "content").read_text() == TEXT


@pytest.mark.parametrize("name", ["../x.toml", "/x.toml", "a/../../x.toml", ".x.toml", "a\0"])
def test_a_forged_record_of_a_deletion_leads_nowhere_else(
    client: TestClient, folder: Path, name: str
) -> None:
    token = post(client, "scenarios/delete", id=IDS["scenarios"])["token"]
    file = folder / ".agent-economy" / "trash" / token / "entry.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "id": name}))
    assert "must be the id of an entry" in refused(client, "undo", token=token)


def test_two_servers_of_a_folder_lose_no_change(folder: Path) -> None:
    clients = [TestClient(app(Workspace(folder), "127.0.0.1"), OWN) for _ in range(2)]
    values: list[Response] = [{"title": "t"}, {"note": "n"}, {"tags": ["a"]}] * 10

    def set_value(i: int) -> None:
        post(clients[i % 2], "scenarios/label", id=IDS["scenarios"], **values[i])

    with ThreadPoolExecutor(8) as threads:
        for _ in range(3):
            list(threads.map(set_value, range(len(values))))
            row = listed(clients[0], "scenarios")[IDS["scenarios"]]
            assert (row["title"], row["note"], row["tags"]) == ("t", "n", ["a"])
            post(clients[1], "scenarios/label", id=IDS["scenarios"], title="", note="", tags=[])


def test_of_two_servers_that_delete_one_entry_one_is_refused(folder: Path) -> None:
    clients = [TestClient(app(Workspace(folder), "127.0.0.1"), OWN) for _ in range(2)]
    begin = threading.Barrier(2)

    def delete(client: TestClient) -> int:
        begin.wait()
        body = {"id": IDS["recordings"]}
        return client.post("/api/library/recordings/delete", json=body).status_code

    with ThreadPoolExecutor(2) as threads:
        assert sorted(threads.map(delete, clients)) == [200, 422]


KILLED = """
import os, signal, sys
from pathlib import Path
from agent_economy.server.library.kinds import KINDS
from agent_economy.server.library.library import Library
from agent_economy.server.workspace import Workspace

calls = 0
left = int(sys.argv[2])
def counted(own):
    def call(*args, **kwargs):
        global calls
        if calls == left:
            os.kill(os.getpid(), signal.SIGKILL)
        calls += 1
        return own(*args, **kwargs)
    return call

for name in ("rename", "replace", "mkdir", "unlink"):
    setattr(Path, name, counted(getattr(Path, name)))
library = Library(Workspace(Path(sys.argv[1])))
kind = next(each for each in KINDS if each.name == sys.argv[3])
request = {"id": sys.argv[4]}
if sys.argv[5] == "delete":
    library.delete(kind, request)
else:
    library.restore({"token": sys.argv[4]})
"""


def killed_at(folder: Path, step: int, *what: str) -> bool:
    """Return whether a change was killed before one of its steps; else it is complete."""
    command = [sys.executable, "-c", KILLED, str(folder), str(step), *what]
    code = subprocess.run(command, check=False).returncode
    assert code in (0, -signal.SIGKILL)
    return code != 0


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_whenever_a_server_is_killed_an_entry_is_in_its_place_or_in_the_trash(
    client: TestClient, folder: Path, kind: str
) -> None:
    post(client, f"{kind}/label", id=IDS[kind], title="Kept")
    path, trash = folder / IDS[kind], folder / ".agent-economy" / "trash"
    before, step, is_killed = files_in(folder), 0, True
    while is_killed:
        is_killed = killed_at(folder, step, kind, IDS[kind], "delete")
        step += 1
        if not path.exists():
            (token,) = [each.name for each in trash.iterdir() if (each / "content").exists()]
            # The undo is killed at every step too, and repeated until it is complete.
            undo_step = 0
            while not path.exists() and killed_at(folder, undo_step, kind, token, "undo"):
                undo_step += 1
        assert files_in(folder) == before
        assert listed(client, kind)[IDS[kind]]["title"] == "Kept"
    assert step > 3


def test_a_name_that_is_too_long_for_a_label_is_refused_with_words(
    client: TestClient, tmp_path: Path
) -> None:
    name = f"{'x' * 248}.toml"
    (tmp_path / name).write_text(TEXT)
    assert "name too long" in refused(client, "scenarios/label", id=name, title="x").lower()
    copy = post(client, "scenarios/duplicate", id=name)["id"]
    post(client, "scenarios/label", id=copy, title="x")
    post(client, "undo", token=post(client, "scenarios/delete", id=name)["token"])
    assert (tmp_path / name).is_file()


def test_names_with_markup_and_other_letters_are_labelled_deleted_and_restored(
    client: TestClient, tmp_path: Path
) -> None:
    for name in ['a\nb "<b>c" %2f.toml', "&?#.toml", "Größe.toml", "a b.toml"]:
        (tmp_path / name).write_text(TEXT)
        assert post(client, "scenarios/label", id=name, title="Ä <b>")["title"] == "Ä <b>"
        copy = post(client, "scenarios/duplicate", id=name)["id"]
        for each in (name, copy):
            token = post(client, "scenarios/delete", id=each)["token"]
            assert post(client, "undo", token=token)["id"] == each


def test_a_full_disk_is_reported_and_leaves_no_part_of_a_copy(
    client: TestClient, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("agent_economy.server.library.copies.shutil.copyfileobj", fail)
    message = refused(client, "recordings/duplicate", id=IDS["recordings"])
    assert "No space left on device" in message
    assert [each.name for each in (folder / "recordings").iterdir()] == ["one.mcap"]


def test_a_damaged_study_can_be_renamed_and_deleted_but_not_duplicated(
    client: TestClient, folder: Path
) -> None:
    (folder / IDS["studies"] / "study.toml").write_text("format = 1\n")
    assert "study.toml" in refused(client, "studies/duplicate", id=IDS["studies"])
    assert post(client, "studies/label", id=IDS["studies"], title="Bad")["title"] == "Bad"
    post(client, "undo", token=post(client, "studies/delete", id=IDS["studies"])["token"])


def test_a_day_of_renaming_copying_deleting_and_restoring_loses_nothing(folder: Path) -> None:
    """Two servers, hundreds of random changes of scenarios and recordings, and a model of them."""
    clients = [TestClient(app(Workspace(folder), "127.0.0.1"), OWN) for _ in range(2)]
    choose = random.Random(7)  # noqa: S311
    for kind in ("scenarios", "recordings"):
        titles, deleted = {IDS[kind]: ""}, dict[str, tuple[str, str]]()
        for i in range(200):
            client = choose.choice(clients)
            action = choose.choice(["label", "duplicate", "delete", "undo"])
            if action == "undo" and deleted:
                token = choose.choice(list(deleted))
                name, title = deleted[token]
                if name in titles:
                    assert "exists again" in refused(client, "undo", token=token)
                else:
                    titles[post(client, "undo", token=token)["id"]] = title
                    del deleted[token]
            elif action == "delete" and len(titles) > 1:
                name = choose.choice(list(titles))
                token = post(client, f"{kind}/delete", id=name)["token"]
                deleted[token] = name, titles.pop(name)
            elif action == "label":
                name = choose.choice(list(titles))
                titles[name] = post(client, f"{kind}/label", id=name, title=f"Title {i}")["title"]
            elif len(titles) < 12:
                copy = post(client, f"{kind}/duplicate", id=choose.choice(list(titles)))
                titles[copy["id"]] = copy["title"]
        rows = listed(clients[0], kind)
        assert {name: row["title"] for name, row in rows.items()} == titles
        assert ids_of_page(clients[1], kind) == set(titles)
        contents = {(folder / name).read_bytes() for name in titles}
        assert contents == {(folder / next(iter(titles))).read_bytes()}

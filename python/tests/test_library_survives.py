"""Damaged labels, killed servers, full disks and two servers of a folder lose nothing."""

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

import pytest
from library_client import (
    IDS,
    KIND_NAMES,
    TEXT,
    Response,
    files_in,
    ids_of_page,
    listed,
    make_entries,
    post,
    refused,
)
from page_client import OWN
from starlette.testclient import TestClient

from agent_economy.server import Workspace, app
from agent_economy.server.library.kinds import KINDS, Kind


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with one entry of each kind."""
    folder = tmp_path_factory.mktemp("made")
    make_entries(folder)
    return folder


@pytest.fixture
def folder(tmp_path: Path, made: Path) -> Path:
    """Return the server's folder, with one entry of each kind."""
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path


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


@pytest.mark.parametrize("change", ["delete", "duplicate", "label"])
@pytest.mark.parametrize("kind", KIND_NAMES)
def test_an_entry_that_is_removed_meanwhile_is_refused_with_words(
    client: TestClient, folder: Path, monkeypatch: pytest.MonkeyPatch, kind: str, change: str
) -> None:
    found = next(each for each in KINDS if each.name == kind)
    own = type(found).find

    def find_and_lose(self: Kind, workspace: Workspace, name: str) -> Path:
        path = own(self, workspace, name)
        shutil.move(path, folder / ".lost")
        return path

    monkeypatch.setattr(type(found), "find", find_and_lose)
    message = refused(client, f"{kind}/{change}", id=IDS[kind], title="x")
    assert "/" in message or "one" in message

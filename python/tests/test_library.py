"""Titles, notes, tags, copies and deletions of studies, recordings and scenarios."""

import fcntl
import shutil
from pathlib import Path
from typing import Any

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

import agent_economy as ae
from agent_economy import study
from agent_economy.scenario import bundled
from agent_economy.server import Workspace, app
from agent_economy.server.library.kinds import KINDS


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

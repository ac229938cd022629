"""One odd file or folder in the server's folder hides none of the others."""

import json
import os
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest
from command_line import refuse, run_process, succeed
from page_client import OWN
from small_study import run_plan
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy import study
from agent_economy.server import Workspace, app
from agent_economy.study.store.folder import MAX_BYTES

ODD = os.fsdecode(b"caf\xe9")
"""A name that is not UTF-8, as from an old archive."""

FIELD = ae.Scenario.load("search").source.text


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished study."""
    folder = tmp_path_factory.mktemp("answered") / "study"
    run_plan(folder)
    return folder


def listed(client: TestClient, address: str) -> list[str]:
    """Return the ids in a list of the server, without bundled scenarios."""
    rows = client.get(address).raise_for_status().json()
    rows = rows["studies"] if isinstance(rows, dict) else rows
    return [row["id"] for row in rows if row.get("where") != "bundled"]


def test_a_name_that_is_not_utf_8_is_left_out_of_each_list(
    client: TestClient, tmp_path: Path, answered: Path
) -> None:
    ae.run("flock", record=tmp_path / "good.mcap")
    (tmp_path / ODD).mkdir()
    for folder in (tmp_path, tmp_path / ODD):
        (folder / f"{ODD}.toml").write_text(FIELD)
        (folder / "good.toml").write_text(FIELD)
        shutil.copy(tmp_path / "good.mcap", folder / f"{ODD}.mcap")
        shutil.copytree(answered, folder / f"{ODD}-study")
    shutil.copytree(answered, tmp_path / "study")
    assert listed(client, "/api/scenarios") == ["good.toml"]
    assert listed(client, "/api/recordings") == ["good.mcap"]
    assert listed(client, "/api/studies") == ["study"]


def test_names_with_line_feeds_quotes_and_markup_are_listed_and_opened(
    client: TestClient, tmp_path: Path
) -> None:
    names = ['a\nb "<b>c" %2f.toml', "&?#.toml", "Größe.toml"]
    for name in names:
        (tmp_path / name).write_text(FIELD)
    assert set(listed(client, "/api/scenarios")) == set(names)
    for name in names:
        assert client.get("/api/pictures", params={"scenario": name}).status_code == 200


def test_folders_and_links_in_place_of_files_hide_nothing(
    client: TestClient, tmp_path: Path
) -> None:
    (tmp_path / "good.toml").write_text(FIELD)
    for ending in ("toml", "mcap"):
        (tmp_path / f"folder.{ending}").mkdir()
        (tmp_path / f"broken.{ending}").symlink_to("nothing")
        (tmp_path / f"circle.{ending}").symlink_to(f"circle.{ending}")
        (tmp_path / f"{'x' * 240}.{ending}").touch()
    (tmp_path / "circle").symlink_to("circle")
    (tmp_path / "study.toml").mkdir()
    assert listed(client, "/api/scenarios") == ["good.toml"]
    assert "circle.mcap" not in listed(client, "/api/recordings")
    assert listed(client, "/api/studies") == []


def test_a_folder_that_is_removed_or_unreadable_hides_nothing(
    client: TestClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "good.toml").write_text(FIELD)
    (tmp_path / "gone").mkdir()
    (tmp_path / "locked").mkdir()
    own: Callable[[Path], object] = Path.iterdir
    is_dir = Path.is_dir

    def iterdir(folder: Path) -> object:
        if folder.name == "gone":
            raise FileNotFoundError
        return own(folder)

    def checked(path: Path) -> bool:
        if path.name == "locked":
            raise PermissionError
        return is_dir(path)

    monkeypatch.setattr(Path, "iterdir", iterdir)
    monkeypatch.setattr(Path, "is_dir", checked)
    assert listed(client, "/api/scenarios") == ["good.toml"]
    assert listed(client, "/api/recordings") == []
    assert listed(client, "/api/studies") == []


def damaged_ledger(folder: Path, facts: str) -> None:
    """Replace what the ledger of a study knows of its rounds."""
    (folder / "answer.json").unlink()
    with closing(sqlite3.connect(folder / "ledger.sqlite")) as ledger, ledger:
        ledger.execute("UPDATE decision SET facts = ?", (facts,))


def no_ledger(folder: Path) -> None:
    """Replace the ledger of a study by other bytes."""
    (folder / "answer.json").unlink()
    (folder / "ledger.sqlite").write_bytes(b"x" * 9999)


def changed_answer(folder: Path, **values: object) -> None:
    """Change entries of the answer of a study."""
    file = folder / "answer.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | values))


def enlarged(file: Path) -> None:
    """Give a file a size that no memory has, without any content."""
    os.truncate(file, 2**42)


DAMAGES: dict[str, Callable[[Path], object]] = {
    "ledger: no JSON": lambda folder: damaged_ledger(folder, "{"),
    "ledger: no runs": lambda folder: damaged_ledger(folder, "{}"),
    "ledger: a list": lambda folder: damaged_ledger(folder, "[1]"),
    "ledger: no number": lambda folder: damaged_ledger(folder, '{"runs": "x"}'),
    "ledger: bytes": no_ledger,
    "answer: NaN": lambda folder: changed_answer(folder, runs=float("nan")),
    "answer: a list": lambda folder: changed_answer(folder, runs=[]),
    "answer: surrogate": lambda folder: changed_answer(folder, sentence="\ud800"),
    "answer: no scenario": lambda folder: changed_answer(folder, scenario=7),
    "answer: no name": lambda folder: changed_answer(folder, scenario={"design": "factorial"}),
    "answer: large": lambda folder: enlarged(folder / "answer.json"),
    "question: nan": lambda folder: (folder / "study.toml").write_text(
        'data = {}\n[question]\nconfidence = nan\ndelta = 1\nguarantee = "pgs"'
    ),
    "question: date": lambda folder: (folder / "study.toml").write_text(
        "data = {}\n[question]\nconfidence = 1\ndelta = 2001-01-01\nguarantee = 1"
    ),
    "question: deep": lambda folder: (folder / "study.toml").write_text("a = " + "[" * 9999),
    "question: large": lambda folder: enlarged(folder / "study.toml"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_study_is_listed_as_damaged_beside_the_others(
    client: TestClient, tmp_path: Path, answered: Path, damage: str
) -> None:
    for name in ("bad", "good"):
        shutil.copytree(answered, tmp_path / name)
    DAMAGES[damage](tmp_path / "bad")
    rows = {row["id"]: row for row in client.get("/api/studies").json()["studies"]}
    assert rows["good"]["state"] == "answered"
    assert rows["bad"]["state"] == "damaged"
    assert str(tmp_path / "bad") in rows["bad"]["message"]


@pytest.mark.parametrize("text", ["data = 3", "data = [3]", f"a = {'[' * 9999}", ""])
def test_an_unfinished_study_with_any_question_is_listed(
    client: TestClient, tmp_path: Path, text: str
) -> None:
    (tmp_path / "study.toml").mkdir()
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "study.toml").write_text(f"format = 1\n{text}")
    (row,) = client.get("/api/studies").json()["studies"]
    assert row["state"] == "damaged"


def test_a_study_that_is_removed_meanwhile_hides_nothing(
    client: TestClient, tmp_path: Path, answered: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(answered, tmp_path / "good")
    found = [("gone", tmp_path / "gone"), ("good", tmp_path / "good")]
    monkeypatch.setattr(Workspace, "studies", lambda _: iter(found))
    assert listed(client, "/api/studies") == ["good"]


def test_a_server_in_a_folder_that_is_not_utf_8_reports_errors_with_its_escaped_name(
    tmp_path: Path, answered: Path
) -> None:
    folder = tmp_path / ODD
    shutil.copytree(answered, folder / "study")
    (folder / "study" / "answer.json").write_text("{")
    (folder / "bad.mcap").write_bytes(b"x")
    with TestClient(app(Workspace(folder), "127.0.0.1"), OWN) as client:
        (row,) = client.get("/api/studies").json()["studies"]
        assert "caf\\udce9/study/answer.json: is damaged" in row["message"]
        (row,) = client.get("/api/recordings").json()
        assert row["error"].startswith("is not an MCAP file")


def test_a_file_of_a_study_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "study.toml").touch()
    enlarged(tmp_path / "study.toml")
    with pytest.raises(ae.InputError, match=f"larger than the limit of {MAX_BYTES:,} bytes"):
        study.open(tmp_path)


def test_commands_name_files_that_are_not_utf_8_without_a_traceback(
    tmp_path: Path, answered: Path
) -> None:
    (tmp_path / f"{ODD}.toml").write_text(FIELD)
    for command in ("check", "run", "replicate", "study"):
        assert "must be a file name in UTF-8; rename" in refuse(command, tmp_path / f"{ODD}.toml")
    ae.run("flock", record=tmp_path / f"{ODD}.mcap")
    assert "reproduced" in succeed("replay", tmp_path / f"{ODD}.mcap").stdout
    folder = Path(shutil.copytree(answered, tmp_path / ODD))
    assert "finished" in succeed("watch", folder).stdout
    assert "Report: " in run_process("report", folder).stdout
    for option in ("--set", "--vary"):
        assert option in refuse("study", "classic", option, f"{ODD}=1..3")

"""Runs of two builds are never mixed: studies, workers and recordings compare their engines."""

import json
import re
import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pytest
from command_line import refuse, run, succeed
from page_client import Page
from recorded import contents
from starlette.testclient import TestClient
from synthetic_runs import outcomes

import agent_economy as ae
from agent_economy import Scenario, StudyError, _core, study
from agent_economy.build import Build, own_build
from agent_economy.recording import identity
from agent_economy.recording.file import File
from agent_economy.study import workers
from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import RunBlock

OWN, OTHER = _core.ENGINE, "0123456789abcdef"
VERSION = own_build().program
LINE = f'engine = "{OWN}"\n'
TEAM = "robots.wanderer.count"
ENGINES = (f'engine = "{OTHER}"\n', f"engine {OTHER}"), ("", "unknown engine")


def plan(confidence: float = 0.95) -> study.Plan:
    """Return the plan of a study of some hundred runs."""
    scenario = Scenario.load("classic").replace(f"study.vary.{TEAM}", "2..4")
    return study.make_plan(scenario, delta=0.5, confidence=confidence)


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of an answered study of this build; a test copies it."""
    folder = tmp_path_factory.mktemp("studies") / "classic"
    study.run_plan(plan(), folder)
    return folder


@pytest.fixture(params=ENGINES, ids=["another", "unknown"])
def foreign(
    request: pytest.FixtureRequest, answered: Path, tmp_path: Path
) -> tuple[Path, str, dict[str, bytes]]:
    """Return a study of another engine, the name of that engine, and the files of the folder."""
    line, name = request.param
    folder = tmp_path / "studies" / "classic"
    shutil.copytree(answered, folder)
    question = (folder / "study.toml").read_text()
    assert question.count(LINE) == 1
    (folder / "study.toml").write_text(question.replace(LINE, line))
    return folder, name, bytes_of(folder)


def bytes_of(folder: Path) -> dict[str, bytes]:
    """Return the content of the files of a study."""
    names = ("study.toml", "answer.json", "report.html", "ledger.sqlite")
    blocks = sorted(path.name for path in (folder / "blocks").iterdir())
    paths = [*names, *(f"blocks/{name}" for name in blocks)]
    return {path: (folder / path).read_bytes() for path in paths}


def test_the_engine_is_sixteen_hexadecimal_digits() -> None:
    assert re.fullmatch("[0-9a-f]{16}", OWN)
    assert str(own_build()) == f"version {VERSION}, engine {OWN}"
    assert str(Build(VERSION, None)) == f"version {VERSION}, unknown engine"


def test_no_run_of_another_engine_is_added_to_a_study(
    foreign: tuple[Path, str, dict[str, bytes]],
) -> None:
    folder, name, before = foreign
    builds = rf"\(version {VERSION}, {name}\), this one is version {VERSION}, engine {OWN}: install"
    message = f"{re.escape(str(folder))}: its runs were computed by another build .*{builds}"
    requests: tuple[Callable[[], object], ...] = (
        lambda: study.run_plan(plan(), folder),
        lambda: study.run_plan(plan(0.99), folder),
        lambda: study.run_plan(study.load_plan(folder), folder),
        lambda: study.resume(folder),
        lambda: study.resume(folder, confidence=0.99),
    )
    for request in requests:
        with pytest.raises(StoreError, match=message):
            request()
    assert bytes_of(folder) == before


def test_the_command_refuses_a_study_of_another_engine_and_names_both(
    foreign: tuple[Path, str, dict[str, bytes]],
) -> None:
    folder, name, before = foreign
    new = ("study", "classic", "--vary", f"{TEAM}=2..4", "--delta", "0.5")
    for arguments in (new, ("study", "--resume", folder), (*new, "--out", folder)):
        message = refuse(*arguments, cwd=folder.parents[1], code=1)
        assert name in message
        assert OWN in message
        assert "--out" in message
    refuse("study", "--resume", folder, "--confidence", "0.99", code=1)
    assert bytes_of(folder) == before
    assert not folder.with_name(f"classic-{plan().identity[:8]}").exists()


def test_what_another_engine_has_stored_can_be_read(
    foreign: tuple[Path, str, dict[str, bytes]], answered: Path
) -> None:
    folder, _, before = foreign
    theirs = study.load_answer(answered)[0]
    assert study.load_answer(folder)[0].sentence == theirs.sentence
    assert study.open(folder).runs().count("*").fetchall()[0][0] == theirs.runs
    assert "is finished" in succeed("watch", folder).stdout
    assert bytes_of(folder) == before


def test_a_report_of_another_engine_is_rebuilt_and_its_engine_stays_in_the_folder(
    foreign: tuple[Path, str, dict[str, bytes]],
) -> None:
    folder, _, before = foreign
    for name in ("answer.json", "report.html"):
        (folder / name).unlink()
    assert json.loads(succeed("report", folder, "--json").stdout)["runs"] > 0
    assert bytes_of(folder) == before


def test_the_folders_of_two_engines_differ_in_one_line(answered: Path, tmp_path: Path) -> None:
    study.run_plan(plan(), tmp_path / "again")
    assert bytes_of(tmp_path / "again")["study.toml"] == bytes_of(answered)["study.toml"]
    lines = (answered / "study.toml").read_text().splitlines()
    index = lines.index(LINE.strip())
    assert lines[index - 1] == f'program = "{VERSION}"'
    for name, data in bytes_of(answered).items():
        assert name == "study.toml" or OWN.encode() not in data, name


def test_the_engine_is_no_part_of_the_identity_of_a_study(
    foreign: tuple[Path, str, dict[str, bytes]],
) -> None:
    assert study.load_plan(foreign[0]).identity == plan().identity


def test_the_page_shows_a_study_of_another_engine_but_does_not_resume_it(
    client: TestClient, foreign: tuple[Path, str, dict[str, bytes]]
) -> None:
    _, name, before = foreign
    shown = client.get("/api/study", params={"id": "studies/classic"}).json()
    assert (shown["state"], shown["message"]) == ("answered", None)
    assert shown["answer"]["sentence"] == json.loads(before["answer.json"])["sentence"]
    body = {"scenario": "classic", "vary": {TEAM: "2..4"}, "delta": 0.5}
    resumed = {"id": "studies/classic", "confidence": 0.99}
    for address, given in (("", body), ("/resume", {**resumed, "confidence": None})):
        response = client.post(f"/api/studies{address}", json=given)
        assert response.status_code == 422, response.text
        message = response.json()["errors"][0]["message"]
        assert name in message
        assert OWN in message
    assert client.post("/api/studies/resume", json=resumed).status_code == 422
    assert bytes_of(foreign[0]) == before


def test_a_worker_of_another_build_is_refused_and_both_are_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    task = partial(workers.run, outcomes, RunBlock((0,), 0, 5))
    assert task(str(own_build()))[0].keys() == outcomes(RunBlock((0,), 0, 5)).keys()
    other = str(Build(VERSION, OTHER))
    with pytest.raises(RuntimeError, match=rf"another build .*{OWN}\) than the study .*{OTHER}\)"):
        task(other)
    own = own_build()
    # The second is the worker's.
    builds = iter([own, Build(VERSION, OTHER)] * 3)
    monkeypatch.setattr(workers, "own_build", lambda: next(builds))
    with (
        workers.Workers(lambda: ThreadPoolExecutor(1), 1, outcomes) as one,
        pytest.raises(StudyError, match=rf"{OTHER}\) than the study \(.*{OWN}\)"),
    ):
        one.columns(RunBlock((0,), 0, 1))


def recorded(path: Path, monkeypatch: pytest.MonkeyPatch, engine: str | None) -> Path:
    """Record a run as another engine would, or as a version that does not name its engine."""
    with monkeypatch.context() as patch:
        if engine is None:
            note = File.note

            def without_engine(file: File, name: str, values: dict[str, str]) -> None:
                note(file, name, {key: each for key, each in values.items() if key != "engine"})

            patch.setattr(File, "note", without_engine)
        else:
            patch.setattr(identity, "own_build", lambda: Build(VERSION, engine))
        with ae.Recording(ae.Simulation("search", seed=7), path) as recording:
            recording.step(20)
    return path


def test_a_recording_names_the_engine_beside_the_version(mcap: Path) -> None:
    with ae.Recording(ae.ClassicSimulation("classic"), mcap) as recording:
        recording.step(3)
    metadata = contents(mcap).metadata[0].metadata
    assert (metadata["program"], metadata["engine"]) == (VERSION, OWN)
    again = ae.replay(mcap)
    assert (again.agrees, again.program, again.engine) == (True, VERSION, OWN)
    assert json.loads(succeed("replay", mcap, "--json").stdout)["engine"] == OWN
    assert "engine" not in succeed("replay", mcap).stdout


@pytest.mark.parametrize(("engine", "name"), [(OTHER, f"engine {OTHER}"), (None, "unknown engine")])
def test_a_recording_of_another_engine_is_not_verified(
    mcap: Path, monkeypatch: pytest.MonkeyPatch, engine: str | None, name: str
) -> None:
    recorded(mcap, monkeypatch, engine)
    both = rf"\(version {VERSION}, {name}\), this one is version {VERSION}, engine {OWN}"
    with pytest.raises(ae.InputError, match=rf"run\.mcap: was recorded by another .*{both}"):
        ae.replay(mcap)
    assert "--no-verify" in refuse("replay", mcap)

    again = ae.replay(mcap, verify=False)
    assert (again.agrees, again.tick, again.engine) == (True, 20, engine)
    given = run("replay", mcap, "--no-verify")
    assert given.returncode == 0
    words = f"recorded by version {VERSION}, {name}, replayed by version {VERSION}, engine {OWN}"
    assert words in given.stdout
    assert json.loads(succeed("replay", mcap, "--no-verify", "--json").stdout)["engine"] == engine


def test_the_page_opens_a_recording_of_another_engine_and_names_both(
    page: Page, client: TestClient, mcap: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorded(mcap, monkeypatch, OTHER)
    (row,) = client.get("/api/recordings").json()
    assert (row["error"], row["run"]["program"], row["run"]["engine"]) == (None, VERSION, OTHER)
    page.send("open", recording=row["id"], tick=20)
    assert page.wait_for("opened")["recording"] == {
        "id": row["id"],
        "recorded_by": f"version {VERSION}, engine {OTHER}",
        "replayed_by": f"version {VERSION}, engine {OWN}",
        "is_being_written": False,
    }

"""Studies that pages start, follow, stop and open through the server."""

import json
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from page_client import WS, Page
from starlette.websockets import WebSocketDisconnect
from study_client import Folder, Response, served

from agent_economy import Scenario, study
from agent_economy.server.studies import job
from agent_economy.server.studies.factors import factors
from agent_economy.study.answer.any_answer import expect_best
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.arguments import FIRST_ANALYSIS_RUNS
from agent_economy.study.progress import Leader
from agent_economy.study.report import charts
from agent_economy.study.report import sections as report_sections
from agent_economy.study.report.merit_view import MeritView

TEAM = "robots.wanderer.count"
QUICK = {"scenario": "classic", "vary": {TEAM: "1..5"}, "delta": 0.3}
LONG = {"scenario": "search", "vary": {"robots.rover.count": "1..20"}, "delta": 0.001}
SIZES, RUNS = {"robots.rover.count": "2..5"}, 2000
METRIC = {"scenario": "search", "vary": SIZES, "delta": 0.01, "max_runs": RUNS}
"""A study that takes some seconds, however fast the machine, to be stopped and killed meanwhile."""
FIRST_ROUND = 4 * FIRST_ANALYSIS_RUNS


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Folder]:
    with served(tmp_path) as folder:
        yield folder


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Folder]:
    """Return a folder with a completed study, and the progress that was received."""
    with served(tmp_path_factory.mktemp("answered")) as folder:
        name = folder.post("/api/studies", **QUICK)["id"]
        assert name == "studies/classic"
        folder.progress = folder.watched(name)
        yield folder


def test_the_page_and_the_command_line_give_the_same_answer(
    answered: Folder, tmp_path: Path
) -> None:
    theirs = study.run(Scenario.load("classic"), vary={TEAM: "1..5"}, delta=0.3, out=tmp_path)
    shown = answered.get("/api/study", id="studies/classic")
    assert shown["state"] == "answered"
    assert shown["sentence"] == shown["answer"]["sentence"] == theirs.sentence
    words = "factorial: 5 configurations; delta 0.3, confidence 0.95, indifference"
    assert shown["words"] == shown["planned"]["words"] == words
    assert shown["source"] == {"scenario": "classic"}
    mine = (answered.path / "studies" / "classic" / "answer.json").read_bytes()
    assert mine == (tmp_path / "answer.json").read_bytes()
    assert [row["state"] for row in answered.get("/api/studies")["studies"]] == ["answered"]


def test_progress_is_monotonic_and_ends_with_the_answer(answered: Folder) -> None:
    for name in ("rounds", "runs", "computed", "seconds"):
        values = [each[name] for each in answered.progress]
        assert values == sorted(values), name
    assert answered.progress[0]["labels"][2] == "3 wanderers"
    assert all(each["labels"] is None for each in answered.progress[1:])
    assert {each["state"] for each in answered.progress[:-1]} <= {"running"}
    last, shown = answered.progress[-1], answered.get("/api/study", id="studies/classic")
    assert last["state"] == "answered"
    assert last["runs"] == shown["runs"]
    outs = {row["configuration"] for row in shown["answer"]["results"] if row["eliminated"]}
    assert {row[0] for row in last["eliminated"]} == outs
    best = shown["answer"]["results"][last["standings"][0][0]]
    answer = answered.get("/api/study/answer", id="studies/classic")
    merit = answer["results"][best["configuration"]]["merit"].values()
    assert last["standings"][0] == [best["configuration"], best["runs"], *merit, None]


def test_a_page_that_connects_late_gets_the_current_progress(answered: Folder) -> None:
    (late,) = answered.watched("studies/classic")
    assert late == {**answered.progress[-1], "labels": answered.progress[0]["labels"]}


def test_an_answer_has_the_reports_own_sections_charts_and_tables(answered: Folder) -> None:
    loaded, evidence = study.load_answer(answered.path / "studies" / "classic")
    found = expect_best(loaded)
    shown = answered.get("/api/study", id="studies/classic")["answer"]
    view = MeritView(found, evidence)
    sections = list(report_sections.sections(view))
    assert [each["title"] for each in shown["sections"]] == [each.heading for each in sections]
    assert shown["charts"] == json.loads(json.dumps(charts.specifications(view)))
    assert {name for each in shown["sections"] for name in each["charts"]} == set(shown["charts"])
    for section in shown["sections"]:
        for table in section["tables"]:
            assert len(table["rows"]) == len(table["configurations"])
            assert {len(row) for row in table["rows"]} == {len(table["head"])}
    for row in shown["charts"]["merit"]["data"]["values"]:
        result = found.results[row["configuration"]]
        assert row["value"] == pytest.approx(result.merit.value, rel=1e-5)
    assert shown["sections"][0]["tables"][0]["configurations"] == [0, 1, 2, 3, 4]


def test_runs_are_listed_with_the_merit_that_the_study_computed(answered: Folder) -> None:
    query = {"id": "studies/classic", "configuration": 2}
    response = answered.get("/api/study/runs", **query, first=3, count=4)
    assert [run["run"] for run in response["runs"]] == ["3", "4", "5", "6"]
    assert response["label"] == "3 wanderers"
    answer = answered.get("/api/study/answer", id="studies/classic")
    everything = answered.get("/api/study/runs", **query, count=1000)["runs"]
    result = answer["results"][2]
    assert len(everything) == response["total"] == result["runs"]
    merits = [run["merit"] for run in everything]
    assert sum(merits) / len(merits) == pytest.approx(result["merit"]["value"])
    sample = answered.get("/api/study/runs", **query, sample=5)["runs"]
    assert [run["quantile"] for run in sample] == [0, 0.25, 0.5, 0.75, 1]
    assert [run["merit"] for run in sample] == sorted(run["merit"] for run in sample)
    assert sample[0]["merit"] == min(merits)
    assert sample[-1]["merit"] == max(merits)
    (median,) = answered.get("/api/study/runs", **query, median=1)["runs"]
    assert median["merit"] == sorted(merits)[(len(merits) - 1) // 2]


@pytest.mark.parametrize(
    ("query", "response"),
    [
        ({"configuration": 5}, "from 0 to 4"),
        ({"configuration": "x"}, "a whole number"),
        ({"configuration": 0, "count": 1001}, "from 1 to 1000"),
        ({"configuration": 0, "sample": 0}, "from 1 to 1000"),
    ],
)
def test_requests_for_missing_runs_are_refused(
    answered: Folder, query: Response, response: str
) -> None:
    query = {"id": "studies/classic", **query}
    refused = answered.client.get("/api/study/runs", params=query)
    assert refused.status_code == 422
    assert response in refused.json()["errors"][0]["message"]


def test_the_report_and_the_answer_can_be_downloaded(answered: Folder) -> None:
    for address, name in (("report", "report.html"), ("answer", "answer.json")):
        response = answered.client.get(f"/api/study/{address}", params={"id": "studies/classic"})
        assert response.content == (answered.path / "studies" / "classic" / name).read_bytes()
        assert "attachment" in response.headers["content-disposition"]


def test_the_question_of_a_study_contains_all_its_values(answered: Folder) -> None:
    question = answered.get("/api/study/question", id="studies/classic")
    assert question["scenario"]["robots"]["wanderer"]["count"]
    (factor,) = question["factors"]
    assert factor["path"] == TEAM
    assert (question["delta"], question["configurations"], question["seed"]) == (0.3, 5, "0")
    refused = answered.client.get("/api/study/question", params={"id": "studies/none"})
    assert refused.status_code == 422


def test_raising_the_confidence_gives_the_answer_of_a_new_study_at_that_confidence(
    answered: Folder, tmp_path: Path
) -> None:
    shutil.copytree(answered.path / "studies", answered.path / "more")
    for confidence in ("high", 0.5):
        refused = answered.refused("/api/studies/resume", id="more/classic", confidence=confidence)
        assert refused[0]["message"].startswith("confidence")
    begun = answered.post("/api/studies/resume", id="more/classic", confidence=0.99)
    assert begun["confidence"] == 0.99
    assert answered.watched("more/classic")[-1]["state"] == "answered"
    scenario = Scenario.load("classic")
    study.run(scenario, vary={TEAM: "1..5"}, delta=0.3, confidence=0.99, out=tmp_path)
    mine = json.loads((answered.path / "more" / "classic" / "answer.json").read_bytes())
    assert len(mine.pop("questions")) == 2
    assert mine == json.loads((tmp_path / "answer.json").read_bytes())


def test_a_stopped_or_killed_study_resumes_to_the_same_bytes(
    folder: Folder, tmp_path: Path
) -> None:
    name = folder.post("/api/studies", **METRIC)["id"]
    folder.watched(name, runs=FIRST_ROUND + 1)
    stopped = folder.post("/api/studies/stop", id=name)
    assert stopped["state"] == "stopped"
    assert stopped["message"] is None
    assert folder.watched(name)[-1]["runs"] == stopped["runs"] > 0
    assert folder.get("/api/study", id=name)["answer"] is None
    kept = study.open(folder.path / name).runs().count("*").fetchall()[0][0]
    assert kept >= stopped["runs"]

    folder.post("/api/studies/resume", id=name)
    folder.watched(name, runs=stopped["runs"] + 1)
    (child,) = multiprocessing.active_children()
    os.kill(int(child.pid or 0), signal.SIGKILL)
    killed = folder.watched(name)[-1]
    assert killed["state"] == "stopped"
    assert "killed by signal 9" in killed["message"]
    assert folder.get("/api/studies")["studies"][0]["message"] == killed["message"]

    assert folder.post("/api/studies", **METRIC)["id"] == name
    assert folder.watched(name)[-1]["message"] is None
    search = Scenario.load("search")
    study.run(search, vary=SIZES, delta=0.01, max_runs=RUNS, out=tmp_path / "whole")
    mine = (folder.path / name / "answer.json").read_bytes()
    assert mine == (tmp_path / "whole" / "answer.json").read_bytes()


def test_a_study_stopped_in_its_first_round_keeps_its_finished_runs(
    folder: Folder,
) -> None:
    slow = {"scenario": "search", "vary": {"robots.rover.count": "1..120"}}
    name = folder.post("/api/studies", **slow)["id"]
    before = folder.watched(name, runs=1)[-1]["runs"]
    runs = folder.post("/api/studies/stop", id=name)["runs"]
    assert 0 < before <= runs
    last = folder.watched(name)[-1]
    assert (last["runs"], last["rounds"], last["remaining"]) == (runs, 0, 120)


def test_a_study_that_is_stopped_while_it_starts_prints_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    begun = job.StudyJob(study.make_plan(Scenario.load("classic")), tmp_path / "study")
    begun.stop()
    assert (begun.is_alive, begun.message) == (False, None)
    assert capfd.readouterr().err == ""


def test_a_configuration_eliminated_after_the_estimate_is_not_among_the_standings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(job, "REPORT_S", 0.0)
    monkeypatch.setattr(job, "ESTIMATE_S", 1e9)
    theirs, mine = multiprocessing.Pipe()
    reporter = job.ProgressReporter(mine)
    shown = tuple((Leader(each, 20, 0.5), Interval(0.5, 0.4, 0.6)) for each in range(2))
    for gone in ([], [[1, 0, 20]]):
        facts = {"runs": 40, "survivors": 2, "leaders": [], "eliminated": gone, "is_over": False}
        now = study.Progress.of_facts(1, facts, 40, 1.0)
        reporter(replace(now, intervals=lambda: shown))
    assert [[row[0] for row in theirs.recv()["standings"]] for _ in range(2)] == [[0, 1], [0]]


def test_a_study_is_interrupted_once() -> None:
    before = signal.getsignal(signal.SIGINT)
    try:
        with pytest.raises(KeyboardInterrupt):
            job.interrupted()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_all_configurations_remain_before_the_first_round(folder: Folder) -> None:
    place = folder.path / "studies" / "pending"
    place.mkdir(parents=True)
    scenario = Scenario.load("classic")
    (place / "study.toml").write_text(study.make_plan(scenario).text(), encoding="utf-8")
    (last,) = folder.watched("studies/pending")
    assert (last["state"], last["remaining"], last["runs"]) == ("stopped", 8, 0)


def test_the_number_of_pages_that_follow_studies_is_limited(
    folder: Folder, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(import_module("agent_economy.server.app"), "MAX_WATCHERS", 1)
    name = folder.post("/api/studies", **LONG)["id"]
    with folder.client.websocket_connect(f"{WS}?study={name}") as first:
        assert first.receive_json()["type"] == "study_progress"
        with folder.client.websocket_connect(f"{WS}?study={name}") as second:
            assert second.receive_json()["reason"] == "full"
    folder.post("/api/studies/stop", id=name)
    assert folder.watched(name)[-1]["state"] == "stopped"


def test_a_run_opened_from_a_study_is_the_run_of_the_study(folder: Folder) -> None:
    query = {**METRIC, "max_runs": None, "runs": 2, "seed": "7"}
    name = folder.post("/api/studies", **query)["id"]
    assert folder.watched(name)[-1]["state"] == "answered"
    stored = folder.get("/api/study/runs", id=name, configuration=1)["runs"][1]
    with folder.client.websocket_connect(WS) as socket:
        page = Page(socket)
        page.send("open", study={"id": name, "configuration": 1}, run="1")
        assert page.next()["seed"] == "7"
        page.send("seek", tick=10**6)
        state = page.finish()
    assert {name: state["outcome"][name] for name in stored if name not in ("run", "failed")} == {
        name: value for name, value in stored.items() if name not in ("run", "failed")
    }
    assert state["outcome"]["complete"] is not stored["failed"]


def test_at_most_two_studies_run_at_a_time_and_all_end_with_the_server(tmp_path: Path) -> None:
    with served(tmp_path) as folder:
        names = [folder.post("/api/studies", **LONG, seed=seed)["id"] for seed in ("1", "2")]
        (error,) = folder.refused("/api/studies", **LONG, seed="3")
        assert all(name in error["message"] for name in names)
        assert "stop one" in error["message"]
        (again,) = folder.refused("/api/studies", **LONG, seed="1")
        assert "is running already" in again["message"]
        for name in names:
            folder.watched(name, runs=1)
            assert study.is_locked(tmp_path / name)
        assert {row["state"] for row in folder.get("/api/studies")["studies"]} == {"running"}
    assert not any(study.is_locked(tmp_path / name) for name in names)
    assert multiprocessing.active_children() == []


def test_a_study_ends_when_its_server_is_killed(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from agent_economy.server import Workspace\n"
        "from agent_economy.server.studies import manager, requests\n"
        "if __name__ == '__main__':\n"
        f"    places = Workspace(Path(sys.argv[1])); plan = requests.plan({LONG!r}, places)\n"
        "    print(manager.StudyManager(places).start(plan)['id'], flush=True); time.sleep(60)\n"
    )
    script = tmp_path / "server.py"
    script.write_text(code)
    command = [sys.executable, str(script), str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout
        place = tmp_path / server.stdout.readline().strip()
        wait_until(lambda: study.is_locked(place))
        server.kill()
    wait_until(lambda: not study.is_locked(place))


def wait_until(holds: Any, max_s: float = 30) -> None:
    end_s = time.monotonic() + max_s
    while not holds():
        assert time.monotonic() < end_s
        time.sleep(0.05)


def test_a_study_of_another_process_is_listed_as_running_and_cannot_be_stopped(
    answered: Folder, tmp_path: Path
) -> None:
    shutil.copytree(answered.path / "studies", tmp_path / "studies")
    plan = study.load_plan(tmp_path / "studies" / "classic")
    with served(tmp_path) as folder:

        def look(_: study.Progress) -> None:
            (row,) = folder.get("/api/studies")["studies"]
            assert row["state"] == "running"
            (error,) = folder.refused("/api/studies/stop", id=row["id"])
            assert "another process" in error["message"]
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            study.run_plan(plan, tmp_path / "studies" / "classic", on_progress=look)
        assert folder.get("/api/studies")["studies"][0]["state"] == "answered"


def test_listing_studies_checks_no_scenario_and_computes_nothing(
    answered: Folder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in range(3):
        shutil.copytree(answered.path / "studies" / "classic", tmp_path / f"deep/{number}")

    os.utime(tmp_path / "deep" / "1" / "answer.json")

    def never(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(study, "load_plan", never)
    monkeypatch.setattr(Scenario, "of", never)
    with served(tmp_path) as folder:
        rows = folder.get("/api/studies")["studies"]
    assert [row["id"] for row in rows] == ["deep/1", "deep/0", "deep/2"]
    assert all(row["configurations"] == 5 and row["runs"] > 0 for row in rows)


@pytest.mark.parametrize(
    "name",
    ["../secret", "/etc", "link", "", ".", "studies", "here/../here", "a\0b", "nothing", "here/"],
)
def test_no_study_outside_of_the_folder_is_opened(folder: Folder, name: str) -> None:
    secret = folder.path.parent / "secret"
    secret.mkdir(exist_ok=True)
    for place in (secret, folder.path / "here"):
        place.mkdir(exist_ok=True)
        (place / "study.toml").write_text("format = 1\n")
    (folder.path / "link").symlink_to(secret)
    assert [row["id"] for row in folder.get("/api/studies")["studies"]] == ["here"]
    for address in ("study", "study/runs", "study/report", "study/answer"):
        response = folder.client.get(f"/api/{address}", params={"id": name, "configuration": 0})
        assert "in the list" in response.json()["errors"][0]["message"]
    for address in ("stop", "resume"):
        (error,) = folder.refused(f"/api/studies/{address}", id=name)
        assert "in the list" in error["message"]
    (error,) = folder.refused("/api/studies/stop", id=7)
    assert "as a string" in error["message"]


def test_a_linked_folder_of_studies_is_not_written_to(folder: Folder) -> None:
    elsewhere = folder.path.parent / "elsewhere"
    elsewhere.mkdir()
    (folder.path / "studies").symlink_to(elsewhere)
    (error,) = folder.refused("/api/studies", **QUICK)
    assert "below the server's folder" in error["message"]
    assert list(elsewhere.iterdir()) == []


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("study.toml", "= 3"),
        ("study.toml", "format = 7"),
        ("answer.json", "{"),
        ("answer.json", "[]"),
    ],
)
def test_a_damaged_study_is_listed_with_its_error(
    answered: Folder, tmp_path: Path, file: str, text: str
) -> None:
    shutil.copytree(answered.path / "studies", tmp_path / "studies")
    (tmp_path / "studies" / "classic" / file).write_text(text)
    with served(tmp_path) as folder:
        (row,) = folder.get("/api/studies")["studies"]
        assert row["state"] == "damaged"
        assert file in row["message"]
        assert "Error" not in row["message"]
        (last,) = folder.watched("studies/classic")
        assert last["state"] == "damaged"
        assert file in last["message"]


def test_all_errors_of_a_study_request_are_reported_at_once(folder: Folder) -> None:
    query = {
        "scenario": "classic",
        "vary": {"robots.wanderer.cuont": "1..5", "contact": "tuch"},
        "merit": "equation-5",
        "delta": -1,
        "confidence": 2,
        "guarantee": "none",
        "runs": 1,
        "seed": 7,
    }
    for address in ("/api/plan", "/api/studies"):
        paths = {error["path"] for error in folder.refused(address, **query)}
        assert paths >= {"merit", "delta", "confidence", "guarantee", "runs", "seed"}
        assert any("cuont" in path for path in paths)
    assert not (folder.path / "studies").exists()


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ({}, "exactly one of `scenario` and `text`"),
        ({"scenario": "classic", "text": "x"}, "exactly one of `scenario` and `text`"),
        ({"scenario": "../x.toml"}, "one of the gallery"),
        ({"text": "= 3"}, "scenario.toml"),
        ({"scenario": "classic", "vary": [1]}, "an object of values"),
        ({"scenario": "classic", "vary": {TEAM: 4}}, "a string"),
        ({"scenario": "classic", "vary": {TEAM: "1..5"}, "max_runs": 3}, "50 or more"),
        ({"scenario": "classic", "design": 3}, "a string"),
    ],
)
def test_invalid_study_requests_are_refused_with_a_reason(
    folder: Folder, body: Response, reason: str
) -> None:
    assert reason in folder.refused("/api/plan", **body)[0]["message"]


@pytest.mark.parametrize("content", [b"[]", b"{", b"\xff", b"[" * 100_000, b"x" * 1_000_001])
def test_requests_that_are_not_objects_are_refused(folder: Folder, content: bytes) -> None:
    response = folder.client.post("/api/plan", content=content)
    assert response.status_code in (413, 422)
    assert response.json()["errors"][0]["message"]


def test_pages_of_other_sites_cannot_request_studies(folder: Folder) -> None:
    headers = {"origin": "https://evil.example"}
    for address in ("factors", "plan", "studies", "studies/stop", "studies/resume"):
        response = folder.client.post(f"/api/{address}", json=QUICK, headers=headers)
        assert response.status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        folder.client.websocket_connect(f"{WS}?study=x", headers=headers),
    ):
        pass
    assert not (folder.path / "studies").exists()


def test_a_plan_contains_its_configurations_its_folder_and_its_state(answered: Folder) -> None:
    response = answered.post("/api/plan", **QUICK)
    assert response["id"] == "studies/classic"
    assert response["state"] == "answered"
    assert response["labels"] == [f"{n} wanderer{'s' * (n > 1)}" for n in range(1, 6)]
    other = answered.post("/api/plan", **{**QUICK, "vary": {"contact": "touch,ahead"}})
    assert other["factors"] == [
        {"path": "contact", "values": ["touch", "ahead"], "range": None},
    ]
    assert other["id"].startswith("studies/classic-")
    assert other["state"] is None


def test_factors_are_listed_with_their_bounds(folder: Folder) -> None:
    response = folder.post("/api/factors", scenario="classic")
    assert response["merits"] == ["equation-5.2", "appendix"]
    assert response["delta"] == 0.01
    team, *others = response["factors"]
    assert team.pop("help").startswith("Number of robots")
    assert team == {
        "path": TEAM,
        "value": 4,
        "low": 1,
        "high": 250,
        "kind": "whole",
        "values": None,
        "unit": None,
        "varied": "1..8",
    }
    assert {each["path"] for each in others} == {
        "clock.paints_per_s",
        "clock.time_limit_s",
        "contact",
    }


def test_every_number_and_choice_that_a_path_can_name_is_a_factor(folder: Folder) -> None:
    text = Scenario.load("search").source.text
    response = folder.post("/api/factors", text=text)
    found = {each["path"]: each for each in response["factors"]}
    speed = found["robots.rover.drive.max_speed_m_s"]
    assert (speed["value"], speed["low"], speed["high"]) == (1, 0, 100)
    assert (speed["kind"], speed["unit"]) == ("real", "m/s")
    # Of the model, of the schema, and not set anywhere.
    values = {
        "robots.rover.sensors.lidar.range_m": 10,
        "world.periodic": False,
        "robots.rover.payload_kg": None,
    }
    assert {path: found[path]["value"] for path in values} == values
    assert found["robots.rover.layer"]["values"] == ["ground", "air"]
    assert not any(path.startswith(("study.", "merit")) or "[" in path for path in found)


def test_a_key_that_needs_others_is_no_factor() -> None:
    paths = {each["path"] for each in factors(Scenario.load("flock"))}
    assert "robots.bird.radio.range_m" in paths
    assert "robots.bird.radio.loss_probability" not in paths


def test_numbers_of_robots_then_of_controllers_are_the_first_factors() -> None:
    first, second, *others = [each["path"] for each in factors(Scenario.load("waypoints"))]
    assert (first, second) == ("robots.rover.count", "controllers.base.count")
    assert "controllers.base.allocation" in others


@pytest.mark.parametrize(
    "name", ["classic", "search", "search-beliefs", "open-field", "flock", "waypoints"]
)
def test_every_listed_factor_can_be_varied(name: str) -> None:
    scenario = Scenario.load(name)
    found = factors(scenario)
    assert found
    for factor in found:
        if factor["value"] is not None:
            assert scenario.configuration({factor["path"]: factor["value"]})

"""Studies of requirements that pages start, follow and open through the server."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from study_client import Folder, Response, served

from agent_economy import Scenario, study
from agent_economy.server.studies.progress import stored

REQUIRED = {
    "scenario": "classic",
    "question": "requirement",
    "vary": {"robots.wanderer.count": "1..6"},
    "require": ["time_s <= 40"],
    "probability": 0.8,
    "tolerance": 0.1,
}
LONG = {
    "scenario": "search",
    "question": "requirement",
    "require": ["time_s <= 100"],
    "probability": 0.8,
    "tolerance": 0.001,
    "vary": {"robots.rover.count": "1..9"},
}
WITH_REQUIREMENT = Scenario.load("search").source.text.replace(
    "[study]",
    """[require]
all = ["time_s <= 100", "collisions <= 5"]
probability = 0.8
[study]
minimize = "2 * rover"
where = "rover != 3"
""",
)


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Folder]:
    with served(tmp_path) as folder:
        yield folder


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Folder]:
    """Return a folder with a completed study, and the progress that was received."""
    with served(tmp_path_factory.mktemp("answered")) as folder:
        name = folder.post("/api/studies", **REQUIRED)["id"]
        folder.progress = folder.watched(name)
        yield folder


def test_the_page_and_python_give_the_same_answer(answered: Folder, tmp_path: Path) -> None:
    theirs = study.run(
        "classic",
        vary={"robots.wanderer.count": "1..6"},
        only_vary=True,
        require="time_s <= 40",
        probability=0.8,
        tolerance=0.1,
        out=tmp_path,
    )
    shown = answered.get("/api/study", id="studies/classic")
    assert shown["answer"]["verdict"] == list(theirs.verdict)
    assert (shown["delta"], shown["planned"]["delta"], shown["planned"]["guarantee"]) == (None,) * 3
    assert shown["planned"]["requirement"] == {
        "words": "time_s <= 40 in 0.8 of runs, tolerance 0.1",
        "conditions": ["time_s <= 40"],
        "probability": 0.8,
        "tolerance": 0.1,
        "minimize": "robots",
    }
    assert shown["is_recommended"] is True
    mine = (answered.path / "studies" / "classic" / "answer.json").read_bytes()
    assert mine == (tmp_path / "answer.json").read_bytes()


def test_progress_has_the_status_of_each_team_by_cost(answered: Folder) -> None:
    last = answered.progress[-1]
    results = answered.get("/api/study", id="studies/classic")["answer"]["results"]
    known = [each for each in results if each["met"]]
    verdicts = {"best": "certified"}
    assert last["standings"] == [
        [
            each["configuration"],
            each["runs"],
            *each["met"],
            verdicts.get(each["verdict"], each["verdict"]),
        ]
        for each in known
    ]
    assert last["certified"] == sum(row[5] == "certified" for row in last["standings"]) > 0
    refuted = [row[0] for row in last["standings"] if row[5] in {"refuted", "may meet"}]
    assert refuted == sorted(row[0] for row in last["eliminated"]) != []
    assert all(by is None for _, by, _ in last["eliminated"])
    counts = [each["certified"] or 0 for each in answered.progress]
    assert all(before <= after for before, after in pairwise(counts))
    *before, last = [each["remaining_s"] for each in answered.progress]
    assert last == [0, 0]
    assert all(left in (None, [0, 0]) for left in before)


def test_a_stopped_study_keeps_the_statuses(folder: Folder) -> None:
    name = folder.post("/api/studies", **LONG)["id"]
    running = folder.watched(name, runs=60)[-1]
    assert running["standings"][0][5] == "refuted"
    assert running["certified"] is not None
    folder.post("/api/studies/stop", id=name)
    (last,) = folder.watched(name)
    assert last["state"] == "stopped"
    rows = last["standings"]
    assert [row[0] for row in rows] == list(range(len(rows)))
    assert {row[3] for row in rows} == {None}
    assert {row[5] for row in rows if row[0] in {out[0] for out in last["eliminated"]}} == {
        "refuted"
    }
    assert stored(folder.path / name)["certified"] == last["certified"]


def test_an_answer_that_certifies_nothing_is_not_a_recommendation(folder: Folder) -> None:
    query = {**REQUIRED, "require": ["time_s <= 8"]}
    name = folder.post("/api/studies", **query)["id"]
    folder.watched(name)
    (row,) = folder.get("/api/studies")["studies"]
    assert (row["state"], row["is_recommended"]) == ("answered", False)
    verdict = folder.get("/api/study", id=name)["answer"]["verdict"]
    assert verdict[0] == "No compared team is certified."


def test_an_answer_with_many_failures_is_not_a_recommendation(folder: Folder) -> None:
    text = Scenario.load("search").source.text.replace("time_limit_s = 120", "time_limit_s = 5")
    vary = {"robots.rover.count": "1,2"}
    name = folder.post("/api/studies", text=text, vary=vary, runs=20)["id"]
    assert folder.watched(name)[-1]["certified"] is None
    (row,) = folder.get("/api/studies")["studies"]
    assert (row["state"], row["is_recommended"]) == ("answered", False)


def test_the_form_gets_the_requirement_of_the_scenario(folder: Folder) -> None:
    found = folder.post("/api/factors", text=WITH_REQUIREMENT)
    assert found["requirement"] == {
        "words": "time_s <= 100 and collisions <= 5 in 0.8 of runs, tolerance 0.08",
        "conditions": ["time_s <= 100", "collisions <= 5"],
        "probability": 0.8,
        "tolerance": 0.08,
    }
    assert (found["minimize"], found["where"]) == ("2 * rover", "rover != 3")
    assert {"time_s", "collisions", "found_mine"} <= {*found["columns"]}
    without = folder.post("/api/factors", scenario="search")
    assert (without["requirement"], without["minimize"], without["where"]) == (None, "robots", None)


@pytest.mark.parametrize(
    ("query", "delta", "words"),
    [
        ({}, None, "time_s <= 100 and collisions <= 5 in 0.8 of runs, tolerance 0.08"),
        ({"question": "requirement", "probability": 0.9}, None, "in 0.9 of runs, tolerance 0.04"),
        ({"question": "requirement", "require": ["found >= 4"]}, None, "found >= 4 in 0.8"),
        ({"question": "merit"}, 0.2, "indifference"),
        ({"question": "merit", "guarantee": "pgs"}, 0.2, "pgs"),
    ],
)
def test_the_question_is_the_one_of_the_request(
    folder: Folder, query: Response, delta: float | None, words: str
) -> None:
    planned = folder.post("/api/plan", text=WITH_REQUIREMENT, **query)
    assert planned["delta"] == delta
    assert words in planned["words"]
    assert planned["configurations"] == 19
    other = folder.post("/api/plan", text=WITH_REQUIREMENT, **query, where="rover < 5")
    assert other["configurations"] == 4


def test_all_errors_of_a_requirement_are_reported_at_their_places(folder: Folder) -> None:
    query = {
        **REQUIRED,
        "require": ["time_s <= 40", "colisions <= 0", "found >"],
        "probability": 2,
        "tolerance": -1,
        "minimize": "robot",
        "where": "wanderer >",
        "confidence": 2,
    }
    errors = {each["path"]: each for each in folder.refused("/api/plan", **query)}
    assert {*errors} == {
        "require.all[1]",
        "require.all[2]",
        "require.probability",
        "require.tolerance",
        "study.minimize",
        "study.where",
        "confidence",
    }
    assert errors["require.all[1]"]["suggestion"] == '"collisions <= 0"'


@pytest.mark.parametrize(
    ("query", "paths"),
    [
        ({"require": ["time_s <= 40", "found >= 0"]}, ["require.all[1]"]),
        (
            {"require": ["failed >= 0"], "minimize": "1/(wanderer-1)"},
            [
                "study.minimize",
                "require.all[0]",
            ],
        ),
        ({"require": []}, ["require.all"]),
        ({"require": None, "probability": None, "tolerance": None}, ["require.all"]),
        ({"require": "time_s <= 40"}, ["require"]),
        ({"where": "wanderer > 9"}, ["study.where"]),
        ({"where": 3}, ["where"]),
        ({"delta": 0.1}, ["delta"]),
        ({"question": "merit"}, ["require"]),
        ({"question": "best"}, ["question"]),
        ({"question": []}, ["question"]),
    ],
)
def test_an_impossible_requirement_is_refused(
    folder: Folder, query: Response, paths: list[str]
) -> None:
    errors = folder.refused("/api/plan", **{**REQUIRED, **query})
    assert [each["path"] for each in errors] == paths

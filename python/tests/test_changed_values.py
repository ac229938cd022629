"""The form of a study shows what was changed in the scenario of a run."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy.scenario import Override
from agent_economy.server.runs.export import as_toml

Changes = Sequence[tuple[str, Any]]

COUNT, MUD = "robots.rover.count", {"areas_m": [[[1, 1], [2, 1], [2, 2]]]}


def exported(changes: Changes, scenario: str | ae.Scenario = "search") -> str:
    """Change a run, one change per step, and return its exported scenario."""
    simulation = ae.Simulation(scenario, 7)
    for path, value in changes:
        simulation.step()
        simulation.change(path, value)
    return as_toml(simulation)


def form(client: TestClient, text: str) -> Any:
    """Return what the form of a study of a file shows of its origin."""
    body = {"scenario": None, "text": text}
    return client.post("/api/factors", json=body).raise_for_status().json()["exported_from"]


def test_the_form_names_the_scenario_and_each_value_before_and_after(client: TestClient) -> None:
    changes = [(COUNT, 7), (COUNT, 6), ("terrain.mud", MUD)]
    origin = form(client, exported(changes))
    assert origin == {
        "name": "search",
        "values": [
            {"path": COUNT, "old": "4", "new": "6"},
            {"path": "terrain", "old": None, "new": "a table with 1 key"},
        ],
        "total": 2,
    }


def test_a_change_that_was_set_back_is_none(client: TestClient) -> None:
    changes = [(COUNT, 7), (COUNT, 4)]
    origin = form(client, exported(changes))
    assert origin == {"name": "search", "values": [], "total": 0}


def test_a_scenario_that_was_not_exported_has_no_origin(client: TestClient) -> None:
    text = ae.Scenario.load("search").source.text
    for each in (text, f"# From nowhere\n{text}", f"\n{text}"):
        assert form(client, each) is None
    body = {"scenario": "search", "text": None}
    assert client.post("/api/factors", json=body).json()["exported_from"] is None


def test_values_that_were_edited_in_the_file_since_are_those_of_the_file(
    client: TestClient,
) -> None:
    text = exported([(COUNT, 7)])
    assert form(client, text.replace("count = 7", "count = 9"))["values"] == [
        {"path": COUNT, "old": "4", "new": "9"}
    ]
    head, _, body = text.partition("\n\n")
    set_back = f"{head}\n\n{body.replace('count = 7', 'count = 4', 1)}"
    assert form(client, set_back)["total"] == (0 if "count = 7" in body else 1)


def test_a_run_of_an_exported_file_keeps_the_changes_before(client: TestClient) -> None:
    first = exported([(COUNT, 7)])
    second = exported([("clock.time_limit_s", 60)], ae.Scenario.loads(first))
    assert form(client, second) == {
        "name": "search",
        "values": [
            {"path": COUNT, "old": "4", "new": "7"},
            {"path": "clock.time_limit_s", "old": "120", "new": "60"},
        ],
        "total": 2,
    }


def test_ten_changes_are_listed_and_all_are_counted(client: TestClient) -> None:
    robots = [(f"items.kind-{i}", {"count": 1}) for i in range(14)]
    origin = form(client, exported(robots))
    assert (len(origin["values"]), origin["total"]) == (10, 14)
    assert origin["values"][0] == {
        "path": "items.kind-0",
        "old": None,
        "new": "a table with 1 key",
    }


def test_long_values_are_counted_in_one_line(client: TestClient) -> None:
    corner = [[i, i * i] for i in range(40)]
    changes = [("summary", "x" * 500), ("terrain.mud", {"areas_m": [corner]})]
    for value in form(client, exported(changes))["values"]:
        assert len(f"{value['old']}{value['new']}") < 300


def test_a_study_of_a_changed_scenario_is_stored_under_its_name(client: TestClient) -> None:
    body = {"scenario": None, "vary": {COUNT: "1..3"}}
    cases: list[tuple[Changes, str]] = [([(COUNT, 7)], "search-changed"), ([], "search")]
    for changes, name in cases:
        text = exported(changes)
        plan = client.post("/api/plan", json={**body, "text": text}).raise_for_status().json()
        assert (plan["id"], plan["name"]) == (f"studies/{name}", name)


@pytest.mark.parametrize("name", ["a\nb = 1", "a b", 'a"b', "a = 1 (was 2)", "é", "a.b"])
def test_odd_names_of_files_and_keys_with_dots_stay_comments(client: TestClient, name: str) -> None:
    scenario = ae.Scenario.loads(
        ae.Scenario.load("search").source.text,
        file=f"{name}.toml",
        overrides=(Override.at(f"study.vary.{COUNT}", "1..3", "test"),),
    )
    text = as_toml(ae.Simulation(scenario, 7))
    assert ae.Scenario.loads(text).to_dict() == scenario.to_dict()
    (value,) = form(client, text)["values"]
    assert value == {"path": f'study.vary."{COUNT}"', "old": '"1..20"', "new": '"1..3"'}


@pytest.mark.parametrize(
    "head",
    [
        "# From a, seed 1, run 1, at tick 1 (1 s).\n# Changed values: 999999999999.\n",
        "# From a, seed 1, run 1, at tick 1 (1 s).\n# Changed values: 3.\n# a..b = 1 (was 2)\n",
        '# From a, seed 1, run 1, at tick 1 (1 s).\n# Changed values: 3.\n# "\\x = 1 (was 2)\n',
        "# From ../../x, seed 1, run 1, at tick 1 (1 s).\n" + "# x = 1 (was 2)\n" * 9999,
        "# From " + "x" * 99_999 + ", seed 1, run 1, at tick 1 (1 s).\n",
    ],
)
def test_forged_comments_cause_no_error_and_name_no_other_folder(
    client: TestClient, tmp_path: Path, head: str
) -> None:
    text = f"{head}{ae.Scenario.load('search').source.text}"
    assert len(form(client, text)["values"]) <= 10
    body = {"scenario": None, "text": text, "vary": {COUNT: "1..3"}}
    plan = client.post("/api/plan", json=body).raise_for_status().json()
    assert plan["id"].startswith("studies/")
    assert ".." not in plan["id"]
    assert list(tmp_path.iterdir()) == []

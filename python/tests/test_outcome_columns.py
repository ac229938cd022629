"""Each outcome column has a description, and pages receive those that apply."""

import re
from pathlib import Path

import pytest
from lanes import SMALL_LANE, with_passage
from metric import world

import agent_economy as ae
from agent_economy.runs.columns import COLUMNS, OF_KINDS, description_of
from agent_economy.runs.factory import create
from agent_economy.scenario import bundled
from agent_economy.server.runs.shown import columns
from agent_economy.types.page import ColumnOffer

DOCS = Path(__file__).resolve().parents[2] / "docs"
NOT_COLUMNS = {"run", "failed", "time_limit_s", "end.when", "completed_by", "status", "study"}
"""Words in the tables of columns that are none, or not displayed."""

ROVERS = """
clock.time_limit_s = 60
world.size_m = [20, 20]
[robots.rover]
count = 2
radius_m = 0.2
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
"""

SERVICE = """
radio = { range_m = 50 }
sensors = { gps = { kind = "position" }, compass = { kind = "heading" } }
brain = { beliefs = {}, behaviours = [{ kind = "serve" }], arbitration = { kind = "goals" } }
[goals.spot]
count = 2
"""
"""Goals that the rovers can serve, and no controllers."""


def offers(scenario: ae.Scenario) -> dict[str, ColumnOffer]:
    """Return the columns that a page is sent at the start of a run."""
    simulation = create(scenario, seed=1, run=0)
    return {each["id"]: each for each in columns.offer_of(simulation)}


def first(scenario: ae.Scenario) -> list[str]:
    """Return the columns that are displayed first."""
    return [name for name, each in offers(scenario).items() if each["is_first"]]


def all_columns(scenario: ae.Scenario) -> list[str]:
    """Return the columns of the outcome of a run."""
    return list(create(scenario, seed=1, run=0).outcome().row)


def documented(file: str) -> set[str]:
    """Return the columns in the table `Outcome columns` of a document, of a kind `mine`."""
    text = (DOCS / file).read_text(encoding="utf-8").split("# Outcome columns\n")[1]
    rows = [line for line in re.split(r"\n#", text)[0].splitlines() if line.startswith("| `")]
    names = (name for row in rows for name in re.findall("`([^`]+)`", row.split("|")[1]))
    return {re.sub("_K_", "_1_", name.replace("KIND", "mine")) for name in names} - NOT_COLUMNS


@pytest.mark.parametrize("name", bundled.scenarios())
def test_every_column_of_bundled_scenarios_has_a_description(name: str) -> None:
    names = set(all_columns(ae.Scenario.load(name))) - NOT_COLUMNS
    assert [each for each in names if description_of(each) is None] == []


def test_every_column_of_a_lane_with_vehicles_has_a_description(tmp_path: Path) -> None:
    names = set(all_columns(ae.Scenario.load(with_passage(tmp_path)))) - NOT_COLUMNS
    assert [each for each in names if description_of(each) is None] == []


@pytest.mark.parametrize("file", ["glossary.md", "simulation.md"])
def test_every_documented_column_has_a_description(file: str) -> None:
    names = documented(file)
    assert len(names) > 30
    assert [each for each in names if description_of(each) is None] == []


def test_descriptions_of_kinds_have_the_name_of_the_kind() -> None:
    found = description_of("found_big_mine")
    assert found is not None
    assert found.label == "Found: big_mine"
    assert found.out_of == ("found_big_mine", "missed_big_mine")
    find = description_of("found_mine_3_s")
    assert find is not None
    assert find.label == "Find 3 of mine"
    low = description_of("stated_clearance_mine_low")
    assert low is not None
    assert low.label == "Stated clearance of mine, from"
    assert description_of("nothing") is None


def test_descriptions_are_sentences_in_known_groups() -> None:
    for each in (*COLUMNS.values(), *OF_KINDS.values()):
        assert each.group in columns.GROUPS
        assert each.label[0].isupper()
        assert each.help[0].isupper()
        assert each.help.endswith(".")
    events = {name for each in COLUMNS.values() for name in (*each.after, each.time_of) if name}
    assert events <= set(COLUMNS)


def test_what_answers_the_question_comes_first() -> None:
    assert first(ae.Scenario.load("search")) == ["found", "time_s", "collisions"]
    assert first(ae.Scenario.load("classic")) == ["found", "time_s", "collisions"]
    assert first(ae.Scenario.load("waypoints"))[:2] == ["served", "time_s"]
    # It requires to be clear, which is known once it is declared clear.
    assert first(ae.Scenario.load("mines")) == ["declared", "stated_risk", "found"]
    # The terms of the merit, in the order of their weights.
    changed = ae.Scenario.load("search").replace("merit", {"distance": -2, "collisions": -3})
    assert first(changed)[:2] == ["collisions", "distance_m"]


def test_without_targets_goals_or_an_end_there_are_no_finds_and_no_completeness() -> None:
    sent = offers(ae.Scenario.loads(world(ROVERS)))
    absent = {"found", "missed", "false_alarms", "complete", "price", "energy_j"}
    assert sent.keys().isdisjoint(absent)
    assert {"time_s", "collisions", "distance_m", "robots"} <= sent.keys()


def test_kinds_without_items_are_left_out() -> None:
    scenario = ae.Scenario.load("open-field")
    assert "found_flag" in offers(scenario)
    sent = offers(scenario.replace("items.flag.count", 0))
    assert {"found_mine", "complete"} <= sent.keys()
    assert "found_flag" not in sent


def test_energy_and_price_are_sent_where_there_are_batteries_and_prices() -> None:
    battery = "battery = { capacity_j = 100, idle_w = 1 }\nprice = 5\n"
    assert {"energy_j", "price"} <= offers(ae.Scenario.loads(world(ROVERS + battery))).keys()


def test_kinds_of_robots_without_robots_or_charges_are_left_out() -> None:
    scenario = ae.Scenario.load(SMALL_LANE)
    sent = offers(scenario)
    assert {"charges_used_ugv", "distance_ugv_m", "on_station_oav_s"} <= sent.keys()
    # It has no charges, and no robot a battery.
    assert sent.keys().isdisjoint({"charges_used_oav", "energy_oav_j", "energy_j"})
    none = offers(scenario.replace("robots.oav.count", 0))
    assert none.keys().isdisjoint({"distance_oav_m", "on_station_oav_s"})


def test_without_controllers_no_goal_is_refused_and_no_lease_lapses() -> None:
    assert {"goals_refused", "leases_lapsed"} <= offers(ae.Scenario.load("waypoints")).keys()
    sent = offers(ae.Scenario.loads(world(ROVERS + SERVICE)))
    assert {"served", "complete"} <= sent.keys()
    assert sent.keys().isdisjoint({"goals_refused", "leases_lapsed"})


def test_times_of_finds_are_left_out() -> None:
    assert not [name for name in offers(ae.Scenario.load("search")) if re.search(r"_\d_s$", name)]


def test_a_change_of_the_scenario_changes_what_applies() -> None:
    scenario = ae.Scenario.load("search")
    assert "found" in offers(scenario)
    assert "found" not in offers(scenario.replace("items.mine.count", 0))


def test_what_removed_robots_have_used_is_still_sent() -> None:
    simulation = create(ae.Scenario.load(SMALL_LANE), seed=1, run=1)
    simulation.step(20)
    simulation.change("robots.oav.count", 0)
    assert "distance_oav_m" in {each["id"] for each in columns.offer_of(simulation)}

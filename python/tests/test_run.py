"""One run of a scenario."""

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest
from alarm import ringing
from metric import ENDLESS, FULL, HUGE, search

import agent_economy as ae
from agent_economy import InputError, Scenario


@pytest.mark.parametrize("name", ["search", "classic"])
def test_a_run_equals_its_row_of_replicate(name: str) -> None:
    rows = ae.replicate(name, 12, seed=5, first_run=40).to_pylist()
    assert [ae.run(name, seed=5, run=40 + index).row for index in range(12)] == rows


def test_an_outcome_agrees_with_its_row() -> None:
    outcomes = [ae.run("search", seed=1, run=run) for run in range(12)]
    assert {each.status for each in outcomes} == {"complete", "incomplete"}
    for each in outcomes:
        found, missed = each.found["mine"], each.missed["mine"]
        assert found is not None
        assert missed is not None
        assert found + missed == 4
        assert each.complete == (each.status == "complete") == (missed == 0)
        assert each.complete or each.time_s == 120
        assert (each.row["found_mine"], each.row["complete"]) == (found, each.complete)
        for name in ("robots", "price", "energy_j", "distance_m", "merit", "time_s"):
            assert getattr(each, name) == each.row[name]
        assert each.time_s is not None
        assert each.merit == pytest.approx(-0.03 * each.time_s - 0.2 * 4 - 5 * (missed > 0))


def test_a_row_has_the_time_of_each_find_in_ascending_order() -> None:
    for run in range(12):
        simulation = ae.Simulation("search", 1, run)
        outcome = simulation.finish()
        times = [outcome.row[f"found_mine_{number}_s"] for number in range(1, 5)]
        found = [each for each in simulation.items["found_s"].to_pylist() if each is not None]
        assert times == sorted(found) + [None] * (4 - len(found))
        assert list(outcome.row)[-5:-1] == [f"found_mine_{number}_s" for number in range(1, 5)]
        assert outcome.row == ae.run("search", 1, run).row
        if outcome.complete:
            assert times[-1] == outcome.time_s


def test_an_outcome_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        ae.run("search").time_s = 1  # type: ignore[misc]


def test_each_run_and_each_seed_is_another_world() -> None:
    worlds = [ae.run("search", seed, run).energy_j for seed in (0, 1) for run in (0, 1)]
    assert len(set(worlds)) == 4


def test_a_scenario_may_be_an_object_a_file_or_a_name(classic_toml: Path) -> None:
    loaded = Scenario.load("classic")
    given: list[Scenario | str | Path] = [loaded, classic_toml, str(classic_toml), "classic"]
    outcomes = [ae.run(each, 3, 4) for each in given]
    assert all(each == outcomes[0] for each in outcomes)
    assert outcomes[0].found == {"item": 4}
    assert outcomes[0].energy_j is None


def test_events_that_never_happen_are_none() -> None:
    lonely = Scenario.load("classic").replace("robots.wanderer.count", 1)
    table = ae.replicate(lonely, 200)
    never = table["paints"].to_pylist().index(None)
    outcome = ae.run(lonely, run=never)
    assert outcome.row["paints"] is None
    assert outcome.status == "incomplete"
    assert outcome.time_s == 120


def test_a_quarantined_run_has_none_and_never_nan() -> None:
    outcome = ae.run(Scenario.loads(FULL), run=9)
    assert (outcome.status, outcome.run) == ("quarantined", 9)
    assert outcome.found == {"mine": None}
    values = {name: value for name, value in outcome.row.items() if name != "run"}
    assert set(values.values()) == {None}


def test_all_numbers_of_a_row_are_finite() -> None:
    rows = (
        ae.replicate("classic", 300).to_pylist() + ae.replicate(Scenario.loads(FULL), 3).to_pylist()
    )
    floats = [value for row in rows for value in row.values() if isinstance(value, float)]
    assert floats
    assert all(map(math.isfinite, floats))


def test_a_large_run_is_the_same_alone_and_among_others() -> None:
    huge = search(HUGE)
    rows = ae.replicate(huge, 4, seed=2, threads=1).to_pylist()
    assert ae.run(huge, 2, 3).row == rows[3]


def test_all_invalid_arguments_are_reported() -> None:
    with pytest.raises(InputError) as caught:
        ae.run("search", seed=-1, run=1.5)  # type: ignore[arg-type]
    lines = str(caught.value).splitlines()
    assert lines[0].startswith("seed = -1: must be a whole number from 0 to 18446744073709551615")
    assert lines[1].startswith("run = 1.5: must be a whole number from 0 to 922337203")
    assert len(lines) == 2
    with pytest.raises(InputError, match="run = True: must be"):
        ae.run("search", run=True)


def test_other_types_than_scenarios_are_named() -> None:
    with pytest.raises(InputError, match="scenario = 7: must be a Scenario, a file, or the name"):
        ae.run(7)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"serach: cannot be read: .*did you mean search\?"):
        ae.run("serach")


@pytest.mark.parametrize("changes", [ENDLESS, HUGE | ENDLESS], ids=["long", "huge"])
def test_a_signal_stops_a_run(changes: dict[str, Any]) -> None:
    endless = search(changes)
    with ringing(0.5):
        ae.run(endless)

"""The condition with which a run is complete, `[end]`."""

import json
from pathlib import Path

import pytest
from command_line import run, succeed
from metric import search

import agent_economy as ae
from agent_economy import InputError, Scenario

TWO = {"end.when": "found_mine >= 2"}

BRIEF = {"clock.time_limit_s": 30}
"""Half of the runs do not find two mines."""


def test_a_run_is_complete_with_its_condition_at_the_time_of_the_find() -> None:
    rows = ae.replicate(search({**TWO, **BRIEF}), 40).to_pylist()
    assert {row["complete"] for row in rows} == {True, False}
    for row in rows:
        if row["complete"]:
            assert row["time_s"] == row["found_mine_2_s"]
            assert row["found_mine"] >= 2
        else:
            assert (row["time_s"], row["found_mine_2_s"]) == (30, None)
    assert any(row["missed_mine"] > 0 for row in rows if row["complete"])
    # The same worlds, searched for all mines.
    for row, every in zip(rows, ae.replicate(search(BRIEF), 40).to_pylist(), strict=True):
        assert row["found_mine_1_s"] == every["found_mine_1_s"]
        assert not row["complete"] or row["found_mine_2_s"] == every["found_mine_2_s"]


@pytest.mark.parametrize("threads", [2, 8])
def test_threads_change_no_byte(threads: int) -> None:
    one = ae.replicate(search(TWO), 64, seed=3, threads=1)
    assert ae.replicate(search(TWO), 64, seed=3, threads=threads).equals(one)


def test_the_condition_can_be_changed_during_a_run() -> None:
    simulation = ae.Simulation(search(TWO), 7, 2)
    simulation.change("end.when", "found_mine >= 3")
    three = simulation.finish()
    assert three == ae.Simulation(search({"end.when": "found_mine >= 3"}), 7, 2).finish()
    simulation.change("end.when", "found_mine >= 1")
    assert simulation.is_over
    assert simulation.outcome().time_s == three.time_s


def test_a_recording_of_a_changed_condition_is_replayed(tmp_path: Path) -> None:
    file = tmp_path / "run.mcap"
    simulation = ae.Simulation(search(TWO), 7, 2)
    with ae.Recording(simulation, file) as recording:
        recording.step(50)
        simulation.change("end.when", "found_mine >= 3")
        outcome = recording.finish()
    replayed = ae.replay(file)
    assert replayed.agrees
    assert replayed.outcome == outcome


def test_the_classic_engine_names_the_engine_that_has_the_key() -> None:
    with pytest.raises(InputError, match=r"end = .*must be left out: only the engine \"metric\""):
        Scenario.load("classic").replace("end", {"when": "found >= 2"})


def test_impossible_conditions_are_reported_with_the_file(tmp_path: Path) -> None:
    file = tmp_path / "impossible.toml"
    text = search().source.text
    file.write_text(f'{text}\n[end]\nwhen = "found_mine >= 5"\n')
    given = run("check", file, "--json")
    (error,) = json.loads(given.stdout)
    assert error["path"] == "end.when"
    assert error["line"] == text.count("\n") + 3
    assert error["allowed"].endswith("found_mine is a whole number from 0 to 4")


def test_a_study_of_item_counts_has_one_set_of_columns(tmp_path: Path) -> None:
    scenario = search({"study.vary": {"items.mine.count": "1,3,6"}, **TWO})
    folder = tmp_path / "study"
    ae.study.run(scenario, runs=10, out=folder)
    runs = ae.study.open(folder).runs()
    assert [name for name in runs.columns if name.endswith("_s")][1:] == [
        f"found_mine_{number}_s" for number in range(1, 7)
    ]
    # One mine is never two: these runs fail, and are not quarantined.
    alone = runs.filter("configuration = 0").to_arrow_table()
    assert alone["failed"].to_pylist() == [True] * 10
    assert alone["found_mine_2_s"].null_count == 10
    assert alone["quarantined"].to_pylist() == [False] * 10


def test_the_facts_of_a_scenario_include_its_condition() -> None:
    assert ("complete when", "found_mine >= 2") in search(TWO).facts
    assert "complete when" not in dict(search().facts)
    assert "complete" in succeed("run", "search", "--set", "end.when=found_mine >= 1").stdout

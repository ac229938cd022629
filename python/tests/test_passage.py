"""Vehicles that pass a mined lane, from Python, in recordings and in answers."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from lanes import SMALL_LANE, with_passage
from recorded import contents

import agent_economy as ae
from agent_economy.cli.lane_rows import lane_rows
from agent_economy.runs.passage import ClearedShare, Passage, Vehicle
from agent_economy.server.runs.shown import passage as shown_passage
from agent_economy.server.runs.shown import subjects
from agent_economy.server.runs.shown.subject import Request
from agent_economy.study.answer.clearance import clearance, in_words
from agent_economy.study.answer.evidence import Sample


def stated(simulation: ae.Simulation) -> Passage:
    """Return the passage that the first controller has stated."""
    passage = simulation.lanes[0].passage
    assert passage is not None
    return passage


def finished(folder: Path, **changes: float) -> ae.Simulation:
    """Finish a run with vehicles."""
    scenario = ae.Scenario.load(with_passage(folder))
    for path, value in changes.items():
        scenario = scenario.replace(path, value)
    simulation = ae.Simulation(scenario, seed=1)
    simulation.step(10_000)
    return simulation


def test_a_run_without_vehicles_has_none_and_states_no_passage() -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    simulation.step(10_000)
    assert simulation.vehicles == []
    assert all(lane.passage is None for lane in simulation.lanes)
    assert "vehicles_passed" not in simulation.outcome().row


def test_vehicles_drive_from_end_to_end_of_a_lane_that_was_declared_clear(tmp_path: Path) -> None:
    simulation = finished(tmp_path)
    passage = stated(simulation)
    assert (passage.path_m[0][0], passage.path_m[-1][0]) == (6, 46)
    assert 0 < passage.risks[2] < passage.risks[1] < passage.risks[0] < 0.05
    assert len(simulation.vehicles) == 3
    for vehicle in simulation.vehicles:
        assert vehicle.status in {"passed", "lost"}
        if vehicle.status == "passed":
            assert vehicle.at_m == passage.path_m[-1]
    ids = frozenset({"passage", "vehicles"})
    shown = subjects.shown(simulation, Request(layers=ids))
    assert shown is not None
    (line,) = shown["layers"]["passage"]["lines"]
    assert (line["points"], line["band"]) == (passage.path_m, passage.width_m)
    markers = shown["layers"]["vehicles"]["markers"]
    assert [marker["at"] for marker in markers] == [each.at_m for each in simulation.vehicles]


def test_the_risks_of_the_first_and_the_last_vehicle_are_stated_in_words() -> None:
    def words(*risks: float) -> str:
        path = Passage([(8.0, 14.0), (208.0, 14.0)], 3.0, 200.0, 0.00421, list(risks))
        return f"{shown_passage.passage_label(path)} {shown_passage.path_label(path)}"

    path = "Path of 200 m, 3 m wide: 0.00421 mines expected in it."
    assert words(0.0031) == f"Risk of the first vehicle 0.31%. {path}"
    assert words(0.12, 0.02, 0.01) == f"Risk of the first vehicle 12%, last of 3 1%. {path}"


@pytest.mark.parametrize(
    ("statuses", "words"),
    [
        (["passed", "passed"], "2 vehicles passed, 0 lost."),
        (
            ["lost", "passed", "driving"],
            "1 vehicle passed, 1 lost (with the first), 1 driving.",
        ),
        (["passed", "lost"], "1 vehicle passed, 1 lost."),
    ],
)
def test_what_has_become_of_the_vehicles_is_reported(statuses: list[Any], words: str) -> None:
    vehicles = [Vehicle(f"vehicle/{i}", (0, 0), True, each) for i, each in enumerate(statuses)]  # noqa: FBT003
    assert shown_passage.vehicles_label(vehicles) == words


def test_the_share_that_is_cleared_has_its_interval_in_words() -> None:
    share = ClearedShare("mine", cleared=5, left=0.1, share=0.983, low=0.8333, high=1)
    assert shown_passage.cleared_label(share) == "98.3% (95% interval 83.3% to 100%)"


def test_the_share_of_mines_that_is_cleared_is_believed_with_an_interval() -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    (before,) = simulation.lanes[0].clearance
    # No mine, with a probability of exp(-3), is a lane that is cleared.
    assert before.kind == "mine"
    assert before.share == pytest.approx(np.exp(-3))
    assert (before.cleared, before.low) == (0, 0)
    assert [before.left, before.high] == pytest.approx([3, 1])
    simulation.step(10_000)
    (after,) = simulation.lanes[0].clearance
    assert after.cleared == pytest.approx(3)
    assert after.share > 0.95
    assert after.low <= after.share <= after.high


def test_a_run_prints_what_was_stated_beside_the_truth(tmp_path: Path) -> None:
    row = ae.run(with_passage(tmp_path), seed=1).row
    rows = dict(lane_rows(row))
    assert rows["clearance of mine"].startswith("stated 9")
    assert "95% interval" in rows["clearance of mine"]
    assert "in truth 100" in rows["clearance of mine"]
    assert "for the first vehicle" in rows["passage"]
    assert rows["vehicles"].endswith(" lost") or "with the first" in rows["vehicles"]


def test_a_recording_has_the_path_once_and_the_vehicles_while_they_drive(
    tmp_path: Path, mcap: Path
) -> None:
    simulation = ae.Simulation(ae.Scenario.load(with_passage(tmp_path)), seed=1)
    with ae.Recording(simulation, mcap) as recording:
        recording.step(10_000)
    topics, schemas, *_ = contents(mcap)
    passages = [message.content for message in topics["/lane/passage"]]
    assert {each["controller"] for each in passages} == {"station/0", "station/1"}
    assert len(passages) == 2
    jsonschema.validate(passages[0], json.loads(schemas["/lane/passage"].data))
    assert passages[0]["risks"] == stated(simulation).risks
    (scene,) = topics["/lane/path/station/0"]
    assert scene.content.entities[0].lines[0].thickness == 3
    last = topics["/lane/vehicles"][-1].content
    assert {entity.id for entity in last.entities} == {"vehicle/0", "vehicle/1", "vehicle/2"}
    assert len(topics["/lane/vehicles"]) > 50
    lines = [message.content for message in topics["/log"] if "passed" in message.content.message]
    assert {line.name for line in lines} == {
        vehicle.name for vehicle in simulation.vehicles if vehicle.status == "passed"
    }
    shares = topics["/lane"][-1].content["controllers"]["clearance"][0]
    assert shares[0]["share"] == simulation.lanes[0].clearance[0].share


def test_an_answer_has_the_clearance_of_each_kind_and_the_losses_of_vehicles() -> None:
    columns = {
        "declared": [1, 1, 1, 1, 0],
        "declared_not_clear": [1, 0, 0, 0, 0],
        "stated_risk": [0.1, 0.1, 0.1, 0.1, 1],
        "declared_s": [100, 100, 100, 100, 300],
        "true_clearance_mine": [0.5, 1, 1, 1, 0],
        "stated_clearance_mine": [0.9, 0.9, 0.9, 0.9, 0],
        "stated_clearance_mine_low": [0.8, 0.8, 0.8, 0.8, 0],
        "stated_clearance_mine_high": [1, 1, 1, 1, 1],
        "stated_first_risk": [0.04, 0.04, 0.04, 0.04, 1],
        "stated_last_risk": [0.01, 0.01, 0.01, 0.01, 1],
        "first_lost": [1, 0, 0, 0, 0],
        "last_lost": [0, 0, 0, 0, 0],
        "vehicles_passed": [1, 2, 2, 1, 0],
        "vehicles_lost": [1, 0, 0, 0, 0],
    }
    sample = Sample({}, {name: np.array(each, float) for name, each in columns.items()}, {}, 0)
    found = clearance(sample, 0.95)
    assert found is not None
    (mine,) = found.cleared
    assert (mine.kind, mine.share, mine.stated, mine.inside) == ("mine", 0.875, 0.9, 0.75)
    # One lane was declared so late that its vehicles did not finish.
    assert found.vehicles is not None
    assert found.vehicles.lanes == 3
    assert found.vehicles.first_lost.value == pytest.approx(1 / 3)
    assert found.vehicles.last_lost.value == 0
    words = in_words(found)
    assert (
        "; clearance of mine 87.5%, stated 90%; first vehicle lost in 33.3% (0.84 to 90.6%)"
        in words
    )
    assert words.endswith(", stated 4%")


def test_a_study_reads_the_columns_of_a_passage(tmp_path: Path) -> None:
    scenario = ae.Scenario.load(with_passage(tmp_path))
    runs = ae.replicate(scenario, 3, 1)
    for name in ("stated_first_risk", "first_lost", "vehicles_lost", "true_clearance_mine"):
        assert name in runs.column_names
    assert np.all(np.array(runs["vehicles_passed"]) + np.array(runs["vehicles_lost"]) <= 3)

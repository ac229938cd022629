"""Recordings of a mined lane, and their replay."""

import json
from pathlib import Path

import jsonschema
import numpy as np
from lanes import SMALL_LANE
from recorded import SECOND_NS, contents

import agent_economy as ae
from agent_economy.recording.lane_topics import CELL, PALETTE
from agent_economy.recording.reading import read
from agent_economy.server.runs.timeline import Timeline


def recorded(path: Path, steps: int = 775) -> ae.Simulation:
    """Record the first steps of a run; by default until both controllers have declared it clear."""
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    with ae.Recording(simulation, path) as recording:
        recording.step(steps)
    return simulation


def test_each_recorded_step_has_the_risk_and_the_mines_that_are_left(mcap: Path) -> None:
    simulation = recorded(mcap)
    topics, schemas, *_ = contents(mcap)
    assert len(topics["/lane"]) == len(topics["/robots"]) == simulation.tick + 1
    for topic in ("/lane", "/lane/marks"):
        schema = json.loads(schemas[topic].data)
        for message in topics[topic]:
            jsonschema.validate(message.content, schema)
    first, last = topics["/lane"][0].content, topics["/lane"][-1].content
    assert (first["mines_left"], last["mines_left"]) == (3, 0)
    assert first["controllers"]["statement_is_clear"] == [None, None]
    assert last["controllers"]["statement_is_clear"] == [True, True]
    risks = [lane.risk.probability for lane in simulation.lanes]
    assert last["controllers"]["probability"] == risks


def test_marks_and_maps_are_recorded_every_five_seconds_and_with_statements(mcap: Path) -> None:
    simulation = recorded(mcap)
    topics = contents(mcap).topics
    times_s = [message.time_ns / SECOND_NS for message in topics["/lane/marks"]]
    # A step ends 0.2 s after the time at which the controllers decide in it.
    stated_s = {0.2 + lane.statement.at_s for lane in simulation.lanes if lane.statement}
    assert stated_s
    assert stated_s <= set(times_s)
    assert np.diff(times_s).max() <= 5
    assert len(times_s) <= simulation.time_s / 5 + 1 + len(stated_s)
    for lane in simulation.lanes:
        maps = topics[f"/lane/map/{lane.controller}"]
        assert [message.time_ns / SECOND_NS for message in maps] == times_s
    marks = topics["/lane/marks"][-1].content["marks"]
    assert marks["verdict"].count("neutralised") == 6


def test_a_map_has_the_expected_mines_of_each_cell_and_their_colours(mcap: Path) -> None:
    recorded(mcap)
    maps = contents(mcap).topics["/lane/map/station/0"]
    cells = [np.frombuffer(message.content.data, CELL) for message in maps]
    first, last = cells[0].reshape(5, 20), cells[-1].reshape(5, 20)
    np.testing.assert_allclose(first["expected_mines"].sum(), 3, rtol=1e-6)
    lane = ae.Simulation(SMALL_LANE, seed=1).lanes[0]
    np.testing.assert_allclose(first["expected_mines"], lane.expected, rtol=1e-6)
    cleared = last["expected_mines"] < lane.cleared_below_per_m2 * lane.area_m2
    assert cleared.any()
    assert (last["rgba"][cleared] == [*PALETTE[0], 255]).all()
    grid = maps[0].content
    assert (grid.column_count, grid.cell_size.x, grid.row_stride) == (20, 2, 160)
    assert (grid.pose.position.x, grid.pose.position.y) == (6, 2)


def test_a_scenario_without_a_lane_has_no_such_topic(mcap: Path) -> None:
    ae.run(ae.Scenario.load("search").replace("clock.time_limit_s", 2), record=mcap)
    assert not any(topic.startswith("/lane") for topic in contents(mcap).topics)


def test_a_player_that_steps_back_returns_to_the_same_lane(mcap: Path) -> None:
    simulation = recorded(mcap, 400)
    identity, history = read(mcap)
    timeline = Timeline(identity.scenario, identity.seed, identity.run, None, history)

    def risks(tick: int) -> list[float]:
        while not timeline.seek(tick, 60.0):
            pass
        run = timeline.simulation
        assert isinstance(run, ae.Simulation)
        return [lane.risk.probability for lane in run.lanes]

    early, late = risks(150), risks(400)
    assert early != late
    assert late == [lane.risk.probability for lane in simulation.lanes]
    assert risks(150) == early
    assert timeline.recorded.mismatch_tick is None
    assert ae.replay(mcap).agrees

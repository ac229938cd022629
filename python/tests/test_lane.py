"""What controllers believe of a mined lane, from Python."""

import numpy as np
from lanes import SMALL_LANE

import agent_economy as ae


def test_a_run_without_a_lane_has_neither_lanes_nor_mines() -> None:
    simulation = ae.Simulation("waypoints")
    assert simulation.lanes == []
    assert simulation.mines_left == 0


def test_before_any_look_the_expected_mines_are_those_of_the_prior() -> None:
    first, second = ae.Simulation(SMALL_LANE, seed=1).lanes
    assert [first.controller, second.controller] == ["station/0", "station/1"]
    assert first.corners_m == ((6, 2), (46, 12))
    assert first.expected.shape == first.area_m2.shape == (5, 20)
    np.testing.assert_allclose(first.unmarked.sum(), 3)
    np.testing.assert_allclose(first.area_m2.sum(), 400)
    np.testing.assert_allclose(first.risk.probability, 1 - np.exp(-3))
    assert not first.cleared.any()
    assert first.marks == []
    assert first.statement is None


def test_a_lane_is_declared_clear_when_its_risk_is_low_and_its_mines_are_gone() -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    assert simulation.mines_left == 3
    simulation.step(10_000)
    assert simulation.mines_left == 0
    for lane in simulation.lanes:
        assert lane.statement is not None
        assert lane.statement.is_clear
        assert lane.statement.risk < lane.declare_below
        neutralised = [mark for mark in lane.marks if mark.verdict == "neutralised"]
        assert len(neutralised) == 3
        assert all(mark.mine == 0 for mark in neutralised)
        assert lane.cleared.mean() > 0.5
        np.testing.assert_allclose(lane.unmarked.sum(), lane.risk.unmarked)


def test_the_last_cells_of_a_lane_are_as_large_as_their_part_in_it() -> None:
    scenario = ae.Scenario.load(SMALL_LANE).replace("controllers.station.clearance.cell_m", 3)
    lane = ae.Simulation(scenario, seed=1).lanes[0]
    assert lane.area_m2.shape == lane.expected.shape == (4, 14)
    assert lane.area_m2[-1, -1] == 1
    np.testing.assert_allclose(lane.expected / lane.area_m2, 3 / 400)

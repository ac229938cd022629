"""The mined lane, as a page receives it."""

import base64
import math
from typing import Any

import numpy as np
import pytest
from lanes import SMALL_LANE
from page_client import Page

import agent_economy as ae
from agent_economy.server.runs.lane_view import lane_view, quantised, scale_of

REQUEST = {"links": False, "footprints": False, "lanes": True}


def received(page: Page) -> list[dict[str, Any]]:
    """Return the lanes that the page has received."""
    return [message for message in page.received if message["type"] == "lanes"]


def test_a_lane_is_sent_only_while_it_is_requested(page: Page) -> None:
    page.open(scenario=None, text=SMALL_LANE.read_text())
    page.step(5, to=5)
    assert not received(page)
    page.send("layers", **REQUEST)
    message = page.wait_for("lanes", tick=5)
    assert [lane["controller"] for lane in message["lanes"]] == ["station/0", "station/1"]
    page.send("layers", links=False, footprints=False)
    page.step(5, to=10)
    page.step(5, to=15)
    assert {message["tick"] for message in received(page)} == {5}


def test_runs_without_a_lane_have_no_such_message(page: Page) -> None:
    page.send("layers", **REQUEST)
    for scenario in ("waypoints", "classic"):
        page.open(scenario=scenario)
        page.step(5, to=5)
        page.step(5, to=10)
    assert not received(page)


def test_a_lane_is_the_belief_of_its_controller_beside_the_truth(page: Page) -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=3)
    simulation.step(200)
    page.send("layers", **REQUEST)
    page.open(scenario=None, text=SMALL_LANE.read_text(), seed="3", tick=200)
    message = page.wait_for("lanes", tick=200)
    assert message["mines_left"] == simulation.mines_left
    for view, lane in zip(message["lanes"], simulation.lanes, strict=True):
        assert view["risk"] == lane.risk._asdict()
        assert view["corners"] == [[6, 2], [46, 12]]
        assert [mark["mine"] for mark in view["marks"]] == [mark.mine for mark in lane.marks]
        cells = np.frombuffer(base64.b64decode(view["expected"]), np.uint8)
        cells = cells.reshape(view["rows"], view["columns"])
        assert (cells <= view["scale"]["cleared"]).tolist() == lane.cleared.tolist()
    assert message["lanes"][0]["marks"]


def test_the_statement_of_a_controller_is_sent() -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    simulation.step(10_000)
    statements = [lane_view(lane)["statement"] for lane in simulation.lanes]
    assert statements[0] is not None
    assert statements[0]["is_clear"]
    assert statements[0]["risk"] < 0.05


@pytest.mark.parametrize("cleared_below", [1e-6, 5e-4])
def test_bytes_are_rounded_up_and_separate_cleared_cells(cleared_below: float) -> None:
    scale = scale_of(cleared_below)
    values = cleared_below * np.logspace(-2, 5, 1000)
    cells = quantised(values, scale)
    assert ((cells <= scale["cleared"]) == (values <= cleared_below)).all()
    ratio = (scale["max"] / scale["min"]) ** (1 / 255)
    inside = (values >= scale["min"]) & (values <= scale["max"])
    upper = scale["min"] * ratio ** cells[inside].astype(float)
    assert (values[inside] <= upper * (1 + 1e-9)).all()
    assert (values[inside] >= upper / ratio * (1 - 1e-9)).all()
    assert (cells[values > scale["max"]] == 255).all()
    assert math.isclose(scale["min"] * ratio ** scale["cleared"], cleared_below)

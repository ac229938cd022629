"""The mined lane, as a page receives it."""

import base64
import math
from typing import Any

import numpy as np
import pytest
from lanes import SMALL_LANE
from page_client import Page

import agent_economy as ae
from agent_economy.server.runs.shown import lane, subjects
from agent_economy.server.runs.shown.subject import Request
from agent_economy.server.runs.shown.tables import percent

LAYERS = ["lane-risk", "lane-path", "lane-marks"]
ALL = Request(layers=frozenset(LAYERS), panels=frozenset({"lane"}))


def received(page: Page) -> list[dict[str, Any]]:
    """Return the layers and panels that the page has received."""
    return [message for message in page.received if message["type"] == "shown"]


def paragraphs(panel: Any) -> list[str]:
    """Return the paragraphs of a panel."""
    return [
        paragraph["text"] for section in panel["sections"] for paragraph in section["paragraphs"]
    ]


def test_a_lane_is_sent_only_while_it_is_requested(page: Page) -> None:
    page.open(scenario=None, text=SMALL_LANE.read_text())
    page.step(5, to=5)
    assert not received(page)
    page.send("show", layers=LAYERS[:2], panels=["lane"])
    message = page.wait_for("shown", tick=5)
    assert list(message["layers"]) == LAYERS[:2]
    (choice,) = (each["choice"] for each in message["panels"]["lane"]["sections"] if each["choice"])
    assert (choice["chosen"], choice["options"]) == ("station/0", ["station/0", "station/1"])
    page.send("show", layers=[])
    page.step(5, to=10)
    page.step(5, to=15)
    assert {message["tick"] for message in received(page)} == {5}


def test_runs_without_a_lane_neither_offer_it_nor_send_it(page: Page) -> None:
    page.send("show", layers=LAYERS, panels=["lane"])
    for scenario in ("open-field", "classic"):
        page.open(scenario=scenario)
        page.step(5, to=5)
        page.step(5, to=10)
    offers = [each["offer"] for each in page.received if each["type"] == "setting"]
    assert [(each["layers"], each["panels"]) for each in offers] == [([], [])] * 2
    assert not received(page)


def test_a_lane_is_the_belief_of_the_chosen_controller_beside_the_truth(page: Page) -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=3)
    simulation.step(200)
    page.open(scenario=None, text=SMALL_LANE.read_text(), seed="3", tick=200)
    for of in simulation.lanes:
        page.send("show", layers=LAYERS, panels=["lane"], choices={"lane": of.controller})
        message = page.wait_for("shown", tick=200)
        while message["panels"]["lane"]["sections"][0]["heading"] != f"Belief of {of.controller}":
            message = page.wait_for("shown", tick=200)
        truth = "No mines" if simulation.mines_left == 0 else f"{simulation.mines_left} mine"
        found = paragraphs(message["panels"]["lane"])
        assert any(text.startswith(truth) for text in found)
        assert found[0].startswith(f"Remaining risk {percent(of.risk.probability)}:")
        raster = message["layers"]["lane-risk"]["raster"]
        assert message["layers"]["lane-risk"]["clip"] == [[6, 2], [46, 12]]
        cells = np.frombuffer(base64.b64decode(raster["cells"]), np.uint8)
        cells = cells.reshape(raster["rows"], raster["columns"])
        assert (cells <= raster["scale"]["first"]).tolist() == of.cleared.tolist()
        markers = message["layers"]["lane-marks"]["markers"]
        assert sorted(marker["at"] for marker in markers) == sorted(
            list(mark.at_m) for mark in of.marks
        )
        assert markers


def test_the_statement_of_a_controller_ends_its_call_off_button() -> None:
    simulation = ae.Simulation(SMALL_LANE, seed=1)
    before = subjects.shown(simulation, ALL)
    simulation.step(10_000)
    after = subjects.shown(simulation, ALL)
    assert before is not None
    assert after is not None
    first, last = (shown["panels"]["lane"]["sections"][0] for shown in (before, after))
    path = "controllers.station.clearance.called_off"
    assert first["button"] == {"label": "Call off the mission", "path": path}
    assert last["button"] is None
    assert any(text.startswith("Declared clear at") for text in paragraphs(after["panels"]["lane"]))


@pytest.mark.parametrize("cleared_below", [1e-6, 5e-4])
def test_bytes_are_rounded_up_and_separate_cleared_cells(cleared_below: float) -> None:
    scale = lane.scale_of(cleared_below)
    values = cleared_below * np.logspace(-2, 5, 1000)
    cells = lane.quantised(values, scale)
    assert ((cells <= scale.cleared) == (values <= cleared_below)).all()
    ratio = (scale.highest / scale.lowest) ** (1 / 255)
    inside = (values >= scale.lowest) & (values <= scale.highest)
    upper = scale.lowest * ratio ** cells[inside].astype(float)
    assert (values[inside] <= upper * (1 + 1e-9)).all()
    assert (values[inside] >= upper / ratio * (1 - 1e-9)).all()
    assert (cells[values > scale.highest] == 255).all()
    assert math.isclose(scale.lowest * ratio**scale.cleared, cleared_below)


def test_ticks_of_the_scale_are_powers_of_ten_behind_the_word_cleared() -> None:
    found = [(each["label"], round(each["place"], 2)) for each in lane.ticks(lane.scale_of(2e-6))]
    assert found == [("cleared", 0.0), ("1e-5", 0.23), ("0.0001", 0.57), ("0.001", 0.9)]


def test_the_border_has_a_line_for_each_straight_side() -> None:
    cleared = np.zeros((3, 4), bool)
    cleared[0, :2] = cleared[1, 1] = True
    corner, cell_m = (10.0, 20.0), 2.0
    lines = {tuple(map(tuple, ends)) for ends in lane.border_of(cleared, corner, cell_m)}
    in_cells = {
        ((0, 0), (2, 0)),
        ((0, 1), (1, 1)),
        ((1, 2), (2, 2)),
        ((0, 0), (0, 1)),
        ((1, 1), (1, 2)),
        ((2, 0), (2, 2)),
    }
    assert lines == {tuple((10 + 2 * x, 20 + 2 * y) for x, y in ends) for ends in in_cells}


@pytest.mark.parametrize(
    ("probability", "words"),
    [
        (0.0314, "3.1%"),
        (0.05, "5%"),
        (0.634, "63%"),
        (0.99999, "over 99.9%"),
        (0.0002, "0.02%"),
        (1e-6, "under 0.01%"),
        (0.0, "0%"),
    ],
)
def test_a_percentage_has_two_figures(probability: float, words: str) -> None:
    assert percent(probability) == words

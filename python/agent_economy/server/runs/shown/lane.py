"""The mined lane of a run: what a controller believes of it."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from agent_economy.runs.lane import BelievedLane, Floats
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.belief_view import packed
from agent_economy.server.runs.shown import lane_panel
from agent_economy.server.runs.shown.drawing import (
    Symbols,
    box,
    fill,
    glyph,
    key,
    key_of_area,
    layer,
    line,
    stroke,
)
from agent_economy.server.runs.shown.lane_choice import chosen_lane
from agent_economy.server.runs.shown.subject import Contents, Request, Subject
from agent_economy.types.brain import Point
from agent_economy.types.page import Colour, Glyph, Key, Layer, LayerOffer, ScaleTick, Shape

RISK, PATH, MARKS, PANEL = "lane-risk", "lane-path", "lane-marks", "lane"
DECADES_BELOW, DECADES_ABOVE = 1, 4
"""Decades of the scale below and above the value of a cell that is just cleared. 255 steps are 51 a
decade: that value is a step, so that the bytes decide exactly which cells are cleared."""

STEPS = 255
SHOWN_DECADES = 3
"""Decades of the colours: the first is that of cells that are cleared."""

COLOURS: list[Colour] = ["risk-1", "risk-2", "risk-3", "risk-4", "risk-5"]

CLEARED_LABEL = 0.14
"""Ticks of the scale before this place would be over the word "cleared"."""

SHAPES: dict[str, Shape] = {
    "unverified": "circle",
    "confirmed": "triangle",
    "rejected": "cross",
    "missed": "diamond",
    "neutralised": "tick",
    "isolated": "hexagon",
}
"""The shape of a mark by the last statement about it."""


class LaneScale(NamedTuple):
    """A logarithmic scale of bytes.

    Byte b stands for up to `lowest` (`highest` / `lowest`)^(b / 255), and for more than a byte less
    does. 0 also stands for less than `lowest`, and 255 for more than `highest`.

    Attributes:
        lowest: The value of byte 0.
        highest: The value of byte 255.
        cleared: Cells with up to this byte are cleared.
    """

    lowest: float
    highest: float
    cleared: int


def is_in(simulation: Simulation) -> bool:
    """Return whether controllers of a run are to clear a lane."""
    return lane_panel.clearing_kind(simulation.scenario.to_dict()) is not None


def contents(simulation: Simulation, request: Request) -> Contents | None:
    """Return what the chosen controller believes; None if there is no lane."""
    lane = chosen_lane(simulation, request)
    if lane is None:
        return None
    return Contents(
        layers={
            RISK: lambda: risk_layer(lane),
            PATH: lambda: path_layer(lane),
            MARKS: lambda: marks_layer(lane),
        },
        panels={PANEL: lambda: lane_panel.panel(simulation, lane)},
    )


def risk_layer(lane: BelievedLane) -> Layer:
    """Return the remaining risk in each cell, in the colours of a scale."""
    rows, columns = lane.expected.shape
    full_m2 = lane.cell_m**2
    scale = scale_of(lane.cleared_below_per_m2 * full_m2)
    side = f"{lane.cell_m:.3g} m"
    return layer() | {
        "clip": lane.corners_m,
        "raster": {
            "corner": lane.corners_m[0],
            "cell": lane.cell_m,
            "columns": columns,
            "rows": rows,
            "cells": packed(quantised(lane.expected / lane.area_m2 * full_m2, scale)),
            "scale": {
                "label": f"Expected mines per cell of {side} × {side}",  # noqa: RUF001
                "first": scale.cleared,
                "last": scale.cleared + SHOWN_DECADES * STEPS // (DECADES_BELOW + DECADES_ABOVE),
                "colours": COLOURS,
                "ticks": ticks(scale),
            },
        },
        "areas": [box(lane.corners_m, stroke("border", 1.0))],
    }


def scale_of(cleared_below: float) -> LaneScale:
    """Return the scale of bytes, for the expected mines of a full cell that is just cleared."""
    return LaneScale(
        cleared_below / 10**DECADES_BELOW,
        cleared_below * 10**DECADES_ABOVE,
        STEPS * DECADES_BELOW // (DECADES_BELOW + DECADES_ABOVE),
    )


def quantised(expected: Floats, scale: LaneScale) -> NDArray[np.uint8]:
    """Return expected mines as bytes of a scale, rounded up."""
    decades = np.log10(np.maximum(expected / scale.lowest, 1.0))
    steps = np.ceil(decades * STEPS / (DECADES_BELOW + DECADES_ABOVE))
    bytes_: NDArray[np.uint8] = np.minimum(steps, STEPS).astype(np.uint8)
    return bytes_


def ticks(scale: LaneScale) -> list[ScaleTick]:
    """Return the powers of ten within the colours, behind the word "cleared"."""
    first = math.log10(scale.lowest) + DECADES_BELOW
    powers = range(math.ceil(first), math.floor(first + SHOWN_DECADES) + 1)
    places = ((10.0**power, (power - first) / SHOWN_DECADES) for power in powers)
    numbers: list[ScaleTick] = [
        {"label": number_label(value), "place": place}
        for value, place in places
        if place > CLEARED_LABEL
    ]
    return [{"label": "cleared", "place": 0.0}, *numbers]


def number_label(value: float) -> str:
    """Return a power of ten: "0.001", "1e-6"."""
    return f"{value:g}" if value >= 1e-4 else f"{value:.0e}".replace("e-0", "e-")  # noqa: PLR2004


def path_layer(lane: BelievedLane) -> Layer:
    """Return the outline of the cells that are cleared."""
    drawn = stroke("cleared")
    sides = border_of(lane.cleared, lane.corners_m[0], lane.cell_m)
    lines = [line(side, drawn) for side in sides]
    return {**layer(), "clip": lane.corners_m, "lines": lines}


def border_of(
    cleared: NDArray[np.bool_], corner: Point, cell_m: float
) -> Iterator[tuple[Point, Point]]:
    """Yield the straight lines between cells that are cleared and those that are not."""
    padded = np.pad(cleared, 1)
    for is_vertical in (False, True):
        across = padded.T if is_vertical else padded
        for row, sides in enumerate((across[1:] != across[:-1])[:, 1:-1]):
            steps = np.flatnonzero(np.diff(np.pad(sides, 1).astype(int)))
            for start, end in zip(steps[::2], steps[1::2], strict=True):
                ends = ((start, row), (end, row))
                yield tuple(  # type: ignore[misc]  # two points
                    (
                        corner[0] + float(at[is_vertical]) * cell_m,
                        corner[1] + float(at[not is_vertical]) * cell_m,
                    )
                    for at in ends
                )


def marks_layer(lane: BelievedLane) -> Layer:
    """Return the marks: larger the more probable a mine is; believed mines are filled."""
    symbols = Symbols()
    marks = [
        symbols.marker(mark.at_m, symbol(mark.verdict or "unverified", mark.mine))
        for mark in sorted(lane.marks, key=lambda mark: mark.mine)
    ]
    return layer() | {"symbols": symbols.all, "markers": marks}


def symbol(state: str, mine: float) -> list[Glyph]:
    """Return the symbol of a mark, by the last statement and the probability of a mine."""
    shape = SHAPES[state]
    if shape in ("cross", "tick"):
        return [glyph(shape, 6.0, None, stroke("text", 1.8), has_rim=True)]
    is_mine = lane_panel.is_believed_mine(mine)
    radius_px = round(2 * (4 + 4 * math.sqrt(mine))) / 2
    inside = fill("item-missed" if is_mine else "ground")
    return [glyph(shape, radius_px, inside, stroke("text", 2.5 if is_mine else 1.8), has_rim=True)]


def keys() -> list[Key]:
    """Return the legend of marks."""
    found = {label: symbol(label, 0.0) for label in ("unverified", "rejected", "neutralised")}
    found |= {
        "believed mine": symbol("unverified", 1.0),
        "confirmed": symbol("confirmed", 1.0),
        "missed by a charge": symbol("missed", 0.2),
        "isolated": symbol("isolated", 0.2),
    }
    return [key(label, *glyphs) for label, glyphs in found.items()]


def of_layer(name: str, label: str, **rest: Any) -> LayerOffer:
    """Return a layer of lanes."""
    offer: Any = {
        "id": name,
        "label": label,
        "is_on": True,
        "heading": lane_panel.HEADING,
        "keys": [],
    }
    whole: LayerOffer = offer | rest
    return whole


SUBJECT = Subject(
    layers=(
        of_layer(RISK, "Remaining risk", place="ground"),
        of_layer(
            PATH,
            "Cleared path",
            place="below",
            keys=[key_of_area("cleared path", fill("risk-1"), stroke("cleared"))],
        ),
        of_layer(MARKS, "Marks", place="above", keys=keys()),
    ),
    panels=({"id": PANEL, "label": "Lane", "is_of_robot": False},),
    is_in=is_in,
    contents=contents,
)

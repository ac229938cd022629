"""The mined lane of a run of the metric engine, as each controller believes it to be."""

import numpy as np
from numpy.typing import NDArray

from agent_economy.runs.lane import BelievedLane, Floats, LaneMark
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.belief_view import packed
from agent_economy.server.runs.passage_view import cleared_view, passage_view, vehicle_view
from agent_economy.types.page import Lanes, LaneScale, LaneView, MarkView

DECADES_BELOW, DECADES_ABOVE = 1, 4
"""Decades of the scale below and above the value of a cell that is just cleared. 255 steps are 51 a
decade: that value is a step, so that the bytes decide exactly which cells are cleared."""

STEPS = 255


def lanes(simulation: Simulation) -> Lanes | None:
    """Return the lane as each controller believes it to be; None if there is no lane."""
    lanes = simulation.lanes
    if not lanes:
        return None
    return {
        "type": "lanes",
        "tick": simulation.tick,
        "mines_left": simulation.mines_left,
        "vehicles": [vehicle_view(vehicle) for vehicle in simulation.vehicles],
        "lanes": [lane_view(lane) for lane in lanes],
    }


def lane_view(lane: BelievedLane) -> LaneView:
    """Return what a controller believes."""
    rows, columns = lane.expected.shape
    full_m2 = lane.cell_m**2
    scale = scale_of(lane.cleared_below_per_m2 * full_m2)
    return {
        "controller": lane.controller,
        "corners": lane.corners_m,
        "cell_m": lane.cell_m,
        "columns": columns,
        "rows": rows,
        "expected": packed(quantised(lane.expected / lane.area_m2 * full_m2, scale)),
        "scale": scale,
        "marks": [mark_view(mark) for mark in lane.marks],
        "risk": {
            "unmarked": lane.risk.unmarked,
            "marked": lane.risk.marked,
            "probability": lane.risk.probability,
        },
        "declare_below": lane.declare_below,
        "statement": None
        if lane.statement is None
        else {
            "is_clear": lane.statement.is_clear,
            "risk": lane.statement.risk,
            "at_s": lane.statement.at_s,
        },
        "cleared": [cleared_view(share) for share in lane.clearance],
        "passage": None if lane.passage is None else passage_view(lane.passage),
    }


def scale_of(cleared_below: float) -> LaneScale:
    """Return the scale of bytes, for the expected mines of a full cell that is just cleared."""
    return {
        "min": cleared_below / 10**DECADES_BELOW,
        "max": cleared_below * 10**DECADES_ABOVE,
        "cleared": STEPS * DECADES_BELOW // (DECADES_BELOW + DECADES_ABOVE),
    }


def quantised(expected: Floats, scale: LaneScale) -> NDArray[np.uint8]:
    """Return expected mines as bytes of a scale, rounded up."""
    decades = np.log10(np.maximum(expected / scale["min"], 1.0))
    steps = np.ceil(decades * STEPS / (DECADES_BELOW + DECADES_ABOVE))
    bytes_: NDArray[np.uint8] = np.minimum(steps, STEPS).astype(np.uint8)
    return bytes_


def mark_view(mark: LaneMark) -> MarkView:
    """Return a place that robots have marked."""
    return {
        "number": mark.number,
        "at": mark.at_m,
        "deviation_m": mark.deviation_m,
        "mine": mark.mine,
        "verdict": mark.verdict,
        "failed_charges": mark.failed_charges,
    }

"""Compare the stated risk of vehicles that pass a lane with the share of them that are lost.

`scripts/clearance.py` calls it. The lanes are declared clear at different risks, with different
blind shares and widths of the path, and are pooled by the stated risk of the first vehicle.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from measured import table
from numpy.typing import NDArray

import agent_economy as ae

VEHICLES = 3
DESTROYS = 0.5
"""A mine destroys half of the vehicles over it: the last one is at risk, too."""

BELOW = "controllers.station.clearance.declare_below"
SENSORS = ("robots.oav.sensors.camera", "robots.ugv.sensors.detector")
WORLDS = ((0.3, 0.5, 4.0), (0.3, 0.5, 10.0), (0.15, 0.5, 10.0), (0.2, 0.5, 6.0))
"""The blind share of both sensors, the risk below which lanes are declared, and the path's width.

With these blind shares, mines are left, so that vehicles are lost. Mines are harmless for robots:
those that a robot sets off are gone, which controllers do not know.
"""

HARMLESS = "items.mine.hazard.destroy_probability"


RUNS = 600
"""Lanes of each world."""

EDGES = (0.0, 0.01, 0.02, 0.04, 0.07, 0.1, 0.2)
"""Bounds of the stated risk of the first vehicle."""

MIN_TOLERANCE, TOLERANCE, STANDARD_ERRORS = 0.005, 0.2, 3.0
"""As for the stated risk of lanes."""


@dataclass(frozen=True)
class PassageBin:
    """The vehicles of lanes with a similar stated risk: what was stated, and the share lost."""

    low: float
    high: float
    lanes: int
    first_stated: float
    first_lost: float
    last_stated: float
    last_lost: float
    clearance_stated: float
    clearance: float
    verdict: str


def passages(
    scenario: Callable[[dict[str, Any]], ae.Scenario], seed: int, scale: float
) -> Iterator[PassageBin]:
    """Yield the bins, the one with the lowest risk first; one of all lanes is the last."""
    runs = []
    for blind, below, width_m in WORLDS:
        passage = {
            "width_m": width_m,
            "vehicles": VEHICLES,
            "speed_m_s": 10.0,
            "destroy_probability": DESTROYS,
        }
        shares = {f"{name}.blind_share": {"mine": blind, "clutter": blind} for name in SENSORS}
        case = scenario(
            {
                BELOW: below,
                "passage": passage,
                "require.probability": 0.5,
                HARMLESS: 0.0,
                **shares,
            }
        )
        runs.append(ae.replicate(case, round(scale * RUNS), seed))
    driven = pa.concat_tables(runs)
    ended = np.array(driven["vehicles_passed"]) + np.array(driven["vehicles_lost"])
    driven = driven.filter(pa.array(ended == VEHICLES))
    first = np.array(driven["stated_first_risk"])
    for low, high in pairwise(EDGES):
        yield pooled(driven, (first >= low) & (first < high), (low, high))
    yield pooled(driven, np.ones(len(first), bool), (0.0, 1.0))


def pooled(driven: pa.Table, chosen: NDArray[np.bool_], bounds: tuple[float, float]) -> PassageBin:
    """Return what was stated and what was true of the chosen lanes."""

    def mean(name: str) -> float:
        return float(np.mean(np.array(driven[name], float)[chosen])) if chosen.any() else 0.0

    lanes = int(chosen.sum())
    one = PassageBin(
        *bounds,
        lanes=lanes,
        first_stated=mean("stated_first_risk"),
        first_lost=mean("first_lost"),
        last_stated=mean("stated_last_risk"),
        last_lost=mean("last_lost"),
        clearance_stated=mean("stated_clearance_mine"),
        clearance=mean("true_clearance_mine"),
        verdict="",
    )
    offs = (
        off(one.first_stated, one.first_lost, lanes),
        off(one.last_stated, one.last_lost, lanes),
    )
    if max(offs) > 0:
        return replace(one, verdict="fails: the stated risk is too low")
    return replace(one, verdict="careful" if min(offs) < 0 else "passes")


def off(stated: float, lost: float, lanes: int) -> float:
    """Return by how much a share is beyond the tolerance of the stated one and its error."""
    tolerance = max(MIN_TOLERANCE, TOLERANCE * stated, STANDARD_ERRORS * error(stated, lanes))
    return max(lost - stated - tolerance, 0.0) + min(lost - stated + tolerance, 0.0)


def error(share: float, lanes: int) -> float:
    """Return the standard error of a share."""
    return math.sqrt(share * (1 - share) / max(lanes, 1))


def of_passages(bins: list[PassageBin]) -> str:
    """Return the table of the passages."""
    header = ["risk of the first", "lanes", "stated", "lost", "last: stated", "lost", "verdict"]
    lines = [
        [
            "all" if each.high == 1 else f"{each.low:g} to {each.high:g}",
            f"{each.lanes:,}",
            f"{each.first_stated:.4f}",
            f"{each.first_lost:.4f} ± {2 * error(each.first_stated, each.lanes):.4f}",
            f"{each.last_stated:.4f}",
            f"{each.last_lost:.4f} ± {2 * error(each.last_stated, each.lanes):.4f}",
            each.verdict,
        ]
        for each in bins
        if each.lanes
    ]
    return table(header, lines)

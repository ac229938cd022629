"""Compare the stated risk of vehicles that pass a lane with the share of them that are lost.

`scripts/clearance.py` calls it. The lanes are declared clear at different risks, with different
widths of the path, and are pooled by the stated risk of the first vehicle.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
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
WORLDS = ((0.5, 4.0), (0.9, 4.0), (0.5, 10.0), (0.9, 10.0))
"""The risk below which lanes are declared, and the width of the path."""

RUNS = 1_000
"""Lanes of each world."""

EDGES = (0.0, 0.01, 0.02, 0.05, 0.1, 0.2)
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
    for below, width_m in WORLDS:
        passage = {
            "width_m": width_m,
            "vehicles": VEHICLES,
            "speed_m_s": 10.0,
            "destroy_probability": DESTROYS,
        }
        case = scenario({BELOW: below, "passage": passage})
        runs.append(ae.replicate(case, round(scale * RUNS), seed))
    driven = pa.concat_tables(runs)
    ended = np.array(driven["vehicles_passed"]) + np.array(driven["vehicles_lost"])
    driven = driven.filter(pa.array(ended == VEHICLES))
    first = np.array(driven["stated_first_risk"])
    for low, high in zip(EDGES, EDGES[1:], strict=False):
        yield pooled(driven, (first >= low) & (first < high), (low, high))
    yield pooled(driven, np.ones(len(first), bool), (0.0, 1.0))


def pooled(driven: pa.Table, chosen: NDArray[np.bool_], bounds: tuple[float, float]) -> PassageBin:
    """Return what was stated and what was true of the chosen lanes."""
    if not chosen.any():
        return PassageBin(*bounds, 0, 0, 0, 0, 0, 0, 0, "no lanes")
    names = (
        "stated_first_risk",
        "first_lost",
        "stated_last_risk",
        "last_lost",
        "stated_clearance_mine",
        "true_clearance_mine",
    )
    means = [float(np.mean(np.array(driven[name], float)[chosen])) for name in names]
    lanes = int(chosen.sum())
    pairs = ((means[0], means[1]), (means[2], means[3]))
    passes = all(is_right(stated, lost, lanes) for stated, lost in pairs)
    return PassageBin(*bounds, lanes, *means, "passes" if passes else "fails")


def is_right(stated: float, lost: float, lanes: int) -> bool:
    """Return whether a share is the stated one, within the tolerance and its standard error."""
    tolerance = max(MIN_TOLERANCE, TOLERANCE * stated)
    return abs(lost - stated) <= max(tolerance, STANDARD_ERRORS * error(stated, lanes))


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

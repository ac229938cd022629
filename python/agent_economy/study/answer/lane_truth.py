"""What was stated of declared lanes beside the risk, and the truth: mines cleared, and vehicles."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.answer import estimate
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.arguments import Floats

TRUTH, STATED = "true_clearance_", "stated_clearance_"
"""Columns of the share of the mines of a kind that are cleared begin so."""

PASSAGE_COLUMNS = (
    "stated_first_risk",
    "stated_last_risk",
    "first_lost",
    "last_lost",
    "vehicles_passed",
    "vehicles_lost",
)
"""Columns that describe the vehicles that pass a lane, of those that the simulator has."""


TOLERANCE = 1e-9
"""The ends of stated intervals are found by halving."""


@dataclass(frozen=True)
class ClearedKind:
    """The share of the mines of a kind that are cleared, in the mean over declared lanes.

    A lane without a mine of the kind is cleared of it.

    Attributes:
        kind: The kind of items.
        share: The true share.
        stated: The stated share.
        low: The lower end of the stated interval, which contains the share with at least 95%.
        high: Its upper end.
        inside: The share of the lanes whose true share is in the stated interval.
    """

    kind: str
    share: float
    stated: float
    low: float
    high: float
    inside: float


@dataclass(frozen=True)
class VehicleRisk:
    """How often vehicles that passed declared lanes were lost, and what was stated.

    Attributes:
        lanes: Number of lanes through which all vehicles had passed or were lost.
        first_lost: The share in which the first vehicle was lost, with its exact interval.
        first_stated: The risk of the first vehicle that was stated, in the mean.
        last_lost: The same share of the last vehicle.
        last_stated: The same risk of the last vehicle.
    """

    lanes: int
    first_lost: Interval
    first_stated: float
    last_lost: Interval
    last_stated: float


def is_lane_truth(name: str) -> bool:
    """Return whether a column is one of those that are read here."""
    return name.startswith((TRUTH, STATED)) or name in PASSAGE_COLUMNS


def cleared_kinds(
    columns: Mapping[str, Floats], is_declared: NDArray[np.bool_]
) -> tuple[ClearedKind, ...]:
    """Return the cleared share of each kind in the declared lanes; none if none was declared."""
    if not is_declared.any():
        return ()
    names = [name.removeprefix(TRUTH) for name in columns if name.startswith(TRUTH)]
    return tuple(cleared_kind(columns, name, is_declared) for name in names)


def cleared_kind(
    columns: Mapping[str, Floats], kind: str, is_declared: NDArray[np.bool_]
) -> ClearedKind:
    """Return the cleared share of one kind."""
    true = columns[f"{TRUTH}{kind}"][is_declared]
    stated, low, high = (
        columns[f"{STATED}{kind}{end}"][is_declared] for end in ("", "_low", "_high")
    )
    is_inside = (low - TOLERANCE <= true) & (true <= high + TOLERANCE)
    means = (float(each.mean()) for each in (true, stated, low, high, is_inside))
    return ClearedKind(kind, *means)


def vehicle_risk(
    columns: Mapping[str, Floats], is_declared: NDArray[np.bool_], confidence: float
) -> VehicleRisk | None:
    """Return how often vehicles were lost; None without vehicles that have finished."""
    if not set(PASSAGE_COLUMNS) <= columns.keys():
        return None
    ended = columns["vehicles_passed"] + columns["vehicles_lost"]
    is_driven = is_declared & (ended > 0) & (ended == ended.max(initial=0))
    lanes = int(is_driven.sum())
    if lanes == 0:
        return None
    lost = [int(columns[f"{which}_lost"][is_driven].sum()) for which in ("first", "last")]
    stated = [
        float(columns[f"stated_{which}_risk"][is_driven].mean()) for which in ("first", "last")
    ]
    first, last = (estimate.share(number, lanes, confidence) for number in lost)
    return VehicleRisk(lanes, first, stated[0], last, stated[1])

"""How often a team declares a lane clear, and how often that is wrong."""

from dataclasses import dataclass

import numpy as np

from agent_economy.study.answer import estimate
from agent_economy.study.answer.evidence import Interval, Sample
from agent_economy.study.answer.lane_truth import (
    ClearedKind,
    VehicleRisk,
    cleared_kinds,
    vehicle_risk,
)
from agent_economy.study.arguments import Floats

CLEARANCE_COLUMNS = ("declared", "declared_not_clear", "stated_risk", "declared_s")
"""Columns that describe a lane, of those that the simulator has: NaN in a quarantined run."""

MIN_SHARE = 1e-9
"""Shares below this are written as 0."""


@dataclass(frozen=True)
class Clearance:
    """The lanes that a configuration declared clear, and those of them that were not.

    Each interval is exact (Clopper and Pearson) for its own configuration and a fixed number of
    runs, with the confidence of the answer. They do not hold simultaneously, and decide nothing.

    Attributes:
        lanes: Number of runs; each has a lane.
        declared: Number of lanes that were declared clear. A quarantined run declares none.
        not_clear: Number of these in which a mine was left.
        declared_share: `declared` / `lanes`.
        risk: `not_clear` / `declared`; None, which is not known, if none was declared.
        stated_risk: Mean risk that was stated of the declared lanes; None if none was declared.
        declared_s: Mean time until the declaration of the declared lanes; None if none was.
        cleared_s: Mean time until the declaration of all lanes; those that were not declared count
            with the time limit. None if all runs are quarantined.
        cleared: The share of the mines of each kind that are cleared, in the declared lanes.
        vehicles: How often vehicles that passed declared lanes were lost; None without any.
    """

    lanes: int
    declared: int
    not_clear: int
    declared_share: Interval
    risk: Interval | None
    stated_risk: float | None
    declared_s: float | None
    cleared_s: float | None
    cleared: tuple[ClearedKind, ...] = ()
    vehicles: VehicleRisk | None = None


def clearance(sample: Sample, confidence: float) -> Clearance | None:
    """Return the declarations of a configuration; None without runs, or without a lane."""
    columns = sample.columns
    if not sample.runs or not set(CLEARANCE_COLUMNS) <= columns.keys():
        return None
    is_outcome = np.isfinite([columns[name] for name in CLEARANCE_COLUMNS]).all(axis=0)
    is_outcome &= columns.get("quarantined", np.zeros(sample.runs)) == 0
    is_declared = is_outcome & (columns["declared"] == 1)
    declared = int(is_declared.sum())
    not_clear = int(columns["declared_not_clear"][is_declared].sum())
    return Clearance(
        lanes=sample.runs,
        declared=declared,
        not_clear=not_clear,
        declared_share=estimate.share(declared, sample.runs, confidence),
        risk=estimate.share(not_clear, declared, confidence) if declared else None,
        stated_risk=mean(columns["stated_risk"][is_declared]),
        declared_s=mean(columns["declared_s"][is_declared]),
        cleared_s=mean(columns["declared_s"][is_outcome]),
        cleared=cleared_kinds(columns, is_declared),
        vehicles=vehicle_risk(columns, is_declared, confidence),
    )


def mean(values: Floats) -> float | None:
    """Return the mean; None of no values."""
    return float(values.mean()) if len(values) else None


def in_words(of: Clearance) -> str:
    """Return the share declared and the risk: "declared 95% of lanes; of these, 4.7% ...".

    The share declared is always beside the risk: a team that declares nothing is not safe.
    """
    if of.risk is None or of.stated_risk is None:
        return f"declared none of {of.lanes:,} lanes clear, so that the risk is not known"
    cleared = "".join(f"; {cleared_in_words(each)}" for each in of.cleared)
    vehicles = f"; {vehicles_in_words(of.vehicles)}" if of.vehicles else ""
    return (
        f"declared {percent(of.declared_share.value)} of lanes clear; of these, "
        f"{percent(of.risk.value)} ({percent(of.risk.low)[:-1]} to {percent(of.risk.high)}) were "
        f"not clear; stated {percent(of.stated_risk)}{cleared}{vehicles}"
    )


def cleared_in_words(of: ClearedKind) -> str:
    """Return the share of a kind that is cleared: "clearance of mine 98.8%, stated 98.9%"."""
    return f"clearance of {of.kind} {percent(of.share)}, stated {percent(of.stated)}"


def vehicles_in_words(of: VehicleRisk) -> str:
    """Return how often the first vehicle was lost: "first vehicle lost in 1.2% ..., stated 1%"."""
    lost = of.first_lost
    bounds = f"{percent(lost.low)[:-1]} to {percent(lost.high)}"
    return (
        f"first vehicle lost in {percent(lost.value)} ({bounds}), stated {percent(of.first_stated)}"
    )


def percent(share: float) -> str:
    """Return a share with two figures of what is rarer, its case or the opposite: 4.7%, 99.93%."""
    rarer = 100 * min(share, 1 - share)
    decimals = max(1, 1 - int(np.floor(np.log10(rarer)))) if rarer > MIN_SHARE else 1
    return f"{round(100 * share, decimals):.10g}%"

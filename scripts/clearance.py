"""Compare what controllers state of a mined lane with the truth, and check directions of change.

Calibration: of the lanes that are declared clear with a stated risk r, the share r is not clear.
Directions: changes of the team, the sensors and the radio move results the right way.
Passages: of vehicles with a stated risk r, the share r is lost (scripts/passage.py).
Random lanes: both parts of the stated risk, over lanes of all sizes (scripts/random_lanes.py). The
measurements are docs/mines/calibration.csv, directions.csv, passage.csv and lanes.csv; the tables
of docs/mines.md are between `<!-- calibration -->`, `<!-- directions -->`, `<!-- passage -->` or
`<!-- lanes -->` and `<!-- end -->`. Examples:

    python scripts/clearance.py               run everything (an hour on two cores)
    python scripts/clearance.py --scale 0.2   fewer runs: most cells are undecided
    python scripts/clearance.py --draw        only the chart and the page, from the CSV files
    python scripts/clearance.py --passages    only the passages, the chart and the page
    python scripts/clearance.py --lanes       only the random lanes (20 minutes)

The status is 1 if a cell or a direction fails.
"""

import argparse
import math
import sys
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pyarrow as pa
from measured import ROOT, Page, table
from passage import PassageBin, of_passages, passages
from plots import Row, Spec, page_of, panel, path, points
from random_lanes import LaneBin, of_lanes, random_lanes
from scipy import stats

import agent_economy as ae
from agent_economy.scenario import Override

PAGE = Page("mines")

SEED = 2
RISKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.9)
"""The risks below which lanes are declared.

The stated risk is lower, as it falls in steps: below 0.9, lanes are declared with about 0.4.
"""

MIN_TOLERANCE, TOLERANCE = 0.005, 0.2
"""The share may differ from the stated risk by the larger of a number and a part of the risk."""

STANDARD_ERRORS = 3.0
"""The tolerance is at least this many standard errors: a true statement fails in 0.3% of cells."""

BLOCK_RUNS, MAX_RUNS, REPORTED_RUNS = 500, 12_000, 2_000
"""Lanes are added in blocks, until the tolerance is that many standard errors, up to a maximum.

The maximum is lower for cells of which nothing is claimed.
"""

DIRECTION_RUNS, TEAM_RUNS = 300, 100
SIGMAS = 2.0
"""Without an effect, a paired difference has this many standard errors in 2.3% of the cases."""

CLEAR_SHARE, SLOW_M_S = 0.85, 1.5
"""The cheapest team declares the bundled lane clear, rightly, in this share of the runs or more.

Its air vehicles are slow: then more of them save a second search on the ground.
"""

LANE = [[8, 4], [68, 24]]
UNIFORM = {"kind": "uniform", "within_m": LANE}
COUNTS = {"mine": 3, "clutter": 4}
PARTICIPANTS = ("robots.oav", "robots.ugv", "controllers.station")
CLEARANCE = "controllers.station.clearance"
BELOW = f"{CLEARANCE}.declare_below"
EXPECTED = f"{CLEARANCE}.expected_count"
BLIND = ("robots.oav.sensors.camera.blind_share", "robots.ugv.sensors.detector.blind_share")
SENSORS = tuple(key.removesuffix(".blind_share") for key in BLIND)
DETECTION = "robots.ugv.sensors.detector.detection_probability"
BELIEFS = ("robots.oav.brain.beliefs.prior_count", "robots.ugv.brain.beliefs.prior_count")

Changes = dict[str, Any]


def of_kinds(keys: Iterable[str], value: float) -> Changes:
    """Return a change of a number for mines and clutter at each key."""
    return {key: {"mine": value, "clutter": value} for key in keys}


def lossy(probability: float) -> Changes:
    """Return a loss of messages on every radio."""
    return {f"{each}.radio.loss_probability": probability for each in PARTICIPANTS}


SMALL: Changes = {
    "world.size_m": [76, 28],
    "clock.time_limit_s": 900,
    "items.mine.count": COUNTS["mine"],
    "items.clutter.count": COUNTS["clutter"],
    "items.mine.placement": UNIFORM,
    "items.clutter.placement": UNIFORM,
    f"{CLEARANCE}.lane_m": LANE,
    "controllers.station.count": 1,
    "robots.oav.count": 1,
    "robots.ugv.count": 3,
    **dict.fromkeys(BELIEFS, COUNTS),
    **of_kinds(BLIND, 0.03),
    **lossy(0),
}
"""A lane of 60 m x 20 m with the sensors of the bundled scenario, and a floor of 0.3%."""


@dataclass(frozen=True)
class Series:
    """What differs from the small lane, at which risks, and whether it must be calibrated."""

    name: str
    changes: Changes
    is_claim: bool = True
    risks: tuple[float, ...] = RISKS


WRONG = (0.05, 0.2)
"""The risks of controllers that expect a wrong number of mines."""

SERIES = (
    Series("no loss", {}),
    Series("30% of messages lost", lossy(0.3)),
    Series("half of the mines expected", {EXPECTED: {"mine": 1.5}}, is_claim=False, risks=WRONG),
    Series("twice the mines expected", {EXPECTED: {"mine": 6}}, is_claim=False, risks=WRONG),
)


@dataclass(frozen=True)
class Cell:
    """What was stated of the lanes that were declared clear, and the share that was not clear."""

    series: str
    declare_below: float
    runs: int
    declared: int
    stated: float
    not_clear: float
    standard_error: float
    verdict: str


@dataclass(frozen=True)
class Direction:
    """A change, and the mean of a column before and after it."""

    claim: str
    column: str
    runs: int
    before: float
    after: float
    sigmas: float
    verdict: str


def main() -> None:
    """Measure and draw, or only draw."""
    parser = argparse.ArgumentParser(description="Check statements about mined lanes.")
    parser.add_argument("--scale", type=float, default=1.0, help="factor of the numbers of runs")
    parser.add_argument("--draw", action="store_true", help="only the chart and the page")
    parser.add_argument("--passages", action="store_true", help="run only the passages")
    parser.add_argument("--lanes", action="store_true", help="run only the random lanes")
    options = parser.parse_args()
    if not options.draw:
        chosen = {"passages": options.passages, "lanes": options.lanes}
        measure(options.scale, {name for name, is_chosen in chosen.items() if is_chosen})
    cells, moved = PAGE.read("calibration", Cell), PAGE.read("directions", Direction)
    driven, pooled = PAGE.read("passage", PassageBin), PAGE.read("lanes", LaneBin)
    tables = {
        "calibration": of_cells(cells),
        "directions": of_directions(moved),
        "passage": of_passages(driven),
        "lanes": of_lanes(pooled),
    }
    PAGE.draw(lambda name: tables[name], {"calibration": chart(cells)})
    failed = [f"{each.series}, {each.declare_below:g}" for each in cells if is_failed(each)]
    failed += [each.claim for each in moved if is_failed(each)]
    failed += [f"passages, {each.low:g}" for each in driven if is_failed(each)]
    failed += [f"{each.density} lanes, {each.low:g}" for each in pooled if is_failed(each)]
    sys.exit(f"failed: {'; '.join(failed)}" if failed else 0)


def is_failed(each: Cell | Direction | PassageBin | LaneBin) -> bool:
    """Return whether a cell, a direction or a bin fails."""
    return each.verdict.startswith("fails")


# Measured.


def measure(scale: float, only: set[str]) -> None:
    """Run everything, or only some parts, and write the measurements as they come."""
    if not only or "passages" in only:
        PAGE.write("passage", PassageBin, passages(scenario, SEED, scale))
    if not only or "lanes" in only:
        bundled = partial(scenario, lane={})
        PAGE.write("lanes", LaneBin, random_lanes(bundled, SEED, scale))
    if only:
        return
    cells = (cell(series, risk, scale) for series in SERIES for risk in series.risks)
    PAGE.write("calibration", Cell, cells)
    PAGE.write("directions", Direction, directions(scale))


def scenario(changes: Changes, lane: Changes = SMALL) -> ae.Scenario:
    """Return the bundled scenario with the small lane, or another, and other changes."""
    bundled = ae.Scenario.load(ROOT / "scenarios" / "mines.toml")
    every = (lane | changes).items()
    return bundled.changed(tuple(Override.at(path, value, "change") for path, value in every))


def cell(series: Series, risk: float, scale: float) -> Cell:
    """Return what was stated and what was true, at one risk below which lanes are declared."""
    case = scenario({BELOW: risk} | series.changes)
    blocks = []
    runs = MAX_RUNS if series.is_claim else REPORTED_RUNS
    for block in range(runs // BLOCK_RUNS):
        blocks.append(ae.replicate(case, BLOCK_RUNS, SEED + block))
        one = counted(series, risk, pa.concat_tables(blocks))
        if one.declared == 0 or one.runs >= scale * needed(one):
            break
    return replace(one, verdict=verdict(one) if series.is_claim else "reported")


def counted(series: Series, risk: float, runs: Any) -> Cell:
    """Return what was stated and what was true in some runs."""
    declared = runs.filter(runs["declared"])
    if len(declared) == 0:
        return Cell(series.name, risk, len(runs), 0, 1.0, 0.0, 1.0, "undecided")
    stated, not_clear = np.mean(declared["stated_risk"]), np.mean(declared["declared_not_clear"])
    error = math.sqrt(stated * (1 - stated) / len(declared))
    return Cell(series.name, risk, len(runs), len(declared), stated, not_clear, error, "")


def needed(one: Cell) -> float:
    """Return the runs with which the tolerance has enough standard errors, by what was stated."""
    return one.runs * (STANDARD_ERRORS * one.standard_error / tolerance(one.stated)) ** 2


def tolerance(risk: float) -> float:
    """Return by how much the share may differ from a risk."""
    return max(MIN_TOLERANCE, TOLERANCE * risk)


def verdict(one: Cell) -> str:
    """Return whether the share is within the tolerance, if there are enough runs to decide it."""
    off = one.not_clear - one.stated
    if abs(off) > max(tolerance(one.stated), STANDARD_ERRORS * one.standard_error):
        return "fails: the stated risk is too low" if off > 0 else "careful"
    return "passes" if one.runs >= needed(one) else "undecided"


def directions(scale: float) -> Iterable[Direction]:
    """Yield the results of each change, all in the same worlds."""
    number = max(30, round(scale * DIRECTION_RUNS))
    clutter = {"mine": 3, "clutter": 40}
    more: Changes = {"items.clutter.count": 40, **dict.fromkeys(BELIEFS, clutter)}
    worse = of_kinds([DETECTION], 0.05)
    stated = of_kinds(BLIND, 0.1)
    blind = of_kinds(BLIND, 0.2) | {
        f"{each}.believed.blind_share": {"mine": 0.1} for each in SENSORS
    }
    time_s, not_clear = "declared_s", "declared_not_clear"
    changes: list[tuple[str, Changes, Changes, str, int]] = [
        ("a worse sensor of ground vehicles", {}, worse, time_s, 1),
        ("a lower blind share", of_kinds(BLIND, 0.1), {}, time_s, -1),
        ("more clutter", {}, more, time_s, 1),
        ("60% of messages lost", {}, lossy(0.6), time_s, 1),
        ("one more ground vehicle", {}, {"robots.ugv.count": 4}, time_s, -1),
        ("sensors blind to twice as many mines as believed", stated, blind, not_clear, 1),
        ("declarations at a higher risk", {BELOW: 0.02}, {BELOW: 0.5}, not_clear, 1),
    ]
    for claim, before, after, name, sign in changes:
        yield direction(claim, (before, after), (name, sign), number)
    yield dearer(max(20, round(scale * TEAM_RUNS)))


def direction(
    claim: str, sides: tuple[Changes, Changes], expected: tuple[str, int], number: int
) -> Direction:
    """Return how a change moves a column: by two standard errors in the expected direction."""
    name, sign = expected
    before, after = (
        np.array(ae.replicate(scenario(side), number, SEED)[name], float) for side in sides
    )
    error = stats.sem(after - before)
    sigmas = sign * np.mean(after - before) / error if error > 0 else 0.0
    verdict = "passes" if sigmas > SIGMAS else "fails"
    return Direction(claim, name, number, np.mean(before), np.mean(after), sigmas, verdict)


def dearer(number: int) -> Direction:
    """Return the ground vehicles of the cheapest team, by their price, with the same runs."""
    teams = [(oavs, ugvs) for oavs in range(1, 3) for ugvs in range(3, 8)]
    slow: Changes = {"robots.oav.drive.max_speed_m_s": SLOW_M_S}
    enough = []
    for oavs, ugvs in teams:
        team = slow | {"robots.oav.count": oavs, "robots.ugv.count": ugvs}
        runs = ae.replicate(scenario(team, lane={}), number, SEED)
        if np.mean(runs["declared_clear"]) >= CLEAR_SHARE:
            enough.append((oavs, ugvs))

    def cheapest(price: float) -> int:
        costs = [(15_000 * oavs + price * ugvs, oavs, ugvs) for oavs, ugvs in enough]
        return min(costs, default=(0.0, 0, 0))[-1]

    before, after = cheapest(1_000), cheapest(300_000)
    passes = "passes" if after < before else "fails"
    return Direction("a dearer ground vehicle", "robots.ugv", number, before, after, 0, passes)


# Drawn.


def of_cells(cells: list[Cell]) -> str:
    """Return the table of the calibration."""
    header = ["", "declared below", "runs", "declared", "stated risk", "not clear", "verdict"]
    lines = [
        [
            each.series,
            f"{each.declare_below:g}",
            f"{each.runs:,}",
            f"{each.declared:,}",
            f"{each.stated:.4f}",
            f"{each.not_clear:.4f} ± {2 * each.standard_error:.4f}",
            each.verdict,
        ]
        for each in cells
    ]
    return table(header, lines)


def of_directions(moved: list[Direction]) -> str:
    """Return the table of the directions."""
    lines = [
        [
            each.claim,
            f"`{each.column}`",
            f"{each.runs}",
            f"{each.before:.4g}",
            f"{each.after:.4g}",
            f"{each.sigmas:.1f}" if each.sigmas else "",
            each.verdict,
        ]
        for each in moved
    ]
    return table(["change", "", "runs", "before", "after", "standard errors", "verdict"], lines)


def chart(cells: list[Cell]) -> Spec:
    """Return the share that is not clear by the stated risk, with intervals of 95%."""
    rows = [
        Row(each.series, each.stated, each.not_clear, each.standard_error, each.stated)
        for each in cells
    ]
    ends = [{"x": risk, "y": risk} for risk in (0.0, max(row.x for row in rows))]
    layers = [path(ends, strokeWidth=1), *points(rows)]
    return page_of(panel(layers, "stated risk", "share of declared lanes not clear"))


if __name__ == "__main__":
    main()

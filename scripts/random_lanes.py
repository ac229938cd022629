"""Compare both parts of the stated risk with the truth over random lanes, sparse and dense.

`scripts/clearance.py` calls it. Lanes that are declared clear are pooled by their stated risk, and
by the density of their items.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, pairwise
from random import Random
from typing import Any

import numpy as np
from measured import table
from numpy.typing import NDArray
from scipy import stats

import agent_economy as ae

LENGTHS_M, WIDTHS_M = (20.0, 60.0), (6.0, 24.0)
MINES, CLUTTER = ((1, 6), (2, 12)), (1, 15)
OAVS, UGVS, CONTROLLERS = (0, 4), (1, 6), (1, 3)
MAX_LOSS, MAX_BLIND, POSITION_ERRORS_M = 0.5, 0.25, (0.05, 0.5)
"""Bounds of what is drawn for each lane, evenly; first one of the two ranges of expected mines."""

BORDER_SHARE, BORDER_M = 0.25, 0.3
"""In this share of the lanes, all mines are this close to one of the two long sides."""

MAX_FLOOR = 0.5
"""Lanes whose floor of the risk is higher are drawn again."""

FACTORS, THRESHOLDS = (1.2, 8.0), (0.01, 0.9)
"""The risk below which a lane is declared: its floor times a factor, between two bounds."""

TIME_LIMIT_S = 1500.0
MARGIN_M = (8.0, 4.0)
"""The ground around a lane, in which robots start and turn."""

RUNS = 10
"""Runs per random lane."""

MAX_LANES = 6_000
"""Runs of all lanes together: twenty minutes on two cores."""

EDGES = (0.0, 0.05, 0.2, 1.0)
"""Bounds of the stated risk."""

DENSE = 2.0
"""Expected items per 100 m2 from which a lane is dense."""

MIN_TOLERANCE, TOLERANCE = 0.005, 0.2
"""As for the stated risk of lanes; the stated risk may differ by it from the interval."""

CONFIDENCE = 0.99

CLEARANCE = "controllers.station.clearance"
OAV, UGV, STATION = "robots.oav", "robots.ugv", "controllers.station"
CAMERA, DETECTOR = f"{OAV}.sensors.camera", f"{UGV}.sensors.detector"

COLUMNS = (
    "stated_risk",
    "declared_not_clear",
    "stated_unmarked",
    "left_unmarked",
    "stated_marked",
    "left_marked",
)

Area = list[list[float]]
Outcomes = NDArray[np.float64]
"""The columns of lanes that were declared clear, one lane per row."""


@dataclass(frozen=True)
class Lane:
    """A random lane, its team and the risk below which it is declared."""

    number: int
    length_m: float
    width_m: float
    mines: int
    clutter: int
    oavs: int
    ugvs: int
    controllers: int
    loss: float
    blind_air: float
    blind_ground: float
    position_error_m: float
    is_at_border: bool
    factor: float

    @property
    def density(self) -> str:
        """Return whether the lane is sparse or dense."""
        items = 100 * (self.mines + self.clutter) / (self.length_m * self.width_m)
        return "dense" if items >= DENSE else "sparse"

    @property
    def floor(self) -> float:
        """Return the probability of a mine to which all sensors that are sent are blind."""
        blind = self.blind_ground * (self.blind_air if self.oavs else 1)
        return 1 - math.exp(-self.mines * blind)

    @property
    def threshold(self) -> float:
        """Return the risk below which the lane is declared clear."""
        low, high = THRESHOLDS
        return min(max(self.factor * self.floor, low), high)

    @property
    def area_m(self) -> Area:
        """Return the corners of the lane."""
        x_m, y_m = MARGIN_M
        return [[x_m, y_m], [x_m + self.length_m, y_m + self.width_m]]

    @property
    def mines_m(self) -> Area:
        """Return the corners of the ground with mines: the lane, or a strip at a long side."""
        [left, low], [right, high] = self.area_m
        if not self.is_at_border:
            return self.area_m
        is_far = self.number % 2 == 1
        if self.length_m >= self.width_m:
            low, high = (high - BORDER_M, high) if is_far else (low, low + BORDER_M)
        else:
            left, right = (right - BORDER_M, right) if is_far else (left, left + BORDER_M)
        return [[left, low], [right, high]]

    def changes(self) -> dict[str, Any]:
        """Return the changes of the bundled scenario."""
        return self.of_world() | self.of_team() | self.of_beliefs()

    def of_world(self) -> dict[str, Any]:
        """Return the changes of the lane and its items."""
        x_m, y_m = MARGIN_M
        return {
            "world.size_m": [self.length_m + 2 * x_m, self.width_m + 2 * y_m],
            "clock.time_limit_s": TIME_LIMIT_S,
            "items.mine.count": self.mines,
            "items.mine.placement": {"kind": "uniform", "within_m": self.mines_m},
            "items.clutter.count": self.clutter,
            "items.clutter.placement": {"kind": "uniform", "within_m": self.area_m},
            f"{CLEARANCE}.lane_m": self.area_m,
            f"{CLEARANCE}.declare_below": self.threshold,
            "require.probability": 1 - MAX_FLOOR,
        }

    def of_team(self) -> dict[str, Any]:
        """Return the changes of the robots, the controllers and their radios."""
        _, y_m = MARGIN_M
        start = {"kind": "uniform", "within_m": [[1.0, y_m], [5.0, y_m + self.width_m]]}
        participants = {OAV: self.oavs, UGV: self.ugvs, STATION: self.controllers}
        changes: dict[str, Any] = {}
        for name, number in participants.items():
            changes[f"{name}.count"] = number
            changes[f"{name}.start"] = start
            changes[f"{name}.radio.loss_probability"] = self.loss
        return changes

    def of_beliefs(self) -> dict[str, Any]:
        """Return the changes of the sensors, and of the numbers of items that are expected."""
        expected = {"mine": self.mines, "clutter": self.clutter}
        changes: dict[str, Any] = {
            f"{sensor}.blind_share": {"mine": blind, "clutter": blind}
            for sensor, blind in ((CAMERA, self.blind_air), (DETECTOR, self.blind_ground))
        }
        for robot in (OAV, UGV):
            changes[f"{robot}.sensors.gps.noise_m"] = self.position_error_m
            changes[f"{robot}.brain.beliefs.prior_count"] = expected
        return changes


@dataclass(frozen=True)
class LaneBin:
    """Declared lanes with a similar density and stated risk: what was stated, and what was true.

    The share that was not clear has an interval; the numbers of mines are sums over the lanes.
    """

    density: str
    low: float
    high: float
    lanes: int
    needed: int
    stated: float
    not_clear: float
    not_clear_low: float
    not_clear_high: float
    stated_unmarked: float
    left_unmarked: float
    stated_marked: float
    left_marked: float
    verdict: str


def random_lanes(
    scenario: Callable[[dict[str, Any]], ae.Scenario], seed: int, scale: float
) -> Iterator[LaneBin]:
    """Run lanes until each bin has as many as it needs, or a maximum, and yield the bins.

    What is still run depends on what has been stated only, not on what was true.
    """
    declared = {density: np.empty((0, len(COLUMNS))) for density in ("sparse", "dense")}
    lanes = (drawn(number, seed) for number in count())
    for _ in range(round(scale * MAX_LANES / RUNS)):
        missing = [one for one in bins(declared) if one.lanes < scale * one.needed]
        if not missing:
            break
        lane = next(lane for lane in lanes if any(may_be_in(lane, one) for one in missing))
        runs = ae.replicate(scenario(lane.changes()), RUNS, seed + lane.number)
        found = outcomes(runs.filter(runs["declared"]))
        declared[lane.density] = np.concatenate([declared[lane.density], found])
    yield from bins(declared)


def drawn(number: int, seed: int) -> Lane:
    """Return the random lane with a number."""
    random = Random(f"lane {number} of {seed}")  # noqa: S311
    while True:
        lane = Lane(
            number,
            length_m=random.uniform(*LENGTHS_M),
            width_m=random.uniform(*WIDTHS_M),
            mines=random.randint(*random.choice(MINES)),
            clutter=random.randint(*CLUTTER),
            oavs=random.randint(*OAVS),
            ugvs=random.randint(*UGVS),
            controllers=random.randint(*CONTROLLERS),
            loss=random.uniform(0, MAX_LOSS),
            blind_air=random.uniform(0, MAX_BLIND),
            blind_ground=random.uniform(0, MAX_BLIND),
            position_error_m=random.uniform(*POSITION_ERRORS_M),
            is_at_border=random.random() < BORDER_SHARE,
            factor=math.exp(random.uniform(*map(math.log, FACTORS))),
        )
        if lane.floor <= MAX_FLOOR:
            return lane


def may_be_in(lane: Lane, one: LaneBin) -> bool:
    """Return whether the stated risk, between a lane's floor and threshold, may be in a bin."""
    return lane.density == one.density and lane.floor < one.high and lane.threshold > one.low


def outcomes(declared: Any) -> Outcomes:
    """Return the columns of a table of lanes that were declared clear."""
    return np.column_stack([np.array(declared[name], float) for name in COLUMNS])


def bins(declared: dict[str, Outcomes]) -> Iterator[LaneBin]:
    """Yield the bins, sparse lanes and low risks first."""
    for density, found in declared.items():
        for low, high in pairwise(EDGES):
            risk = found[:, 0]
            yield pooled(density, (low, high), found[(risk >= low) & (risk < high)])


def pooled(density: str, bounds: tuple[float, float], found: Outcomes) -> LaneBin:
    """Return what was stated and what was true of the lanes of a bin."""
    lanes = len(found)
    sums = dict(zip(COLUMNS, found.sum(axis=0).tolist(), strict=True))
    risk = sums["stated_risk"] / lanes if lanes else sum(bounds) / 2
    low, high = exact_interval(round(sums["declared_not_clear"]), lanes)
    return LaneBin(
        density,
        *bounds,
        lanes=lanes,
        needed=needed(risk),
        stated=risk,
        not_clear=sums["declared_not_clear"] / max(lanes, 1),
        not_clear_low=low,
        not_clear_high=high,
        stated_unmarked=sums["stated_unmarked"],
        left_unmarked=sums["left_unmarked"],
        stated_marked=sums["stated_marked"],
        left_marked=sums["left_marked"],
        verdict=verdict(risk, (low, high)) if lanes else "undecided",
    )


def exact_interval(successes: int, number: int) -> tuple[float, float]:
    """Return the interval of Clopper and Pearson for a share."""
    if number == 0:
        return 0.0, 1.0
    interval = stats.binomtest(successes, number).proportion_ci(CONFIDENCE, "exact")
    return float(interval.low), float(interval.high)


def needed(risk: float) -> int:
    """Return the lanes with which half of the interval is the tolerance, if the risk is true."""
    deviates = float(stats.norm.isf((1 - CONFIDENCE) / 2))
    return math.ceil(risk * (1 - risk) * (deviates / tolerance(risk)) ** 2)


def tolerance(risk: float) -> float:
    """Return by how much a risk may differ from the interval."""
    return max(MIN_TOLERANCE, TOLERANCE * risk)


def verdict(risk: float, interval: tuple[float, float]) -> str:
    """Return whether the stated risk is near the interval; it may be too high, but not too low."""
    low, high = interval
    if risk < low - tolerance(risk):
        return "fails: the stated risk is too low"
    if risk > high + tolerance(risk):
        return "careful"
    return "undecided" if (high - low) / 2 > tolerance(risk) else "passes"


def of_lanes(found: list[LaneBin]) -> str:
    """Return the table of the random lanes."""
    header = ["", "stated risk", "lanes", "needed", "stated", "not clear (99% interval)"]
    header += ["unmarked: stated, left", "marked: stated, left", "verdict"]
    lines = [
        [
            each.density,
            f"{each.low:g} to {each.high:g}",
            f"{each.lanes:,}",
            f"{each.needed:,}",
            f"{each.stated:.4f}",
            f"{each.not_clear:.4f} ({each.not_clear_low:.4f} to {each.not_clear_high:.4f})",
            f"{each.stated_unmarked:.1f}, {each.left_unmarked:.0f}",
            f"{each.stated_marked:.1f}, {each.left_marked:.0f}",
            each.verdict,
        ]
        for each in found
        if each.lanes
    ]
    return table(header, lines)

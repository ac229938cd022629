"""What the runs of a study prove, with intervals that hold simultaneously and at any time.

A race evaluates its runs repeatedly and stops depending on them, so intervals for a fixed number of
runs would be too narrow. All of these are confidence sequences (`crates/select/src/bounds.rs`). The
allowed error, 1 - confidence, is divided among them (`SINGLES`, `PAIRS`), each part equally among
configurations or ordered pairs; so all statements of an answer hold simultaneously.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from agent_economy import _core
from agent_economy.study.arguments import Floats
from agent_economy.study.equality import EqualByValue
from agent_economy.study.teams import rounded

Limits = tuple[float, float]

QUANTITIES = ("merit", "time_s", "failed")
"""Quantities with intervals: the merit, and two columns that every simulator has."""


SINGLES = 1 / 4
"""Part of the allowed error for intervals of single configurations, all quantities together."""

PAIRS = {"merit": 1 / 2, "time_s": 1 / 8, "failed": 1 / 8}
"""Parts for the differences of pairs; the largest for the merit, which decides the selection."""


@dataclass(frozen=True)
class Interval:
    """An estimate of a mean with its confidence bounds."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Sample(EqualByValue):
    """The runs of one configuration.

    Attributes:
        values: Values of the varied factors, by path.
        columns: By name, shape (runs,): the quantities of the question, such as those of
            `QUANTITIES`, "robots", and "price" if the simulator has prices. About a requirement,
            "quarantined" is 1 in a quarantined run; in other columns, it has the greatest value.
            Those of `GOAL_COLUMNS` if the scenario has goals, and of `CLEARANCE_COLUMNS` if it has
            a lane to be cleared.
        limits: By name, the range of a column.
        quarantined: Number of runs without a finite merit, which count as the worst.
    """

    values: Mapping[str, float | str]
    columns: Mapping[str, Floats]
    limits: Mapping[str, Limits]
    quarantined: int

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(next(iter(self.columns.values())))

    @property
    def is_possible(self) -> bool:
        """Whether it can be run: not all of its runs are quarantined."""
        return self.quarantined < self.runs

    @property
    def price(self) -> float:
        """Price of its robots and controllers; 0 if the simulator has no prices."""
        if "price" not in self.columns:
            return 0.0
        # Every run has the same one.
        return rounded(float(self.columns["price"][0]))

    def mean(self, name: str) -> float:
        """Return the mean of a column."""
        return float(self.columns[name].mean())


@dataclass(frozen=True)
class Evidence:
    """The runs of all configurations of a study.

    Attributes:
        samples: Those of each configuration.
        confidence: The confidence of all intervals together.
        part: Part of the allowed error for the intervals of one quantity.
    """

    samples: tuple[Sample, ...]
    confidence: float
    part: float = SINGLES / len(QUANTITIES)

    @cached_property
    def has_prices(self) -> bool:
        """Whether robots have prices; otherwise, the price of a team is its number of robots."""
        return any(sample.price != 0 for sample in self.samples)

    def price(self, configuration: int) -> float:
        """Return the price of a configuration's team."""
        sample = self.samples[configuration]
        return sample.price if self.has_prices else sample.mean("robots")

    def alpha_single(self) -> float:
        """Return the allowed error of each side of one configuration's interval."""
        return (1 - self.confidence) * self.part / (2 * len(self.samples))

    def alpha_pair(self, name: str) -> float:
        """Return the allowed error of each side of one pair's difference in a quantity."""
        count = len(self.samples)
        return (1 - self.confidence) * PAIRS[name] / max(1, count * (count - 1))

    def interval(self, configuration: int, name: str) -> Interval:
        """Return the mean of a quantity with its bounds."""
        key = configuration, name
        if key not in self._intervals:
            sample = self.samples[configuration]
            low, high = _core.mean_bounds(
                sample.columns[name], *sample.limits[name], self.alpha_single()
            )
            self._intervals[key] = Interval(sample.mean(name), low, high)
        return self._intervals[key]

    @cached_property
    def _intervals(self) -> dict[tuple[int, str], Interval]:
        """Cache of intervals, each of which is used many times."""
        return {}

    def difference(self, one: int, other: int, name: str) -> Interval:
        """Return the difference of two means.

        Its bounds are the tighter ones of two kinds that hold simultaneously: from the runs that
        both have in common, and from the two intervals of all runs.
        """
        values, limits = self._differences(one, other, name)
        low, high = _core.mean_bounds(values, *limits, self.alpha_pair(name))
        first, second = self.interval(one, name), self.interval(other, name)
        low, high = max(low, first.low - second.high), min(high, first.high - second.low)
        return Interval(min(max(float(values.mean()), low), high), low, high)

    def exceeds(self, one: int, other: int, name: str, by: float = 0.0) -> bool:
        """Return whether one mean is proved to be above the other by more than an amount."""
        if self.interval(one, name).low - self.interval(other, name).high > by:
            return True
        values, limits = self._differences(one, other, name)
        return _core.mean_exceeds(values, limits, by, self.alpha_pair(name))

    def _differences(self, one: int, other: int, name: str) -> tuple[Floats, Limits]:
        first, second = self.samples[one], self.samples[other]
        runs = min(first.runs, second.runs)
        values = first.columns[name][:runs] - second.columns[name][:runs]
        (low, high), (other_low, other_high) = first.limits[name], second.limits[name]
        return values, (low - other_high, high - other_low)

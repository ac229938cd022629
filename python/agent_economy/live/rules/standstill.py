"""Whether a stopped robot stands: what its readings show of slow motion.

Single readings show a fast motion. A slow one shows only in the slope of many: the readings since
the stop are averaged over seconds, and a line is fitted to the last of them, by least squares. With
noise of standard deviation s, and readings at the times t, the slope has the standard deviation
s / sqrt(sum((t - mean(t))^2)) (Draper and Smith, Applied Regression Analysis, section 1.4).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.live.plan import InputPlan
from agent_economy.live.readings import Quantity
from agent_economy.live.rules.faults import (
    DRIFT_M_S,
    DRIFT_RAD_S,
    MISSED_SIGMAS,
    MOVES_SIGMAS,
    STANDS_SIGMAS,
    STANDSTILL_S,
)
from agent_economy.live.rules.interface import Sample

BIN_S = 1.0
"""Readings within this time are averaged."""

SHORTEST_S, LONGEST_S = 5.0, 30.0
"""Lines are fitted to the readings of times of these lengths, and of all between."""

MAX_PAUSE_S = 5.0
"""After a longer time without a reading, the readings before do not count."""

MAX_AGE_S = 3.0
"""A standstill is confirmed for this time after the last reading."""

MIN_MEANS = 4
"""A line is fitted to this number of means at least."""

_DRIFTS = {Quantity.POSITION: DRIFT_M_S, Quantity.HEADING: DRIFT_RAD_S}


@dataclass(frozen=True, slots=True)
class Mean:
    """The mean of the readings of one second.

    Attributes:
        began_s: When the first one came.
        newest_s: When the last one came.
        time_s: The mean of their times.
        values: The means of the values; headings are continuous, beyond a full turn too.
        count: The number of readings.
    """

    began_s: float
    newest_s: float
    time_s: float
    values: tuple[float, ...]
    count: int

    def after(self, time_s: float, values: tuple[float, ...]) -> "Mean":
        """Return the mean with one more reading."""
        count = self.count + 1
        pairs = zip(self.values, values, strict=True)
        means = tuple(mean + (value - mean) / count for mean, value in pairs)
        mean_s = self.time_s + (time_s - self.time_s) / count
        return Mean(self.began_s, time_s, mean_s, means, count)


@dataclass(frozen=True, slots=True)
class Slope:
    """The slope of a line through the last readings.

    Attributes:
        span_s: The time from the first to the last one.
        rate: The slope, per second.
        deviation: Its standard deviation.
    """

    span_s: float
    rate: float
    deviation: float


@dataclass(frozen=True, slots=True)
class Standstill:
    """What the readings of one input since the stop show.

    Attributes:
        means: The means of seconds, the newest last.
        moves: Whether they show a motion.
        unseen: The fastest motion over the last `STANDSTILL_S` that would not have been noticed,
            per second; None if they do not confirm a standstill.
    """

    means: tuple[Mean, ...] = ()
    moves: bool = False
    unseen: float | None = None

    def unseen_at(self, time_s: float) -> float | None:
        """Return the unseen motion at a time; None if there has been no reading for too long."""
        is_fresh = len(self.means) > 0 and time_s - self.means[-1].newest_s <= MAX_AGE_S
        return self.unseen if is_fresh else None


NO_STANDSTILL = Standstill()


def observed(before: Standstill, sample: Sample, plan: InputPlan) -> Standstill:
    """Return what the readings show with one more; nothing for inputs that have no slope."""
    drift = _DRIFTS.get(plan.quantity)
    numbers = tuple(each for each in sample.values if each is not None)
    if drift is None or len(numbers) != len(sample.values):
        return NO_STANDSTILL
    means = _with(before.means, sample.time_s, numbers, plan.quantity)
    slopes = list(_slopes(means, plan.noise))
    return Standstill(
        means=means,
        moves=any(_exceeds(each, MOVES_SIGMAS, drift) for each in slopes),
        unseen=_unseen(slopes, drift),
    )


def _with(
    means: tuple[Mean, ...], time_s: float, values: tuple[float, ...], quantity: Quantity
) -> tuple[Mean, ...]:
    if not means or not 0.0 <= time_s - means[-1].time_s <= MAX_PAUSE_S:
        return (Mean(time_s, time_s, time_s, values, 1),)
    newest = means[-1]
    if quantity is Quantity.HEADING:
        last = newest.values[0]
        values = (last + (values[0] - last + math.pi) % math.tau - math.pi,)
    if time_s - newest.began_s < BIN_S:
        return (*means[:-1], newest.after(time_s, values))
    kept = tuple(each for each in means if time_s - each.began_s <= LONGEST_S)
    return (*kept, Mean(time_s, time_s, time_s, values, 1))


def _slopes(means: tuple[Mean, ...], noise: float) -> Iterator[Slope]:
    """Yield the slopes of the last means, of growing spans, from sums that grow with them.

    A mean counts as one reading, however many it is of: errors within a second are not independent.
    Times and values are relative to the newest mean: sums of large numbers would lose digits.
    """
    newest = means[-1]
    axes = range(len(newest.values))
    time = square = 0.0
    values, products = [0.0 for _ in axes], [0.0 for _ in axes]
    for number, mean in enumerate(reversed(means), 1):
        time_s = mean.time_s - newest.time_s
        time += time_s
        square += time_s * time_s
        for axis in axes:
            value = mean.values[axis] - newest.values[axis]
            values[axis] += value
            products[axis] += value * time_s
        if number >= MIN_MEANS and -time_s >= SHORTEST_S:
            spread = square - time * time / number
            rates = [(products[axis] - time * values[axis] / number) / spread for axis in axes]
            yield Slope(-time_s, math.hypot(*rates), noise / math.sqrt(spread))


def _exceeds(slope: Slope, sigmas: float, drift: float) -> bool:
    return slope.rate > sigmas * slope.deviation + drift


def _unseen(slopes: list[Slope], drift: float) -> float | None:
    """Return the fastest motion that would not have been noticed; None without a standstill."""
    if any(_exceeds(each, STANDS_SIGMAS, drift) for each in slopes):
        return None
    enough = (each for each in slopes if each.span_s >= STANDSTILL_S)
    shortest = min(enough, key=lambda each: each.span_s, default=None)
    if shortest is None:
        return None
    return (STANDS_SIGMAS + MISSED_SIGMAS) * shortest.deviation + drift

"""The merits of a selection so far, and what they show."""

import math

import numpy as np

from agent_economy import _core
from agent_economy.study.answer.evidence import Interval, Sample
from agent_economy.study.arguments import Floats
from agent_economy.study.sampling.sampler import MERIT
from agent_economy.study.selection import Integers, within


class Samples:
    """The merits of all configurations, within their limits.

    Attributes:
        runs: Runs per configuration; shape (k,).
        sums: Sums of their merits; shape (k,).
        quarantined: Number of runs without a finite merit; shape (k,).
    """

    def __init__(self, limits: Floats, confidence: float) -> None:
        """Start without any; the confidence is that of all intervals together."""
        self._limits = limits
        self._alpha = (1 - confidence) / (2 * len(limits))
        self._merits: list[list[Floats]] = [[] for _ in limits]
        self.runs = np.zeros(len(limits), dtype=np.int64)
        self.sums = np.zeros(len(limits))
        self.quarantined = np.zeros(len(limits), dtype=np.int64)

    def add(self, configurations: Integers, merits: Floats) -> tuple[Floats, Integers]:
        """Add merits, shape (configurations, runs).

        Returns:
            The merits within their limits, and the number of quarantined ones per row.
        """
        merits, quarantined = within(self._limits, configurations, merits)
        self.quarantined[configurations] += quarantined
        self.runs[configurations] += merits.shape[1]
        self.sums[configurations] += merits.sum(axis=1)
        for configuration, row in zip(configurations, merits, strict=True):
            self._merits[configuration].append(row)
        return merits, quarantined

    def mean(self, configuration: int) -> float:
        """Return the mean merit of a configuration that has runs."""
        return float(self.sums[configuration] / self.runs[configuration])

    def merits(self, configuration: int) -> Floats:
        """Return the merits of a configuration; shape (runs,)."""
        return np.concatenate([np.empty(0), *self._merits[configuration]])

    def interval(self, configuration: int) -> Interval:
        """Return the mean of a configuration, NaN without runs, with its bounds."""
        merits = self.merits(configuration)
        lowest, highest = self._limits[configuration].tolist()
        low, high = _core.mean_bounds(merits, lowest, highest, self._alpha)
        return Interval(merits.mean() if len(merits) else math.nan, low, high)

    def sample(self, configuration: int) -> Sample:
        """Return the runs of a configuration as those of a study."""
        lowest, highest = self._limits[configuration].tolist()
        return Sample(
            values={},
            columns={MERIT: self.merits(configuration)},
            limits={MERIT: (lowest, highest)},
            quarantined=int(self.quarantined[configuration]),
        )

"""The merits that a sampler returns, as blocks of runs."""

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from agent_economy.scenario.validation import number_array
from agent_economy.study.arguments import Floats
from agent_economy.study.run_block import Columns, Part, RunBlock
from agent_economy.study.selection import Integers, within
from agent_economy.study.store import Column

Sampler = Callable[[Integers, int, int], ArrayLike]
SAMPLER = "a function of configurations, a first run and a number of runs"

LANE = 2**32
"""Number of runs of one seed (and of one configuration, without common random numbers)."""

MERIT = "merit"
COLUMNS = (Column(MERIT, "real"),)
"""What is kept of every run."""


@dataclass(frozen=True)
class SampledRuns:
    """The runs of a sampler; those of a block are numbered from 0, whatever the seed is.

    Attributes:
        sampler: Returns their merits.
        limits: Minimum and maximum merit of each configuration, shape (k, 2).
        seed: 0 to 2^31 - 1.
        are_shared: Whether all configurations have the same run numbers, which start at
            `seed` x `LANE`; otherwise, those of configuration c start at (`seed` x k + c) x `LANE`.
    """

    sampler: Sampler
    limits: Floats
    seed: int
    are_shared: bool

    def __call__(self, block: RunBlock) -> Columns:
        """Return the merits of a block, NaN where they are not finite.

        Raises:
            InputError: If the sampler returns anything else, or a merit outside of its limits.
        """
        configurations = np.array(block.configurations, dtype=np.int64)
        merits = self._shared(configurations, block) if self.are_shared else self._separate(block)
        within(self.limits, configurations, merits)
        return {MERIT: np.where(np.isfinite(merits), merits, np.nan)}

    def whole(self, block: RunBlock) -> Generator[Part]:
        """Yield a block as one part."""
        yield block, self(block)

    def _shared(self, configurations: Integers, block: RunBlock) -> Floats:
        return self._sample(configurations, self.seed * LANE + block.first_run, block.runs)

    def _separate(self, block: RunBlock) -> Floats:
        lane = self.seed * len(self.limits)
        rows = [
            self._sample(np.array([each]), (lane + each) * LANE + block.first_run, block.runs)
            for each in block.configurations
        ]
        return np.concatenate(rows)

    def _sample(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        """Return what the sampler returns for consecutive runs, checked."""
        count = len(configurations)
        if runs == count > 1:
            # In a square, rows and columns could be exchanged without an error.
            parts = ((first_run, runs - 1), (first_run + runs - 1, 1))
            return np.hstack([self._sample(configurations, *part) for part in parts])
        # A copy, because samplers may modify their arguments.
        merits = self.sampler(configurations.copy(), first_run, runs)
        meaning = "a row for each configuration, a column for each run"
        return number_array("the sampler returned", merits, (count, runs), meaning)

"""Quantiles of outcome columns, with intervals that are valid at any time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from agent_economy import _core
from agent_economy.scenario.requirement import of_success
from agent_economy.study.answer.evidence import Evidence, Sample

SHARES = (0.5, 0.9, 0.95)
"""The median and two high quantiles: a mean with a time limit hides the runs that take long."""


@dataclass(frozen=True)
class Quantile:
    """A quantile with its bounds; None stands for infinity, such as a time that is never reached.

    Attributes:
        share: The share of runs at or below it.
        value: The quantile of the runs.
        low: Its lower bound.
        high: Its upper bound.
    """

    share: float
    value: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Quantiles:
    """The quantiles of one column of a configuration.

    The quantiles of all configurations and columns of an answer hold simultaneously, as a statement
    of their own with the confidence of the answer.

    Attributes:
        column: The outcome column; `time_s` is the time of success.
        quantiles: One for each of `SHARES`.
        never: The share of runs in which it is infinite.
    """

    column: str
    quantiles: tuple[Quantile, ...]
    never: float


def quantiles_of(
    evidence: Evidence, sample: Sample, columns: Sequence[str]
) -> tuple[Quantiles, ...]:
    """Return the quantiles of some columns of a configuration; none without runs."""
    if not sample.runs:
        return ()
    sides = 2 * len(SHARES) * len(columns) * len(evidence.samples)
    alpha = (1 - evidence.confidence) / sides
    return tuple(quantiles(sample, column, alpha) for column in columns)


def quantiles(sample: Sample, column: str, alpha: float) -> Quantiles:
    """Return the quantiles of a column; each bound is wrong with a probability of `alpha`."""
    ordered = np.sort(of_success(sample.columns, column))
    return Quantiles(
        column=column,
        quantiles=tuple(
            Quantile(
                share,
                # The smallest value at or below which this share of the runs lies.
                finite(float(ordered[max(0, math.ceil(share * len(ordered) - 1e-9) - 1)])),
                *map(finite, _core.quantile_bounds(ordered, share, alpha)),
            )
            for share in SHARES
        ),
        never=float(np.isinf(ordered).mean()),
    )


def finite(number: float) -> float | None:
    """Return a number; None if it is infinite."""
    return number if math.isfinite(number) else None

"""Quantiles of outcome columns, with intervals that are valid at any time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from agent_economy import _core
from agent_economy.scenario.requirement import of_success
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.arguments import Floats

SHARES = (0.5, 0.9, 0.95)
"""The median and two high quantiles: a mean with a time limit hides the runs that take long."""


@dataclass(frozen=True)
class Quantile:
    """A quantile with its bounds; infinite numbers stand for what is never reached.

    Attributes:
        share: The share of runs at or below it.
        value: The quantile of the runs.
        low: Its lower bound; None if too few runs are known for one.
        high: Its upper bound; infinite also if too few runs are known for one.
    """

    share: float
    value: float
    low: float | None
    high: float


@dataclass(frozen=True)
class Quantiles:
    """The quantiles of one column of a configuration.

    A quarantined run never succeeds; columns other than times leave it out.

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
    found = ((column, observed(sample, column)) for column in columns)
    return tuple(quantiles(column, values, alpha) for column, values in found if len(values))


def observed(sample: Sample, column: str) -> Floats:
    """Return the values of a column that have a distribution, in ascending order.

    In a quarantined run, a time is infinite; another column has no value.
    """
    values = of_success(sample.columns, column)
    if not column.endswith("_s"):
        values = values[sample.columns["quarantined"] == 0]
    return np.sort(values)


def quantiles(column: str, ordered: Floats, alpha: float) -> Quantiles:
    """Return the quantiles of a column; each bound is wrong with a probability of `alpha`."""
    return Quantiles(
        column=column,
        quantiles=tuple(
            Quantile(
                share,
                # The smallest value at or below which this share of the runs lies.
                float(ordered[max(0, math.ceil(share * len(ordered) - 1e-9) - 1)]),
                None if low == -math.inf else low,
                high,
            )
            for share in SHARES
            for low, high in [_core.quantile_bounds(ordered, share, alpha)]
        ),
        never=float(np.isinf(ordered).mean()),
    )

"""Shares of a variance from its components, with intervals that follow from the errors of means.

A component is a quadratic form of the means, such as the variance of the averages over the values
of one factor. It is given as the matrix of products of `rows`: of the means with themselves, of the
means with each part of their errors, and of these parts.
"""

from dataclasses import dataclass

import numpy as np

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.arguments import Floats

REPLICATES = 2000

SEED = 1

TAIL = 0.025
"""Probability outside of each end of a 95% interval."""

TINY = 1e-300
"""Replaces a variance of 0 as a divisor."""

PLACES = 4
"""Decimals of results; further ones depend on the machine's linear algebra."""


@dataclass(frozen=True, eq=False)
class Components:
    """The components of a variance: matrices of shape (rows, rows), one per factor where stated.

    Attributes:
        alone: Of each factor: what it explains alone.
        joint: Of each factor: what it explains only together with others.
        interactions: What no factor explains alone.
        unexplained: What a polynomial does not explain; None if there is no polynomial.
    """

    alone: Floats
    joint: Floats
    interactions: Floats
    unexplained: float | None = None

    @property
    def unexplained_share(self) -> float:
        """The share of the variance that is unexplained; 0 if there is no variance."""
        explained = float(estimates(self.alone).sum() + estimates(self.interactions))
        left = self.unexplained or 0.0
        return left / max(explained + left, TINY)


@dataclass(frozen=True, eq=False)
class Shares:
    """The shares of each factor, with 95% intervals.

    Every share with interactions is at least that alone, and so are the bounds of its interval.
    """

    alone: tuple[Interval, ...]
    with_interactions: tuple[Interval, ...]


def products(rows: Floats) -> Floats:
    """Return the products of rows with each other: (rows, rows)."""
    found: Floats = rows @ rows.T
    return found


def shares(components: Components, fewest_runs: int) -> Shares | None:
    """Return the shares of a variance; None if the variance is not above the noise of the means.

    The noise adds its own variance to each component, which is subtracted. Replicates with random
    signs of the parts show how far noise moves the estimates; their quantiles are the intervals.
    Student's quantile allows for the number of runs from which the noise is known. All of the
    variance that is unexplained may be due to any factor, so upper bounds include it.

    Args:
        components: Those of the variance.
        fewest_runs: The number of runs of the configuration with the fewest.

    Source: Searle, Casella and McCulloch (1992), Variance Components, chapter 4 (subtraction of
        the noise); Wu (1986), Jackknife, bootstrap and other resampling methods in regression
        analysis, Annals of Statistics 14, section 7 (random signs).
    """
    size = len(components.interactions) - 1
    signs = np.random.default_rng(SEED).choice([-1.0, 1.0], (REPLICATES, size))
    alone, joint, interactions = (
        replicated(each, signs)
        for each in (components.alone, components.joint, components.interactions)
    )
    if np.quantile(alone.sum(axis=0)[1:] + interactions[1:], TAIL) <= 0:
        return None
    first, every = attributed(alone, joint, interactions, components.unexplained or 0.0)
    bounds = [ends(each, fewest_runs) for each in (first, every)]
    bounds[0][1] += components.unexplained_share
    bounds[1][1] += components.unexplained_share
    bounds[1] = np.maximum(*bounds)
    return Shares(stated(first[:, 0], bounds[0]), stated(every[:, 0], bounds[1]))


def estimates(matrices: Floats) -> Floats:
    """Return the estimates of components, without the noise: shape (...)."""
    found: Floats = matrices[..., 0, 0] - np.trace(matrices[..., 1:, 1:], axis1=-2, axis2=-1)
    return found


def replicated(matrices: Floats, signs: Floats) -> Floats:
    """Return the estimates of components and their replicates: (..., 1 + replicates).

    Args:
        matrices: Shape (..., rows, rows).
        signs: Of the parts in each replicate.
    """
    found, slopes, parts = matrices[..., 0, 0], matrices[..., 0, 1:], matrices[..., 1:, 1:]
    values = estimates(matrices)
    # The means contain noise already: with more of it, they are scaled to what is without it.
    scales = np.sqrt(np.maximum(values, 0) / np.maximum(found, TINY))
    linear = 2 * scales[..., None] * (slopes @ signs.T)
    quadratic = ((signs @ parts) * signs).sum(axis=-1)
    moved = (2 * values - found)[..., None] + linear + quadratic
    return np.concatenate([values[..., None], moved], axis=-1)


def attributed(
    alone: Floats, joint: Floats, interactions: Floats, unexplained: float
) -> tuple[Floats, Floats]:
    """Return the shares alone and with interactions: (factors, 1 + replicates).

    No component of a variance is negative, and no factor has more of the interactions than all.
    """
    alone, interactions = np.maximum(alone, 0), np.maximum(interactions, 0)
    total = np.maximum(alone.sum(axis=0) + interactions + unexplained, TINY)
    return alone / total, (alone + np.clip(joint, 0, interactions)) / total


def ends(shares: Floats, fewest_runs: int) -> Floats:
    """Return the ends of the interval of each share, from it and its replicates: (2, factors)."""
    from scipy.special import ndtri, stdtrit  # noqa: PLC0415  (slow to load)

    widening = float(stdtrit(fewest_runs - 1, 1 - TAIL) / ndtri(1 - TAIL))
    values = shares[:, 0]
    found = values + widening * (np.quantile(shares[:, 1:], [TAIL, 1 - TAIL], axis=1) - values)
    return np.stack([np.minimum(found[0], values), np.maximum(found[1], values)])


def stated(values: Floats, bounds: Floats) -> tuple[Interval, ...]:
    """Return shares with their bounds, rounded."""
    rounded = np.round(np.clip([values, *bounds], 0, 1), PLACES)
    return tuple(Interval(*each) for each in rounded.T.tolist())

"""The components of the variance of a polynomial in the factors, fitted to any independent points.

A polynomial chaos expansion: a sum of products of orthonormal functions of one factor each. If the
factors are independent, its variance is the sum of the squares of the coefficients, and each term
belongs to the factors that it contains.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.answer.sensitivity.basis import Basis
from agent_economy.study.answer.sensitivity.components import Components, products
from agent_economy.study.answer.sensitivity.factors import Codes
from agent_economy.study.answer.sensitivity.means import GROUPS
from agent_economy.study.answer.sensitivity.terms import Terms, terms
from agent_economy.study.arguments import Floats

MAX_TERMS = 150

POINTS_PER_TERM = 2
"""Minimum number of configurations per term."""

MIN_OWN = 0.01
"""Minimum share of a term that those before it cannot replace."""

TOLERANCE = 1e-9
"""Share of the variance by which a larger polynomial must predict better."""

CHUNK = 10_000
"""Number of configurations whose terms are in memory at a time."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A polynomial that is fitted to each row of means.

    Attributes:
        terms: Its terms.
        inverse: The inverse of the mean products of 1 and the terms.
        coefficients: Those of 1 and of the terms, for each row: (1 + terms, rows).
    """

    terms: Terms
    inverse: Floats
    coefficients: Floats


def components(bases: Sequence[Basis], rows: Floats) -> Components:
    """Return the components of the variance of a polynomial, and what it leaves unexplained.

    The polynomial is that of `Terms.polynomials` with the smallest generalised cross-validation
    error, fitted by least squares. The coefficients have errors due to the noise of the means, and
    due to what the polynomial misses. That is the difference of a mean from the prediction without
    it, above the noise; the sizes of the latter errors are rather too large than too small.

    Args:
        bases: That of each factor.
        rows: As of `means.rows`.

    Source: Sudret (2008), Global sensitivity analysis using polynomial chaos expansions,
        Reliability Engineering and System Safety 93; Craven and Wahba (1979), Smoothing noisy data
        with spline functions, Numerische Mathematik 31 (generalised cross-validation); MacKinnon
        and White (1985), Some heteroskedasticity-consistent covariance matrix estimators with
        improved finite sample properties, Journal of Econometrics 29 (errors of coefficients).
    """
    fitted = fit(bases, rows)
    errors, unexplained = misfit(fitted, bases, rows)
    table = np.vstack([fitted.coefficients.T, errors])[:, 1:]
    contains = np.array([fitted.terms.contain(factor) for factor in range(len(bases))])
    is_single = contains.sum(axis=0) == 1
    return Components(
        alone=np.array([products(table[:, each & is_single]) for each in contains]),
        joint=np.array([products(table[:, each & ~is_single]) for each in contains]),
        interactions=products(table[:, ~is_single]),
        unexplained=unexplained,
    )


def fit(bases: Sequence[Basis], rows: Floats) -> Fit:
    """Return the polynomial that predicts best, of all that the points determine."""
    count = rows.shape[1]
    most = min(MAX_TERMS, count // POINTS_PER_TERM)
    every = terms(bases, most - 1)
    size = 1 + len(every.functions)
    gram, projected = np.zeros((size, size)), np.zeros((size, len(rows)))
    for some in chunks(count):
        values = every.values(bases, some)
        gram += values.T @ values / count
        projected += values.T @ rows[:, some].T / count
    best, least = with_constant(np.zeros(size - 1, dtype=bool)), float((rows[0] ** 2).mean())
    square, tolerance = least, TOLERANCE * least
    for chosen in map(with_constant, sorted(every.polynomials(), key=np.count_nonzero)):
        if len(chosen) > most:
            break
        explained = explained_by(gram[np.ix_(chosen, chosen)], projected[chosen, 0])
        error = (square - explained) / (1 - len(chosen) / count) ** 2
        if error < least - tolerance:
            best, least = chosen, error
    inverse = np.asarray(np.linalg.inv(gram[np.ix_(best, best)]), dtype=np.float64)
    return Fit(every.of(best[1:] - 1), inverse, inverse @ projected[best])


def explained_by(gram: Floats, projected: Floats) -> float:
    """Return the mean square that terms explain; none if the points do not determine them."""
    try:
        factor = np.linalg.cholesky(gram)
    except np.linalg.LinAlgError:
        return 0.0
    if (np.diag(factor) ** 2).min() < MIN_OWN:
        return 0.0
    return float((np.linalg.solve(factor, projected) ** 2).sum())


def misfit(fitted: Fit, bases: Sequence[Basis], rows: Floats) -> tuple[Floats, float]:
    """Return parts of the errors of the coefficients, and the variance that is unexplained.

    Both are of what the polynomial misses. Parts have the configurations of a group each.
    """
    count = rows.shape[1]
    errors, unexplained = np.zeros((GROUPS, len(fitted.inverse))), 0.0
    for some in chunks(count):
        values = fitted.terms.values(bases, some)
        influence = values @ fitted.inverse / count
        leverage = (influence * values).sum(axis=1)
        missed = (rows[:, some] - (values @ fitted.coefficients).T) / (1 - leverage)
        above_noise = missed[0] ** 2 - (missed[1:] ** 2).sum(axis=0)
        unexplained += float(above_noise.sum()) / count
        sizes = np.sign(missed[0]) * np.sqrt(np.maximum(above_noise, 0))
        np.add.at(errors, some % GROUPS, influence * sizes[:, None])
    return errors, max(0.0, unexplained)


def chunks(count: int) -> Iterator[Codes]:
    """Yield the indices of configurations, in chunks."""
    yield from np.array_split(np.arange(count), 1 + count // CHUNK)


def with_constant(chosen: NDArray[np.bool_]) -> Codes:
    """Return the indices of 1 and of chosen terms."""
    return np.flatnonzero(np.concatenate([[True], chosen]))

"""The configurations of a study: full factorial, Latin hypercube or Sobol' points."""

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from agent_economy._core import InputError
from agent_economy.scenario import Factor, Value
from agent_economy.study.paths import is_of_absent_kind

MAX_CONFIGURATIONS = 100_000
"""Maximum number of configurations of a study."""

Values = dict[str, Value]
"""A value for each factor, by path."""


def points(factors: Sequence[Factor], design: str = "factorial", seed: int = 0) -> list[Values]:
    """Return the configurations of a design, the same in every call.

    Args:
        factors: The varied factors. Without any, the design has one configuration.
        design: "factorial" (all combinations of values, the first factor varies slowest), "lhs:N"
            or "sobol:N" (N space-filling points, N a power of two for sobol), as in
            `Scenario.design`. A list of values divides its axis into equal parts, one per value;
            points with the same values are one configuration. Where the number of a kind of robots
            or controllers is 0, its other factors have no effect: they have their first values.
        seed: Seed of lhs and sobol; 0 to 2^64 - 1.

    Raises:
        InputError: If there are more than 100,000, or a factorial design has a range.
    """
    if design == "factorial" or not factors:
        drawn = factorial(factors)
    else:
        paths = [factor.path for factor in factors]
        rows = zip(*columns(factors, sample(design, len(factors), seed)), strict=True)
        drawn = [dict(zip(paths, row, strict=True)) for row in rows]
    distinct = {tuple(each.values()): each for each in with_absent_kinds(factors, drawn)}
    return list(distinct.values())


def with_absent_kinds(factors: Sequence[Factor], points: Sequence[Values]) -> Iterator[Values]:
    """Yield points in which factors of kinds without robots or controllers have first values."""
    first = {factor.path: (factor.range or factor.values)[0] for factor in factors}
    for values in points:
        yield {
            path: first[path] if is_of_absent_kind(path, values) else value
            for path, value in values.items()
        }


def describe(design: str, configurations: int) -> str:
    """Return a design and its number of configurations in words."""
    number = f"{configurations:,} configuration{'' if configurations == 1 else 's'}"
    if design == "factorial":
        return f"factorial: {number}"
    drawn = number_of_points(design)
    return f"{design}: {number}" + (
        f" ({drawn:,} points, some with the same values)" if configurations < drawn else ""
    )


def factorial(factors: Sequence[Factor]) -> list[Values]:
    """Return all combinations of the factors' values."""
    ranges = [factor for factor in factors if factor.range]
    if ranges:
        message = "\n".join(
            f"study.vary: {factor.path}: must be a list of values if the design is factorial"
            for factor in ranges
        )
        raise InputError(message)
    count = math.prod(len(factor.values) for factor in factors)
    if count > MAX_CONFIGURATIONS:
        sizes = " x ".join(str(len(factor.values)) for factor in factors)
        message = (
            f"study.vary: {sizes} values = {count} configurations: must be at most "
            f'{MAX_CONFIGURATIONS}, or study.design = "lhs:1000"'
        )
        raise InputError(message)
    paths = [factor.path for factor in factors]
    rows = product(*(factor.values for factor in factors))
    return [dict(zip(paths, row, strict=True)) for row in rows]


def sample(design: str, dimensions: int, seed: int) -> NDArray[np.float64]:
    """Return the points of a space-filling design in the unit cube: (points, dimensions).

    Source: scipy.stats.qmc; Sobol' points are scrambled.
    """
    # scipy's statistics take half a second to load, and few studies need them.
    from scipy.stats import qmc  # noqa: PLC0415

    count = number_of_points(design)
    kind = qmc.Sobol if design.startswith("sobol:") else qmc.LatinHypercube
    drawn: NDArray[np.float64] = kind(d=dimensions, rng=seed).random(count)
    return drawn


def number_of_points(design: str) -> int:
    """Return N of "lhs:N" or "sobol:N"."""
    return int(design.partition(":")[2])


def columns(factors: Sequence[Factor], drawn: NDArray[np.float64]) -> list[list[Value]]:
    """Return each factor's values at points of the unit cube (points, factors)."""
    return [scaled(factor, drawn[:, index]) for index, factor in enumerate(factors)]


def scaled(factor: Factor, shares: NDArray[np.float64]) -> list[Value]:
    """Return a factor's values at shares of its range or list, 0 to 1."""
    if factor.range:
        low, high = factor.range
        spread: list[Value] = np.minimum(low + shares * (high - low), high).tolist()
        return spread
    indices = np.minimum(shares * len(factor.values), len(factor.values) - 1).astype(int)
    return [factor.values[index] for index in indices]

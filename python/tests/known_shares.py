"""Functions whose shares of the variance are known, to check a sensitivity analysis with."""

import math
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import numpy as np

Function = Callable[..., float]
Shares = tuple[list[float], list[float]]
"""The shares alone, and those with interactions, of each factor."""


def ishigami(one: float, two: float, three: float) -> float:
    """Return the function of Ishigami and Homma (1990), with a = 7 and b = 0.1, over [-1, 1]."""
    waves = math.sin(math.pi * one) * (1 + 0.1 * (math.pi * three) ** 4)
    return waves + 7 * math.sin(math.pi * two) ** 2


def g_function(*values: float) -> float:
    """Return the g-function of Saltelli and Sobol' (1995), with a = 0, 1 and 4.5, over [-1, 1]."""
    return math.prod((abs(2 * x) + a) / (1 + a) for x, a in zip(values, (0, 1, 4.5), strict=True))


def interaction(one: float, two: float) -> float:
    """Return a product, of which no factor explains anything alone."""
    return one * two


def additive(one: float, two: float, three: float) -> float:
    """Return a sum without interactions."""
    return 3 * one + two**2 + three


def categorical(name: str, x: float) -> float:
    """Return a line whose height and slope depend on a name, in no order."""
    height, slope = {"b": (1, 3), "d": (0.5, 1), "a": (0, 1), "c": (-2, 1)}[name]
    return height + slope * x / 2


def levels(count: int) -> list[float]:
    """Return evenly spaced numbers from -1 to 1."""
    return [float(each) for each in np.linspace(-1, 1, count)]


GRIDS: dict[str, tuple[Function, list[Sequence[Any]]]] = {
    "ishigami": (ishigami, [levels(9), levels(8), levels(7)]),
    "g-function": (g_function, [levels(6), levels(5), levels(4)]),
    "interaction": (interaction, [levels(6), levels(8)]),
    "additive": (additive, [levels(5), levels(4), levels(3)]),
    "categorical": (categorical, ["badc", levels(9)]),
}


def enumerated(function: Function, axes: list[Sequence[Any]]) -> Shares:
    """Return the shares by the definition: variances of conditional means over all combinations."""
    cells = list(product(*axes))
    values = np.array([function(*cell) for cell in cells])
    shape = tuple(map(len, axes))
    table, places = values.reshape(shape), range(len(shape))
    alone = [
        table.mean(axis=tuple(other for other in places if other != place)).var()
        for place in places
    ]
    others = [table.mean(axis=place).var() for place in places]
    total = table.var()
    return [each / total for each in alone], [1 - each / total for each in others]


def product_shares(variances: Sequence[float]) -> Shares:
    """Return the shares of a product of independent factors with mean 1 and these variances."""
    total = math.prod(1 + each for each in variances) - 1
    joint = [each * (total + 1) / (1 + each) for each in variances]
    return [each / total for each in variances], [each / total for each in joint]


WAVES = [(1 + math.pi**4 / 50) ** 2 / 2, 49 / 8, 8 * math.pi**8 / 22500]
"""The variances of Ishigami's function: of x1, of x2, and of x1 with x3."""

SUM = [3, 1 / 5 - 1 / 9, 1 / 3]

KNOWN: dict[str, tuple[Function, int, Shares]] = {
    "ishigami": (
        ishigami,
        3,
        (
            [WAVES[0] / sum(WAVES), WAVES[1] / sum(WAVES), 0],
            [1 - WAVES[1] / sum(WAVES), WAVES[1] / sum(WAVES), WAVES[2] / sum(WAVES)],
        ),
    ),
    "g-function": (g_function, 3, product_shares([1 / 3 / (1 + a) ** 2 for a in (0, 1, 4.5)])),
    "interaction": (interaction, 2, ([0, 0], [1, 1])),
    "additive": (additive, 3, ([each / sum(SUM) for each in SUM],) * 2),
}
"""The shares of independent factors that are uniform over [-1, 1]: published, or by integration."""

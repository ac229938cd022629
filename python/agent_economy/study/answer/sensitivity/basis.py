"""Orthonormal functions of the values of one factor."""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from agent_economy.study.answer.sensitivity.factors import Codes, Factors, is_named
from agent_economy.study.arguments import Floats

MAX_DEGREE = 10


@dataclass(frozen=True, eq=False)
class Basis:
    """Functions of a factor that have mean 0 and are orthonormal over its levels.

    Attributes:
        values: In each configuration: (configurations, functions).
        degrees: The degree of each.
    """

    values: Floats
    degrees: Codes


def bases(factors: Factors) -> tuple[Basis, ...]:
    """Return the basis of each factor.

    Numbers have polynomials of their ranks, which do not depend on the scale of a list such as 1,
    10, 100. Names have a function less than there are names, all of degree 1. All levels count
    equally, as in the designs. Where its kind is absent a factor has no effect: its functions have
    their mean there.
    """
    absent = factors.absent(factors.codes)
    made = []
    for index, levels in enumerate(factors.levels):
        count, is_category = len(levels), is_named(levels)
        if is_category:
            raw = np.eye(count)
            raw[:, 0] = 1
            degrees = np.ones(count - 1, dtype=np.int64)
        else:
            degrees = np.arange(1, min(count - 1, MAX_DEGREE) + 1)
            raw = np.array(legendre.legvander(np.linspace(-1, 1, count), len(degrees)))
        functions = np.linalg.qr(raw)[0][:, 1:] * np.sqrt(count)
        values = functions[factors.codes[:, index]]
        values[absent[:, index]] = 0
        made.append(Basis(values, degrees))
    return tuple(made)

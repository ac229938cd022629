"""The components of the variance over all combinations of values: the analysis of variance."""

from dataclasses import dataclass
from math import prod

import numpy as np

from agent_economy.study.answer.sensitivity.components import Components, products
from agent_economy.study.answer.sensitivity.factors import Codes, Factors
from agent_economy.study.arguments import MAX_CONFIGURATIONS, Floats

MAX_MISSING = 0.05
"""Share of the combinations that may be missing; with more, factors would depend on each other."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Combinations of values that were compared.

    Attributes:
        codes: The levels of each combination: (combinations, factors).
        configurations: The configuration of each; one in which a kind is absent is that of all
            combinations that differ in values about this kind, which have no effect.
    """

    codes: Codes
    configurations: Codes

    @property
    def missing(self) -> float:
        """The share of the combinations of levels that are missing."""
        return 1 - len(self.codes) / prod(len(np.unique(column)) for column in self.codes.T)

    @property
    def is_complete(self) -> bool:
        """Whether it has all combinations, or almost all."""
        return self.missing <= MAX_MISSING

    def joined(self, groups: tuple[tuple[int, ...], ...]) -> "Grid":
        """Return the grid whose factors are groups of this one's."""
        columns = [classes(self.codes[:, group]) for group in groups]
        return Grid(np.column_stack(columns), self.configurations)


def grid(factors: Factors) -> Grid | None:
    """Return the combinations of all levels that were compared; None if there are too many."""
    shape = factors.shape
    if prod(shape) > MAX_CONFIGURATIONS:
        return None

    def cells(codes: Codes) -> Codes:
        effective = np.where(factors.absent(codes), 0, codes)
        return np.asarray(np.ravel_multi_index(tuple(effective.T), shape))

    owners = np.full(prod(shape), -1)
    owners[cells(factors.codes)] = np.arange(len(factors.codes))
    codes = np.indices(shape).reshape(len(shape), -1).T
    configurations = owners[cells(codes)]
    is_compared = configurations >= 0
    return Grid(codes[is_compared], configurations[is_compared])


def components(grid: Grid, rows: Floats) -> Components:
    """Return the components of the variance over a grid, of which each combination counts equally.

    The variance of the averages over one factor's levels is what the factor explains alone. The
    variance of the averages over combinations of the others is what they explain without it.

    Args:
        grid: A grid that is complete or almost so; otherwise, its factors are not independent.
        rows: As of `means.rows`.

    Source: Sobol' (2001), Global sensitivity indices for nonlinear mathematical models and their
        Monte Carlo estimates, Mathematics and Computers in Simulation 55; Homma and Saltelli
        (1996), Importance measures in global sensitivity analysis of nonlinear models, Reliability
        Engineering and System Safety 52 (total indices).
    """
    values = rows[:, grid.configurations]
    values -= values.mean(axis=1, keepdims=True)
    total = products(values) / values.shape[1]
    columns = range(grid.codes.shape[1])
    alone = np.array([between(values, grid.codes[:, each]) for each in columns])
    others = [between(values, classes(np.delete(grid.codes, each, axis=1))) for each in columns]
    return Components(alone, total - alone - np.array(others), total - alone.sum(axis=0))


def between(values: Floats, classes: Codes) -> Floats:
    """Return the products of the averages over classes of combinations, weighted by their sizes."""
    order = np.argsort(classes, kind="stable")
    _, starts, sizes = np.unique(classes[order], return_index=True, return_counts=True)
    sums = np.add.reduceat(values[:, order], starts, axis=1)
    return products(sums / np.sqrt(sizes * len(classes)))


def classes(codes: Codes) -> Codes:
    """Return a number for each combination that is the same for equal ones."""
    sizes = codes.max(axis=0) + 1
    numbers = np.ravel_multi_index(tuple(codes.T), tuple(sizes))
    return np.unique(numbers, return_inverse=True)[1]

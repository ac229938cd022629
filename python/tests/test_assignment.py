"""The assignment of the rule `optimal` equals that of scipy."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import agent_economy as ae
from agent_economy.runs.controller import assignment

MATRICES = 10_000


def test_the_assignment_is_that_of_scipy() -> None:
    random = np.random.default_rng(42)
    for _ in range(MATRICES):
        costs = random.random(random.integers(1, 13, size=2))
        rows, columns = linear_sum_assignment(costs)
        expected: list[int | None] = [None] * len(costs)
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
            expected[row] = column
        assert assignment(costs) == expected


def test_with_ties_the_assignment_costs_as_little_as_that_of_scipy() -> None:
    random = np.random.default_rng(43)
    for _ in range(MATRICES):
        costs = random.integers(-2, 3, size=random.integers(1, 9, size=2)).astype(float)
        columns = assignment(costs)
        pairs = [(row, column) for row, column in enumerate(columns) if column is not None]
        assert len({column for _, column in pairs}) == min(costs.shape)
        best = costs[linear_sum_assignment(costs)].sum()
        assert sum(costs[pair] for pair in pairs) == best
        assert columns == assignment(costs.copy())


@pytest.mark.parametrize("wrong", [[1, 2], "costs", [[1], [2, 3]], 5.0])
def test_costs_that_are_no_matrix_are_an_error(wrong: Any) -> None:
    with pytest.raises(ae.InputError, match="costs = .*must be a matrix of numbers"):
        assignment(wrong)

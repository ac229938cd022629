"""The loop of a selection: a procedure (`crates/select`) requests runs until it is settled.

Studies and `select_best` use it, each with runs of its own.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.study.arguments import Floats, Guarantee
from agent_economy.study.errors import NoConfigurationError

Integers = NDArray[np.int64]

ROUNDING = 1e-9
"""Rounding tolerance of merits at their bounds, as a part of the range; they are clipped."""


@dataclass(frozen=True)
class Elimination:
    """An elimination: the configuration, the one that eliminated it if one did, and its runs."""

    configuration: int
    by: int | None
    runs: int


@dataclass(frozen=True)
class Round:
    """One round of a procedure: the runs that it requested, and their merits."""

    configurations: Integers
    first_run: int
    runs: int
    merits: Floats


def drive(
    procedure: _core.Procedure,
    sample: Callable[[Integers, int, int], tuple[Floats, Integers]],
    max_runs: int | None = None,
) -> Iterator[Round]:
    """Compute what a procedure requests until it has selected, or would exceed `max_runs`.

    Configurations whose first runs are all quarantined are excluded: they are not selected.

    Args:
        procedure: Requests the runs.
        sample: Returns their merits, and the number of quarantined ones per configuration.
        max_runs: Run budget.

    Raises:
        NoConfigurationError: If no configuration is left.
    """
    total, has_recorded = 0, False
    while request := procedure.next():
        configurations, first_run, runs = request
        total += len(configurations) * runs
        if max_runs is not None and total > max_runs:
            return
        merits, quarantined = sample(configurations, first_run, runs)
        impossible = (quarantined == runs) & (first_run == 0)
        if impossible.all():
            if has_recorded or len(configurations) < len(procedure.survivors):
                procedure.exclude(configurations.tolist())
                continue
            message = f"all of the first {runs} runs of every configuration are quarantined"
            raise NoConfigurationError(message)
        if impossible.any():
            procedure.exclude(configurations[impossible].tolist())
            configurations, merits = configurations[~impossible], merits[~impossible]
        procedure.record(merits)
        has_recorded = True
        yield Round(configurations, first_run, runs, merits)


def is_over(procedure: _core.Procedure, runs: int, max_runs: int | None) -> bool:
    """Return whether a procedure has selected, or its run budget does not allow another round.

    Args:
        procedure: The procedure.
        runs: Runs of all configurations so far.
        max_runs: Run budget.
    """
    request = procedure.next()
    if request is None or max_runs is None:
        return request is None
    configurations, _, more = request
    return runs + len(configurations) * more > max_runs


def within(limits: Floats, configurations: Integers, merits: Floats) -> tuple[Floats, Integers]:
    """Return merits within their limits, and the number of quarantined ones in each row.

    Raises:
        InputError: If a finite merit is outside its configuration's limits.
    """
    lowest, highest = limits[configurations].T[:, :, np.newaxis]
    bad = ~np.isfinite(merits)
    merits = np.where(bad, lowest, merits)
    slack = ROUNDING * (highest - lowest)
    outside = (merits < lowest - slack) | (merits > highest + slack)
    if outside.any():
        row, run = np.argwhere(outside)[0]
        message = (
            f"configuration {configurations[row]} had a merit of {merits[row, run]:.17g}: must be "
            f"from {lowest[row, 0]:.17g} to {highest[row, 0]:.17g}, its bounds"
        )
        raise InputError(message)
    return np.clip(merits, lowest, highest), bad.sum(axis=1)


def eliminations(procedure: _core.Procedure) -> tuple[Elimination, ...]:
    """Return the eliminations of a procedure, in their order."""
    return tuple(Elimination(*each) for each in procedure.eliminations)


def leading(procedure: _core.Procedure) -> int:
    """Return the selected or leading configuration of a procedure that always has one."""
    selected = procedure.selected
    return 0 if selected is None else selected


def guarantee_text(
    procedure: _core.Procedure, delta: float, confidence: float, guarantee: Guarantee
) -> str:
    """Return the guarantee of a selection in words."""
    if procedure.next() is not None:
        remaining = len(procedure.survivors)
        return (
            f"No guarantee: the run budget was reached with {remaining} configurations remaining."
        )
    confidently = f"with {percentage(confidence)} confidence"
    if guarantee == "pgs":
        return f"The selected configuration is within {delta:g} of the best {confidently}."
    return (
        f"If one configuration is better than every other by {delta:g} or more, it is the selected "
        f"one {confidently}. Smaller differences are not guaranteed to be found."
    )


def percentage(share: float) -> str:
    """Return a confidence as a percentage: 95%, 99.9%."""
    return f"{100 * share:.15g}%"

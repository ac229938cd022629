"""The best of several configurations, with a stated guarantee, for any sampling function.

The procedures are compiled (`crates/select`). This module computes the runs that they request,
checks the merits and records them; a study uses the same loop, `drive`, over its store.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario.validation import check, number_array
from agent_economy.study.arguments import Floats, Guarantee, checked_arguments
from agent_economy.study.equality import EqualByValue
from agent_economy.study.errors import NoConfigurationError

Integers = NDArray[np.int64]
Sampler = Callable[[Integers, int, int], ArrayLike]
SAMPLER = "a function of configurations, a first run and a number of runs"

LANE = 2**32
"""Number of runs of one seed (and of one configuration, without common random numbers)."""

ROUNDING = 1e-9
"""Rounding tolerance of merits at their bounds, as a part of the range; they are clipped."""


@dataclass(frozen=True)
class Elimination:
    """An elimination: the configuration, the one that eliminated it if one did, and its runs."""

    configuration: int
    by: int | None
    runs: int


@dataclass(frozen=True, eq=False)
class Selection(EqualByValue):
    """The best configuration, and estimates of all; two of them are equal if all values are.

    Attributes:
        best: Index of the selected configuration.
        runs: Number of runs per configuration; shape (k,).
        mean: Mean merit of each; shape (k,).
        lower: Lower bounds of the true means, shape (k,). All bounds hold simultaneously and at any
            time, with the stated confidence.
        upper: Upper bounds of the true means, in the same way.
        eliminations: The eliminated configurations, in the order of their elimination.
        survivors: The remaining configurations: only `best`, unless stopped.
        quarantined: Number of runs without a finite merit, which count as the worst; shape (k,).
        stopped: Whether the run budget was reached first; then there is no guarantee.
        guarantee: The guarantee in words.
    """

    best: int
    runs: Integers
    mean: Floats
    lower: Floats
    upper: Floats
    eliminations: tuple[Elimination, ...]
    survivors: tuple[int, ...]
    quarantined: Integers
    stopped: bool
    guarantee: str


def select_best(  # noqa: PLR0913  (keywords with defaults)
    sampler: Sampler,
    k: int,
    *,
    bounds: ArrayLike,
    delta: float,
    confidence: float = 0.95,
    guarantee: Guarantee = "indifference",
    common_random_numbers: bool = True,
    seed: int = 0,
    max_runs: int | None = None,
) -> Selection:
    """Return the best of k configurations by mean merit, with the fewest runs that are needed.

    Args:
        sampler: `sampler(configurations, first_run, runs)` returns the merits of consecutive runs
            of some configurations, shape (len(configurations), runs), as an array or lists of plain
            numbers; higher is better. A run without a finite merit is quarantined: it counts as the
            worst merit. The same run of a configuration must always have the same merit; run
            numbers should determine the random numbers, the same for all configurations, to reduce
            the variance of differences.
        k: Number of configurations, 1 to 100,000; they are numbered from 0.
        bounds: Minimum and maximum merit of a run: a pair, or an array of shape (k, 2).
        delta: Indifference zone, in units of merit; above 0. Runs grow as 1 / delta^2.
        confidence: Confidence of the guarantee; 0.5 to below 1. Runs grow as
            log(1 / (1 - confidence)).
        guarantee: "indifference": if the best is better than every other by delta, it is selected.
            "pgs" (probability of good selection): the selected one is within delta of the best, in
            all cases (6 to 40% more runs).
        common_random_numbers: Whether run r of all configurations may share its random numbers.
            Otherwise, every configuration has its own run numbers.
        seed: 0 to 2,147,483,647. Run numbers start at seed x 2^32; without common random numbers
            at seed x k x 2^32, with 2^32 numbers for each configuration.
        max_runs: Run budget of all configurations together; None for no limit.

    Returns:
        The selection; if the run budget was reached first, the leader without a guarantee. A
        configuration whose first ten runs are all quarantined is excluded, and never selected.

    Raises:
        InputError: If an argument is invalid (it lists all errors), or if the sampler returns
            another shape, what is not certainly numbers (masked values, units, labels, text,
            complex numbers, None), a merit outside of `bounds`, or no finite merit.
    """
    check(callable(sampler), "sampler", sampler, SAMPLER)
    limits = checked_arguments(k, bounds, delta, confidence, guarantee, seed, max_runs)
    # Numbers of NumPy have fewer digits, and are written otherwise.
    k, seed, delta, confidence = int(k), int(seed), float(delta), float(confidence)
    samples = Samples(sampler, limits, seed if common_random_numbers else seed * k)
    procedure = _core.selection(limits, delta=delta, confidence=confidence, guarantee=guarantee)
    sample = samples.shared if common_random_numbers else samples.separate
    for _ in drive(procedure, sample, max_runs):
        pass
    return samples.selection(procedure, delta, confidence, guarantee)


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


class Samples:
    """The checked merits of a sampler."""

    def __init__(self, sampler: Sampler, limits: Floats, lane: int) -> None:
        """Start without any; `lane` x 2^32 is the first run number."""
        self._sampler = sampler
        self._limits = limits
        self._lane = lane
        self._merits: list[list[Floats]] = [[] for _ in limits]
        self._quarantined = np.zeros(len(limits), dtype=np.int64)

    def shared(
        self, configurations: Integers, first_run: int, runs: int
    ) -> tuple[Floats, Integers]:
        """Return merits of the same run numbers for all configurations."""
        merits = self._sample(configurations, self._lane * LANE + first_run, runs)
        return self._recorded(configurations, merits)

    def separate(
        self, configurations: Integers, first_run: int, runs: int
    ) -> tuple[Floats, Integers]:
        """Return merits of separate run numbers for each configuration."""
        rows = [
            self._sample(np.array([each]), (self._lane + each) * LANE + first_run, runs)
            for each in configurations.tolist()
        ]
        return self._recorded(configurations, np.concatenate(rows))

    def _sample(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        """Return what the sampler returns for consecutive runs, checked."""
        count = len(configurations)
        if runs == count > 1:
            # In a square, rows and columns could be exchanged without an error.
            parts = ((first_run, runs - 1), (first_run + runs - 1, 1))
            return np.hstack([self._sample(configurations, *part) for part in parts])
        # A copy, because samplers may modify their arguments.
        merits = self._sampler(configurations.copy(), first_run, runs)
        meaning = "a row for each configuration, a column for each run"
        return number_array("the sampler returned", merits, (count, runs), meaning)

    def _recorded(self, configurations: Integers, merits: Floats) -> tuple[Floats, Integers]:
        merits, quarantined = within(self._limits, configurations, merits)
        self._quarantined[configurations] += quarantined
        for configuration, row in zip(configurations, merits, strict=True):
            self._merits[configuration].append(row)
        return merits, quarantined

    def selection(
        self, procedure: _core.Procedure, delta: float, confidence: float, guarantee: Guarantee
    ) -> Selection:
        """Return the selection of a procedure."""
        merits = [np.concatenate([np.empty(0), *rows]) for rows in self._merits]
        alpha = (1 - confidence) / (2 * len(merits))
        bounds = [
            _core.mean_bounds(row, lowest, highest, alpha)
            for row, (lowest, highest) in zip(merits, self._limits.tolist(), strict=True)
        ]
        lower, upper = np.array(bounds).T
        stopped = procedure.next() is not None
        return Selection(
            best=leading(procedure),
            runs=np.array([len(row) for row in merits]),
            mean=np.array([row.mean() if len(row) else math.nan for row in merits]),
            lower=lower,
            upper=upper,
            eliminations=eliminations(procedure),
            survivors=tuple(procedure.survivors.tolist()),
            quarantined=self._quarantined,
            stopped=stopped,
            guarantee=guarantee_text(procedure, delta, confidence, guarantee),
        )


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

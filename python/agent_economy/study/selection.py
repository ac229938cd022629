"""The best of several configurations, with a stated guarantee, for any function of yours.

The procedures themselves are compiled (`crates/select`); here they are driven: what they ask for is
computed, checked and told to them. `drive` is the one loop; a study runs it over its store.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.scenario.validation import check
from agent_economy.study.arguments import Floats, Guarantee, checked_arguments

Integers = NDArray[np.int64]
Sampler = Callable[[Integers, int, int], ArrayLike]
SAMPLER = "a function of configurations, a first run and a number of runs"

LANE = 2**32
"""Run numbers that belong to one seed (and to one configuration, without common random numbers)."""

ROUNDING = 1e-9
"""Part of a configuration's range by which a merit may lie outside it, and is put on its edge."""


@dataclass(frozen=True)
class Elimination:
    """A configuration that is out, by which other, and after how many of its runs."""

    configuration: int
    by: int
    runs: int


@dataclass(frozen=True)
class Selection:
    """The best configuration, and what is known of all.

    Attributes:
        best: Index of the selected configuration.
        runs: Of each configuration; shape (k,).
        mean: Mean merit of each; shape (k,).
        lower: Lower bounds of the true means, shape (k,). All bounds hold together, at any moment,
            with the stated confidence.
        upper: Upper bounds likewise.
        eliminations: Who went out, in that order.
        survivors: Those that can still be the best: only `best`, unless stopped.
        quarantined: Runs of each that gave no finite merit and count as the worst; shape (k,).
        stopped: Whether `max_runs` came first; then nothing is guaranteed.
        guarantee: What is guaranteed, in words.
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
    """Return the best of k configurations by mean merit, as soon as there is proof.

    Args:
        sampler: `sampler(configurations, first_run, runs)` returns the merits of consecutive runs
            of some configurations, shape (len(configurations), runs); higher is better. A merit
            that is not finite is a quarantined run: it counts as the worst there is. The same run
            of a configuration must always give the same merit; run numbers should choose the random
            numbers, the same for all configurations, so that differences are less noisy.
        k: How many configurations, 1 to 100,000; they are numbered from 0.
        bounds: Least and greatest merit that a run can have: a pair, or an array (k, 2).
        delta: The difference of mean merits worth finding; above 0. Runs grow as 1 / delta^2.
        confidence: Of the guarantee; 0.5 up to below 1. Runs grow as log(1 / (1 - confidence)).
        guarantee: "indifference": if the best is better than every other by delta, it is selected.
            "pgs": whatever the truth, the selected one is within delta of the best (6 to 40% more
            runs).
        common_random_numbers: Whether run r of all configurations may share its random numbers.
            If not, no run number is ever asked of two configurations.
        seed: 0 to 2,147,483,647; its run numbers begin at seed x 2^32 (without common random
            numbers at seed x k x 2^32, and each configuration has 2^32 of its own).
        max_runs: Stop before more than this many runs in all; None for as many as it takes.

    Returns:
        The selection; when `max_runs` stopped it, the leader and no guarantee.

    Raises:
        InputError: If an argument is not allowed, all faults at once; or if the sampler returns
            another shape, or a merit outside of `bounds`.
    """
    check(callable(sampler), "sampler", sampler, SAMPLER)
    limits = checked_arguments(k, bounds, delta, confidence, guarantee, seed, max_runs)
    samples = Samples(sampler, limits, seed if common_random_numbers else seed * k)
    procedure = _core.selection(limits, delta=delta, confidence=confidence, guarantee=guarantee)
    ask = samples.shared if common_random_numbers else samples.apart
    for _ in drive(procedure, ask, max_runs):
        pass
    return samples.selection(procedure, delta, confidence, guarantee)


@dataclass(frozen=True)
class Round:
    """One round of a procedure: what it asked for, and the merits it was told."""

    configurations: Integers
    first_run: int
    runs: int
    merits: Floats


def drive(
    procedure: _core.Procedure,
    ask: Callable[[Integers, int, int], Floats],
    max_runs: int | None = None,
) -> Iterator[Round]:
    """Give a procedure what it asks for until it has selected, or would exceed `max_runs`."""
    total = 0
    while asked := procedure.next():
        configurations, first_run, runs = asked
        total += len(configurations) * runs
        if max_runs is not None and total > max_runs:
            return
        merits = ask(configurations, first_run, runs)
        procedure.record(merits)
        yield Round(configurations, first_run, runs, merits)


class Samples:
    """The merits that a sampler gave, checked."""

    def __init__(self, sampler: Sampler, limits: Floats, lane: int) -> None:
        """Begin with none; `lane` x 2^32 is the first run number."""
        self._sampler = sampler
        self._limits = limits
        self._lane = lane
        self._merits: list[list[Floats]] = [[] for _ in limits]
        self._quarantined = np.zeros(len(limits), dtype=np.int64)

    def shared(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        """Return merits of the same run numbers for all configurations."""
        # A copy: what a sampler does to its arguments is its own.
        given = self._sampler(configurations.copy(), self._lane * LANE + first_run, runs)
        return self._kept(configurations, shaped(given, (len(configurations), runs)))

    def apart(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        """Return merits of run numbers that no two configurations share."""
        rows = [
            self._sampler(np.array([each]), (self._lane + int(each)) * LANE + first_run, runs)
            for each in configurations
        ]
        merits = [shaped(row, (1, runs)) for row in rows]
        return self._kept(configurations, np.concatenate(merits))

    def _kept(self, configurations: Integers, merits: Floats) -> Floats:
        merits, quarantined = within(self._limits, configurations, merits)
        self._quarantined[configurations] += quarantined
        for configuration, row in zip(configurations, merits, strict=True):
            self._merits[configuration].append(row)
        return merits

    def selection(
        self, procedure: _core.Procedure, delta: float, confidence: float, guarantee: Guarantee
    ) -> Selection:
        """Return what came out."""
        merits = [np.concatenate([np.empty(0), *rows]) for rows in self._merits]
        alpha = (1 - confidence) / (2 * len(merits))
        bounds = [
            _core.mean_bounds(row, least, greatest, alpha)
            for row, (least, greatest) in zip(merits, self._limits.tolist(), strict=True)
        ]
        lower, upper = np.array(bounds).T
        stopped = procedure.next() is not None
        return Selection(
            best=procedure.best,
            runs=procedure.runs,
            mean=np.array([row.mean() if len(row) else math.nan for row in merits]),
            lower=lower,
            upper=upper,
            eliminations=tuple(Elimination(*each) for each in procedure.eliminations),
            survivors=tuple(procedure.survivors.tolist()),
            quarantined=self._quarantined,
            stopped=stopped,
            guarantee=in_words(procedure, delta, confidence, guarantee),
        )


def shaped(given: ArrayLike, shape: tuple[int, int]) -> Floats:
    """Return what a sampler gave as an array of a shape.

    Raises:
        InputError: If it is none.
    """
    try:
        merits = np.array(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        message = f"the sampler returned no array of numbers of shape {shape}: {error}"
        raise InputError(message) from None
    if merits.shape != shape:
        message = f"the sampler returned shape {merits.shape}: must be {shape}"
        raise InputError(message)
    return merits


def within(limits: Floats, configurations: Integers, merits: Floats) -> tuple[Floats, Integers]:
    """Return merits within their limits, and how many of each row were quarantined.

    Raises:
        InputError: If a finite merit lies outside of its configuration's limits.
    """
    least, greatest = limits[configurations].T[:, :, np.newaxis]
    bad = ~np.isfinite(merits)
    merits = np.where(bad, least, merits)
    slack = ROUNDING * (greatest - least)
    outside = (merits < least - slack) | (merits > greatest + slack)
    if outside.any():
        row, run = np.argwhere(outside)[0]
        message = (
            f"configuration {configurations[row]} had a merit of {merits[row, run]:.17g}: must be "
            f"from {least[row, 0]:.17g} to {greatest[row, 0]:.17g}, its bounds"
        )
        raise InputError(message)
    return np.clip(merits, least, greatest), bad.sum(axis=1)


def in_words(
    procedure: _core.Procedure, delta: float, confidence: float, guarantee: Guarantee
) -> str:
    """Return what is guaranteed of a selection."""
    if procedure.next() is not None:
        left = len(procedure.survivors)
        return f"Nothing is guaranteed: it was stopped with {left} configurations still in."
    sure = f"with {certainty(confidence)} confidence"
    if guarantee == "pgs":
        return f"The selected configuration is within {delta:g} of the best {sure}."
    return (
        f"If one configuration is better than every other by {delta:g} or more, it is the selected "
        f"one {sure}; nothing is promised about differences smaller than that."
    )


def certainty(share: float) -> str:
    """Return a confidence as people write it: 95%, 99.9%."""
    return f"{100 * share:.15g}%"

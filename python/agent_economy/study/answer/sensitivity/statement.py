"""How much of the variance of the mean merit among configurations each factor explains."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.answer.labels import varied
from agent_economy.study.answer.sensitivity import expansion, grid, means
from agent_economy.study.answer.sensitivity.basis import bases
from agent_economy.study.answer.sensitivity.components import PLACES, Components, shares
from agent_economy.study.answer.sensitivity.factors import Factors, factors
from agent_economy.study.answer.sensitivity.grid import MAX_MISSING
from agent_economy.study.answer.side_statements import NotStatedError
from agent_economy.study.arguments import FIRST_ANALYSIS_RUNS, Floats
from agent_economy.study.paths import counted_kind

MIN_CONFIGURATIONS = 30
"""Minimum number of configurations; a table shows fewer as well."""

MIN_POINTS = 100
"""Minimum number of configurations of a space-filling design."""

RESOLUTION = 1e-12
"""Relative difference up to which means are equal: it may be due to rounding."""

MAX_UNEXPLAINED = 0.2
"""Maximum share of the variance that a polynomial may leave unexplained."""

Groups = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Influence:
    """The influence of one factor.

    Attributes:
        paths: The factor; several if they are one factor, because not all of their combinations are
            compared.
        alone: Share of the variance of the mean merits that it explains alone (Sobol' index of
            first order), with a 95% interval.
        with_interactions: Share that it explains alone and together with other factors (total
            Sobol' index), with a 95% interval; at least `alone`.
    """

    paths: tuple[str, ...]
    alone: Interval
    with_interactions: Interval


@dataclass(frozen=True)
class Sensitivity:
    """The influence of each factor, the strongest first.

    Attributes:
        influences: Influence of each varied factor.
        noise: Share of the variance of the observed means that is noise of their runs, which the
            other shares exclude.
        unexplained: Share of the variance that a polynomial leaves unexplained; None if the shares
            are not those of a polynomial, but exact.
    """

    influences: tuple[Influence, ...]
    noise: float
    unexplained: float | None


def sensitivity(
    evidence: Evidence, design: str = "factorial", where: str | None = None
) -> Sensitivity | None:
    """Return the influence of each factor; None for fewer than two factors or 30 configurations.

    The shares are of the variance of the mean merit among all combinations of values, each counted
    once; the means are those of all runs that the report states, and the noise of their runs is
    subtracted. A race ends the runs of a configuration when they prove that it is worse, which
    hardly moves its mean. Factorial designs have exact shares; others have those of a polynomial.

    Args:
        evidence: The runs of the configurations.
        design: As in `Scenario.design`.
        where: As in `Scenario.where`.

    Raises:
        NotStatedError: If it cannot be stated from these configurations or runs.
    """
    samples = [each for each in evidence.samples if each.is_possible]
    paths = varied([each.values for each in samples])
    if len(paths) < 2 or len(samples) < MIN_CONFIGURATIONS:  # noqa: PLR2004
        return None
    merits = [each.columns["merit"] for each in samples]
    fewest = min(map(len, merits))
    if fewest < FIRST_ANALYSIS_RUNS:
        message = (
            f"with {fewest} runs per configuration, the noise of the means is not known: compute "
            f"{FIRST_ANALYSIS_RUNS} or more (--runs)"
        )
        raise NotStatedError(message)
    rows = means.rows(merits)
    if np.ptp(rows[0]) <= RESOLUTION * np.abs(rows[0]).max():
        return None
    rows -= rows.mean(axis=1, keepdims=True)
    squares = (rows**2).sum(axis=1)
    found = factors([each.values for each in samples], paths)
    is_drawn = design != "factorial"
    is_reduced = where is not None or len(samples) < (1 - MAX_MISSING) * len(evidence.samples)
    # The matrices are too small for several threads.
    with threadpool_limits(1):
        groups, made = decomposed(found, rows, is_drawn=is_drawn, is_reduced=is_reduced)
        named = [tuple(paths[each] for each in group) for group in groups]
        stated = influences(named, made, fewest)
    noise = min(1.0, float(squares[1:].sum() / squares[0]))
    return Sensitivity(
        stated,
        round(noise, PLACES),
        None if made.unexplained is None else round(made.unexplained_share, PLACES),
    )


def decomposed(
    found: Factors, rows: Floats, *, is_drawn: bool, is_reduced: bool
) -> tuple[Groups, Components]:
    """Return which factors are one, and the components of the variance of the means.

    Raises:
        NotStatedError: If factors depend on each other, or a polynomial does not explain enough.
    """
    single = tuple((each,) for each in range(len(found.paths)))
    cells = grid.grid(found)
    for groups in (single, with_one_team(found.paths)):
        joined = cells.joined(groups) if cells else None
        if joined and len(groups) > 1 and joined.is_complete:
            return groups, grid.components(joined, rows)
    if is_reduced or not is_drawn:
        message = (
            "too many combinations of values are not compared (study.where leaves them out, or "
            "they cannot be run), so that factors depend on each other; compare all combinations"
        )
        raise NotStatedError(message)
    if rows.shape[1] < MIN_POINTS:
        message = (
            f"{rows.shape[1]} points of a space-filling design are too few; compare {MIN_POINTS} "
            "or more, or all combinations of values"
        )
        raise NotStatedError(message)
    made = expansion.components(bases(found), rows)
    if made.unexplained_share > MAX_UNEXPLAINED:
        message = (
            f"a polynomial that is fitted to {rows.shape[1]:,} configurations leaves "
            f"{made.unexplained_share:.0%} of the variance unexplained; compare more configurations"
        )
        raise NotStatedError(message)
    return single, made


def with_one_team(paths: Sequence[str]) -> Groups:
    """Return the factors as groups: all numbers of robots and controllers are one factor.

    Factors that depend on each other have no separate shares, but as a group they do.

    Source: Jacques, Lavergne and Devictor (2006), Sensitivity analysis in presence of model
        uncertainty and correlated inputs, Reliability Engineering and System Safety 91.
    """
    team = tuple(index for index, path in enumerate(paths) if counted_kind(path) is not None)
    others = tuple((index,) for index in range(len(paths)) if index not in team)
    return (team, *others) if team else others


def influences(
    paths: Sequence[tuple[str, ...]], components: Components, fewest_runs: int
) -> tuple[Influence, ...]:
    """Return the influence of each factor, the strongest first.

    Raises:
        NotStatedError: If the variance of the means is not above their noise.
    """
    found = shares(components, fewest_runs)
    if found is None:
        message = (
            "the means of the configurations do not differ by more than their noise; compute more "
            "runs (a smaller delta, or --runs)"
        )
        raise NotStatedError(message)
    every = map(Influence, paths, found.alone, found.with_interactions)
    return tuple(sorted(every, key=lambda each: -each.with_interactions.value))

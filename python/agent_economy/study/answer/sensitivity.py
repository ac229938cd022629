"""Sensitivity analysis: how much of the merit's variance among configurations each factor explains.

Every configuration has at least the runs of the first interim analysis, with the same run numbers
for all. The mean merits of these runs are analysed, one per configuration.
"""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.labels import listed, varied
from agent_economy.study.answer.side_statements import NotStatedError
from agent_economy.study.arguments import FIRST_ANALYSIS_RUNS

MIN_CONFIGURATIONS = 30
"""Minimum number of configurations for the analysis."""

RESAMPLES = 100

SEED = 1
"""Seed of the bootstrap; 0 would mean no seed to SALib."""

PLACES = 4
"""Decimals of results; further ones depend on the machine's linear algebra."""


@dataclass(frozen=True)
class Influence:
    """The influence of one factor.

    Attributes:
        path: The factor.
        first_order: Share of the variance of the mean merits that it explains alone.
        first_order_error: Half width of its 95% bootstrap interval.
        total: Borgonovo's delta: all its influence, interactions included; 0 none, 1 all.
        total_error: Half width of its 95% bootstrap interval.
    """

    path: str
    first_order: float
    first_order_error: float
    total: float
    total_error: float


@dataclass(frozen=True)
class Sensitivity:
    """The influence of each factor, the strongest first.

    Attributes:
        influences: Influence of each varied factor.
        noise: Share of the variance that is noise of means of few runs.
    """

    influences: tuple[Influence, ...]
    noise: float


def sensitivity(evidence: Evidence) -> Sensitivity | None:
    """Return the influence of each factor; None for fewer than two factors or 30 configurations.

    Source: Borgonovo (2007), A new uncertainty importance measure, Reliability Engineering and
        System Safety 92; Plischke, Borgonovo and Smith (2013) for given data; as in SALib.

    Raises:
        NotStatedError: If it is not defined for these configurations.
    """
    samples = [each for each in evidence.samples if each.is_possible]
    paths = varied([each.values for each in samples])
    firsts = np.array([each.columns["merit"][:FIRST_ANALYSIS_RUNS] for each in samples])
    means = firsts.mean(axis=1)
    if len(paths) < 2 or len(means) < MIN_CONFIGURATIONS or np.ptp(means) == 0:  # noqa: PLR2004
        return None
    # The common part of a run shifts all means equally; only the rest is noise between them.
    own = firsts - firsts.mean(axis=0)
    noise = own.var(axis=1, ddof=1).mean() / firsts.shape[1] / means.var(ddof=1)
    return Sensitivity(influences(samples, paths, means), float(min(noise, 1.0)))


def influences(
    samples: Sequence[Sample], paths: Sequence[str], means: NDArray[np.float64]
) -> tuple[Influence, ...]:
    """Return SALib's results for each factor, the strongest first.

    Raises:
        NotStatedError: If SALib has none for a factor.
    """
    # SALib imports pandas and matplotlib, which takes a second.
    from SALib.analyze import delta  # noqa: PLC0415
    from threadpoolctl import threadpool_limits  # noqa: PLC0415

    points = np.column_stack([codes(samples, path) for path in paths])
    problem = {
        "num_vars": len(paths),
        # SALib refuses some endings of names.
        "names": [f"x{number}" for number in range(len(paths))],
        "bounds": [[column.min(), column.max()] for column in points.T],
    }
    # Its matrices are too small for several threads.
    with contained(), threadpool_limits(1):
        found = delta.analyze(problem, points, means, num_resamples=RESAMPLES, seed=SEED)
    named = ("S1", "S1_conf", "delta_balanced", "delta_balanced_conf")
    rows = np.array([found[name] for name in named]).T
    lacking = [path for path, row in zip(paths, rows, strict=True) if not np.isfinite(row).all()]
    if lacking:
        message = (
            f"{len(means)} configurations are too few to be grouped by {listed(lacking)}; compare "
            "more values"
        )
        raise NotStatedError(message)
    every = [
        Influence(path, *(round(number, PLACES) for number in row))
        for path, row in zip(paths, rows.tolist(), strict=True)
    ]
    return tuple(sorted(every, key=lambda each: -each.total))


def codes(samples: Sequence[Sample], path: str) -> NDArray[np.float64]:
    """Return a factor's values as numbers; names by their order of appearance."""
    values = [each.values[path] for each in samples]
    if any(isinstance(value, str) for value in values):
        places = {value: place for place, value in enumerate(dict.fromkeys(values))}
        return np.array([places[value] for value in values], dtype=np.float64)
    return np.array(values, dtype=np.float64)


@contextmanager
def contained() -> Iterator[None]:
    """Undo the global side effects of SALib's analysis.

    It seeds numpy's global generator, and warns of small samples in a format that it sets for the
    whole process; the errors that it returns contain the same information.
    """
    state, formatter = np.random.get_state(), warnings.formatwarning  # noqa: NPY002
    try:
        with warnings.catch_warnings(record=True):
            yield
    finally:
        np.random.set_state(state)  # noqa: NPY002
        warnings.formatwarning = formatter

"""Checks of the arguments of a selection: all errors of a call in one exception."""

import math
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.plain import NotPlainError, floats
from agent_economy.scenario.validation import errors_unless, is_whole

Guarantee = Literal["indifference", "pgs"]
Floats = NDArray[np.float64]

MAX_CONFIGURATIONS = 100_000
MIN_CONFIDENCE = 0.5
FIRST_ANALYSIS_RUNS = _core.FIRST_ANALYSIS_RUNS
"""Runs of every configuration before the first decision."""


def checked_arguments(  # noqa: PLR0913, PLR0917  (the arguments of select_best)
    k: int,
    bounds: ArrayLike,
    delta: float,
    confidence: float,
    guarantee: str,
    seed: int,
    max_runs: int | None,
) -> Floats:
    """Return the bounds of each configuration, shape (k, 2).

    Raises:
        InputError: If an argument is invalid; it lists all errors.
    """
    whole_k = is_whole(k, 1, MAX_CONFIGURATIONS)
    min_runs = FIRST_ANALYSIS_RUNS * k if whole_k else 1
    limits = limits_of(k, bounds) if whole_k else None
    errors = [
        *errors_unless(whole_k, "k", k, f"a whole number from 1 to {MAX_CONFIGURATIONS}"),
        *question_errors(delta, confidence, guarantee),
        *errors_unless(
            is_whole(seed, 0, 2**31 - 1), "seed", seed, "a whole number from 0 to 2147483647"
        ),
        *errors_unless(
            max_runs is None or is_whole(max_runs, min_runs, 2**62),
            "max_runs",
            max_runs,
            f"None or a whole number of {min_runs} (10 k) or more",
        ),
        *errors_unless(
            not whole_k or limits is not None,
            "bounds",
            bounds,
            f"minimum and maximum merit, finite plain numbers: a pair, or shape ({k}, 2)",
        ),
    ]
    if errors or limits is None:
        raise InputError("\n".join(errors))
    return limits


def question_errors(delta: object, confidence: object, guarantee: object) -> list[str]:
    """Return the errors of a question."""
    names = get_args(Guarantee)
    return [
        *errors_unless(is_between(delta, 0, math.inf), "delta", delta, "a number above 0"),
        *confidence_errors(confidence),
        *errors_unless(
            guarantee in names, "guarantee", guarantee, "one of " + ", ".join(map(repr, names))
        ),
    ]


def confidence_errors(confidence: object) -> list[str]:
    """Return the error of a confidence; for a percentage, it suggests the share."""
    lowest = np.nextafter(MIN_CONFIDENCE, 0)
    allowed = "a number from 0.5 to below 1, such as 0.95"
    if isinstance(confidence, int | float | np.number) and is_between(confidence, 1, 100):
        share = round(float(confidence) / 100, 12)  # 99.9 / 100 is not 0.999
        if is_between(share, lowest, 1):
            allowed += f"; did you mean {share:.12g}?"
    return errors_unless(is_between(confidence, lowest, 1), "confidence", confidence, allowed)


def is_between(given: object, above: float, below: float) -> bool:
    """Return whether something is a number (not a bool) between two others."""
    if not isinstance(given, int | float | np.integer | np.floating) or isinstance(given, bool):
        return False
    try:
        return above < float(given) < below
    except (OverflowError, TypeError):
        return False


def limits_of(k: int, bounds: ArrayLike) -> Floats | None:
    """Return minimum and maximum merit of each configuration, shape (k, 2); None if invalid."""
    try:
        given = floats(bounds)
    except NotPlainError:
        return None
    if given.shape not in {(2,), (k, 2)}:
        return None
    limits = np.broadcast_to(given, (k, 2)).copy()
    finite = np.isfinite(limits).all() and np.isfinite(limits[:, 1] - limits[:, 0]).all()
    return limits if finite and (limits[:, 0] <= limits[:, 1]).all() else None

"""Checks of the arguments of a study."""

from agent_economy._core import InputError
from agent_economy.scenario.validation import check, errors_unless, is_whole
from agent_economy.study.arguments import MIN_CONFIDENCE, question_errors

MAX_RUNS = 10_000_000
"""Maximum fixed number of runs per configuration."""

MAX_SEED = 2**64 - 1


def check_question(
    *, seed: int, delta: float | None, confidence: float | None, guarantee: str, runs: int | None
) -> None:
    """Check the question of a study; None selects the scenario's value.

    Raises:
        InputError: If an argument is invalid; it lists all errors.
    """
    confidence = MIN_CONFIDENCE if confidence is None else confidence
    errors = question_errors(1.0 if delta is None else delta, confidence, guarantee)
    errors += errors_unless(is_whole(seed, 0, MAX_SEED), "seed", seed, f"0 to {MAX_SEED}")
    is_allowed = runs is None or is_whole(runs, 2, MAX_RUNS)
    errors += errors_unless(is_allowed, "runs", runs, f"a whole number from 2 to {MAX_RUNS}")
    raise_all(errors)


def check_max_runs(max_runs: int | None, runs: int | None, min_runs: int) -> None:
    """Check a run budget: it must allow the first round, and excludes a fixed number of runs.

    Raises:
        InputError: If it is invalid.
    """
    if max_runs is None:
        return
    check(runs is None, "max_runs", max_runs, "left out if runs are given")
    allowed = f"a whole number of {min_runs} or more, the runs of the first round"
    check(is_whole(max_runs, min_runs, 2**62), "max_runs", max_runs, allowed)


def raise_all(errors: list[str]) -> None:
    """Raise errors as one.

    Raises:
        InputError: If there are any.
    """
    if errors:
        raise InputError("\n".join(errors))

"""The best of several configurations, with a stated guarantee, for any sampling function."""

from pathlib import Path

from numpy.typing import ArrayLike

from agent_economy.scenario.validation import check, path
from agent_economy.study.arguments import Guarantee, checked_arguments
from agent_economy.study.progress import OnProgress
from agent_economy.study.questions.best import Best
from agent_economy.study.sampling.folder import opened
from agent_economy.study.sampling.plan import SelectionPlan
from agent_economy.study.sampling.race import SelectionRace
from agent_economy.study.sampling.result import Selection
from agent_economy.study.sampling.sampler import SAMPLER, SampledRuns, Sampler


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
    out: str | Path | None = None,
    on_progress: OnProgress | None = None,
) -> Selection:
    """Return the best of k configurations by mean merit, with the fewest runs that are needed.

    Args:
        sampler: `sampler(configurations, first_run, runs)` returns the merits of consecutive runs
            of some configurations, shape (len(configurations), runs), as an array or lists of plain
            numbers; higher is better. A run without a finite merit is quarantined: it counts as the
            worst merit. The same run of a configuration must always have the same merit, however
            the runs are divided among calls; run numbers should determine the random numbers, the
            same for all configurations, to reduce the variance of differences.
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
        out: Folder that keeps the finished runs; it is created if it does not exist. The same call
            continues there after it was stopped or killed, and returns the same selection as one
            that was not; `delta`, `confidence`, `guarantee` and `max_runs` may be others.
            `study.open(out).runs()` reads the runs. None keeps none.
        on_progress: Called with a `Progress` after each round, and about every second during a long
            one.

    With `out` or `on_progress`, the sampler is called for about half a second of runs at a time,
    but for at least one run per processor. Finished runs are stored within about a second, before
    merits at their bounds are clipped, and numbered from 0 whatever the seed is.

    A folder belongs to one sampler: to its name, the source of its module and of what that imports
    and is not installed, and the numbers, strings, flags and None among the arguments of a
    `functools.partial`. What else it captures (other arguments, closures, attributes of an object,
    files) is not compared: use another folder if it changes.

    Returns:
        The selection; if the run budget was reached first, the leader without a guarantee. A
        configuration whose first ten runs are all quarantined is excluded, and never selected.

    Raises:
        InputError: If an argument is invalid (it lists all errors), or if the sampler returns
            another shape, what is not certainly numbers (masked values, units, labels, text,
            complex numbers, None), a merit outside of `bounds`, or no finite merit. If `out`
            contains other runs (it names what differs) or a study, is damaged, in use or cannot be
            written; or if the sampler has no source file, as in an interactive session.
    """
    check(callable(sampler), "sampler", sampler, SAMPLER)
    check(
        on_progress is None or callable(on_progress),
        "on_progress",
        on_progress,
        "a function or None",
    )
    random_numbers = (common_random_numbers, "True or False")
    check(isinstance(common_random_numbers, bool), "common_random_numbers", *random_numbers)
    limits = checked_arguments(k, bounds, delta, confidence, guarantee, seed, max_runs)
    # Numbers of NumPy have fewer digits, and are written otherwise.
    seed, delta, confidence = int(seed), float(delta), float(confidence)
    plan = SelectionPlan(
        SampledRuns(sampler, limits, seed, bool(common_random_numbers)),
        Best(delta, guarantee),
        confidence,
        None if max_runs is None else int(max_runs),
    )
    with opened(plan, None if out is None else path("out", out)) as runs:
        return SelectionRace(plan, runs, on_progress).run()

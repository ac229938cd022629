"""Mean merits with their errors, as rows of a table: the means, then parts of their errors.

A map that is linear in the means (an average over configurations, the fit of a polynomial) applies
to every row alike, so its result has the parts of its own error. Each part is known up to its sign.
"""

from collections.abc import Sequence

import numpy as np

from agent_economy.study.arguments import Floats

GROUPS = 64
"""Parts of the errors: run r belongs to part r modulo this number."""

CHUNK = 1 << 20
"""Number of runs that are copied at a time."""


def rows(merits: Sequence[Floats]) -> Floats:
    """Return the means, and the parts of their errors: shape (1 + parts, configurations).

    Run r has the same random numbers in all configurations, so their errors are correlated, and the
    errors of different runs are independent. A part therefore has the runs of a group of numbers,
    in all configurations: the sum of the products of parts estimates the covariance of two means
    without bias if they have the same number of runs, and nearly so otherwise. What a run adds to
    all configurations cancels in differences of means of the same runs only. A race gives them
    different numbers of runs, and the parts contain what does not cancel.

    Args:
        merits: Those of each configuration, 2 or more runs from run 0.
    """
    table = np.empty((1 + GROUPS, len(merits)))
    runs = np.array([len(each) for each in merits])
    for count in np.unique(runs):
        which = np.flatnonzero(runs == count)
        for some in np.array_split(which, -(-len(which) * count // CHUNK)):
            table[:, some] = of_equal_runs(np.stack([merits[each] for each in some]))
    return table


def of_equal_runs(merits: Floats) -> Floats:
    """Return the rows of configurations with the same number of runs: merits of shape (k, runs)."""
    count = merits.shape[1]
    means = merits.mean(axis=1)
    deviations = np.pad(merits - means[:, None], ((0, 0), (0, -count % GROUPS)))
    sums = deviations.reshape(len(merits), -1, GROUPS).sum(axis=1)
    sizes = np.bincount(np.arange(count) % GROUPS)
    # Deviations are from the mean of the same runs, and so too small.
    unbiased = 1 - (sizes**2).sum() / count**2
    return np.vstack([means, sums.T / (count * np.sqrt(unbiased))])

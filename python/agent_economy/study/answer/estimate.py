"""Classical interval estimates from a fixed number of runs."""

import math

import numpy as np
from numpy.typing import NDArray

from agent_economy.study.answer.evidence import Interval

CONFIDENCE = 0.95


def mean(samples: NDArray[np.float64], confidence: float = CONFIDENCE) -> Interval:
    """Return the mean of samples with Student's t interval.

    Args:
        samples: Shape (n,), n at least 2. The interval assumes that their mean is nearly normal. It
            is too narrow if a few samples cause most of the variance (rare, costly failures), and
            has no width if none of these occurred.
        confidence: Confidence of the two-sided interval.

    Source: Student (1908), The probable error of a mean, Biometrika 6.
    """
    from scipy.special import stdtrit  # noqa: PLC0415  (slow to load)

    value = float(np.mean(samples))
    error = float(np.std(samples, ddof=1)) / math.sqrt(len(samples))
    half_width = error * float(stdtrit(len(samples) - 1, (1 + confidence) / 2))
    return Interval(value, value - half_width, value + half_width)


def share(successes: int, trials: int, confidence: float = CONFIDENCE) -> Interval:
    """Return a share with the exact interval of Clopper and Pearson.

    Args:
        successes: 0 to `trials`.
        trials: At least 1.
        confidence: Minimum coverage of the two-sided interval.

    Source: Clopper and Pearson (1934), The use of confidence or fiducial limits illustrated in the
        case of the binomial, Biometrika 26.
    """
    from scipy.special import betaincinv  # noqa: PLC0415  (slow to load)

    tail = (1 - confidence) / 2
    failures = trials - successes
    low = float(betaincinv(successes, failures + 1, tail)) if successes else 0.0
    high = float(betaincinv(successes + 1, failures, 1 - tail)) if failures else 1.0
    return Interval(successes / trials, low, high)

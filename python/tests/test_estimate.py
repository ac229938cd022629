"""Intervals compared with scipy's, and their coverage."""

import numpy as np
import pytest
from scipy import stats

from agent_economy.study.answer import estimate


@pytest.mark.parametrize(("successes", "trials"), [(0, 10), (1, 10), (5, 10), (10, 10), (3, 4000)])
def test_share_is_the_exact_interval_of_clopper_and_pearson(successes: int, trials: int) -> None:
    given = estimate.share(successes, trials)
    expected = stats.binomtest(successes, trials).proportion_ci(0.95, method="exact")
    assert given.value == successes / trials
    assert (given.low, given.high) == pytest.approx((expected.low, expected.high), abs=1e-12)


def test_no_failure_in_ten_still_allows_three_in_ten() -> None:
    assert estimate.share(0, 10).high == pytest.approx(0.3085, abs=1e-4)


def test_mean_is_students_interval() -> None:
    samples = np.array([120.0, 44, 78, 45, 39, 55, 59, 120, 51, 79])
    given = estimate.mean(samples)
    expected = stats.ttest_1samp(samples, 0).confidence_interval(0.95)
    assert given.value == 69.0
    assert (given.low, given.high) == pytest.approx((expected.low, expected.high))


def test_share_has_at_least_its_nominal_coverage() -> None:
    # 20,000 intervals of a true 1%: the count that cover is at least binomial(20,000, 0.95), so
    # fewer than 18,900 has a probability below 1e-3; the seed is fixed.
    failures = np.random.default_rng(1).binomial(200, 0.01, 20_000)
    intervals = {count: estimate.share(int(count), 200) for count in np.unique(failures)}
    covered = sum(intervals[count].low <= 0.01 <= intervals[count].high for count in failures)
    assert covered > 18_900

"""Conclusions that the runs of a study prove."""

import numpy as np
import pytest

from agent_economy.study.answer.evidence import Evidence, Sample


def sample(values: list[float]) -> Sample:
    """Return the runs of a configuration whose merits lie from -1 to 1."""
    return Sample({}, {"merit": np.array(values)}, {"merit": (-1.0, 1.0)}, quarantined=0)


def test_disjoint_ranges_prove_a_difference_that_few_common_runs_do_not() -> None:
    # Ten common runs do not decide; the many further runs of the first prove that it is better.
    evidence = Evidence((sample([0.9] * 2000), sample([-0.9] * 10)), 0.95)
    first, second = evidence.interval(0, "merit"), evidence.interval(1, "merit")
    assert first.low > second.high
    gain = evidence.difference(0, 1, "merit")
    assert gain.low == pytest.approx(max(gain.low, first.low - second.high))
    assert gain.low <= gain.value <= gain.high
    assert evidence.exceeds(0, 1, "merit")
    assert not evidence.exceeds(1, 0, "merit")


def test_the_evidence_of_the_same_runs_is_equal() -> None:
    assert Evidence((sample([0.5, 0.1]),), 0.95) == Evidence((sample([0.5, 0.1]),), 0.95)
    assert sample([np.nan]) == sample([np.nan])
    assert sample([0.5, 0.1]) != sample([0.5, 0.2])
    assert sample([0.5, 0.1]) != sample([0.5])

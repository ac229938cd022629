"""The progress of a selection for any function."""

import time
from typing import Any

import numpy as np
import pytest

from agent_economy import InputError
from agent_economy.study import Progress, select_best
from agent_economy.study.arguments import Floats
from agent_economy.study.sampling import race
from agent_economy.study.selection import Integers

SHARES = np.array([0.3, 0.5, 0.6, 0.4])


def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return merits of 0 and 1; run r of all configurations shares its uniform number."""
    uniforms = np.random.Generator(np.random.PCG64(7).advance(first_run)).random(runs)
    return (uniforms < SHARES[configurations][:, np.newaxis]).astype(np.float64)


def slow(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return the same merits, each after 30 milliseconds."""
    time.sleep(0.03 * len(configurations) * runs)
    return sample(configurations, first_run, runs)


def test_progress_is_reported_during_a_long_round() -> None:
    seen: list[Progress] = []
    select_best(slow, 4, bounds=(0, 1), delta=0.1, max_runs=40, on_progress=seen.append)
    first = [now for now in seen if now.round == 0]
    assert first
    assert all(0 < now.runs <= 40 and now.survivors == 4 and not now.leaders for now in first)
    assert all(one.seconds > 0.4 for one in first)


def test_progress_names_the_leader_its_mean_and_what_is_left(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(race, "ROUND_S", -1.0)
    seen: list[tuple[Progress, Any, Any]] = []

    def look(now: Progress) -> None:
        seen.append((now, now.estimate_remaining(), now.intervals()))

    found = select_best(sample, 4, bounds=(0, 1), delta=0.05, on_progress=look)
    last, left, ((leader, interval),) = seen[-1]
    assert last.is_over
    assert left == (0, 0)
    assert last.runs == last.computed == found.runs.sum()
    assert (leader.configuration, leader.runs) == (found.best, found.runs[found.best])
    assert leader.merit == pytest.approx(found.mean[found.best])
    assert (interval.low, interval.high) == (found.lower[found.best], found.upper[found.best])
    runs = [now.runs for now, _, _ in seen]
    assert runs == sorted(runs)
    known = [(now, left) for now, left, _ in seen if now.round >= 12 and not now.is_over]
    assert known
    assert all(0 <= low <= high for _, (low, high) in known)
    eliminated = tuple(each for now, _, _ in seen for each in now.eliminated)
    assert eliminated == found.eliminations


@pytest.mark.parametrize("common", [True, False])
def test_a_selection_that_is_followed_is_the_same(common: Any) -> None:
    arguments: dict[str, Any] = {
        "bounds": (0, 1),
        "delta": 0.05,
        "common_random_numbers": common,
    }
    followed = select_best(sample, 4, on_progress=lambda _: None, **arguments)
    assert followed == select_best(sample, 4, **arguments)


def test_the_estimate_stays_within_the_run_budget() -> None:
    def look(now: Progress) -> None:
        left = now.estimate_remaining()
        assert left is None or 0 <= left[0] <= left[1] <= 2000 - now.runs

    select_best(sample, 4, bounds=(0, 1), delta=0.01, max_runs=2000, on_progress=look)


def test_on_progress_that_cannot_be_called_is_refused() -> None:
    with pytest.raises(InputError, match=r"^on_progress = 5: must be a function or None"):
        select_best(sample, 4, bounds=(0, 1), delta=0.1, on_progress=5)  # type: ignore[arg-type]

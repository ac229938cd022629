"""The selection of the best configuration for any function."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy import InputError
from agent_economy.study import Selection, select_best
from agent_economy.study.arguments import Floats
from agent_economy.study.sampling.sampler import LANE, Sampler
from agent_economy.study.selection import Integers


def bernoulli(shares: list[float], seed: int = 0) -> Sampler:
    """Return a sampler of 0 and 1; run r of all configurations shares its uniform number."""

    def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
        uniforms = np.concatenate(
            [np.random.default_rng([seed, first_run + run]).random(1) for run in range(runs)]
        )
        return np.array([uniforms < shares[each] for each in configurations], dtype=np.float64)

    return sample


def fleet(configurations: Integers, first_run: int, runs: int) -> Floats:
    """Return merits of the 40-team problem: 8 or 9 robots are best."""
    uniforms = np.random.default_rng([7, first_run]).random((2, runs))
    robots = configurations[:, np.newaxis] + 1.0
    time_s = 10 + 60 / np.sqrt(robots) - 260 / robots * np.log1p(-uniforms[0])
    failed = (uniforms[1] < 0.25 ** np.minimum(robots, 6)) | (time_s > 120)
    loss: Floats = 0.03 * np.where(failed, 120, time_s) + 0.2 * robots + 5 * failed
    return -loss


FLEET_BOUNDS = np.array([[-0.2 * robots - 8.6, -0.2 * robots] for robots in range(1, 41)])


@pytest.mark.parametrize("guarantee", ["indifference", "pgs"])
def test_the_best_of_forty_teams_takes_a_fifth_of_the_runs_of_equal_allocation(
    guarantee: Any,
) -> None:
    found = select_best(fleet, 40, bounds=FLEET_BOUNDS, delta=0.05, guarantee=guarantee)
    assert found.best in {7, 8}
    assert not found.stopped
    assert found.survivors == (found.best,)
    assert {each.configuration for each in found.eliminations} == set(range(40)) - {found.best}
    assert found.runs.sum() < 12_000
    assert found.runs.max() == found.runs[found.best]
    assert (found.lower <= found.mean).all()
    assert (found.mean <= found.upper).all()


def test_the_same_problem_gives_the_same_selection() -> None:
    one, two = (select_best(fleet, 40, bounds=FLEET_BOUNDS, delta=0.1) for _ in range(2))
    assert one.eliminations == two.eliminations
    assert one.lower.tobytes() == two.lower.tobytes()
    assert one.runs.tobytes() == two.runs.tobytes()


def test_a_higher_confidence_and_a_smaller_delta_take_more_runs() -> None:
    def runs(**changes: float) -> int:
        arguments: dict[str, Any] = {"delta": 0.1, **changes}
        found = select_best(bernoulli([0.4, 0.5, 0.6]), 3, bounds=(0, 1), **arguments)
        assert found.best == 2
        return int(found.runs.sum())

    assert runs() < runs(confidence=0.9999)
    assert runs() < runs(delta=0.01)


def test_no_run_number_is_requested_twice_without_common_random_numbers() -> None:
    requests: list[tuple[int, int]] = []

    def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
        assert len(configurations) == 1
        requests.append((first_run, runs))
        return np.full((1, runs), float(configurations[0]))

    found = select_best(sample, 3, bounds=(0, 2), delta=0.5, common_random_numbers=False, seed=5)
    numbers = [first + run for first, runs in requests for run in range(runs)]
    assert found.best == 2
    assert len(numbers) == len(set(numbers)) == found.runs.sum()
    assert min(numbers) == 15 * LANE


def test_a_seed_selects_other_runs() -> None:
    firsts = set()

    def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
        firsts.add(first_run)
        return np.zeros((len(configurations), runs))

    for seed in (0, 1, 2**31 - 1):
        select_best(sample, 1, bounds=(0, 1), delta=0.5, seed=seed)
    assert firsts == {0, LANE, (2**31 - 1) * LANE}


def test_max_runs_stops_the_selection_without_a_guarantee() -> None:
    found = select_best(fleet, 40, bounds=FLEET_BOUNDS, delta=0.05, max_runs=1000)
    assert found.stopped
    assert 400 <= found.runs.sum() <= 1000
    assert len(found.survivors) > 1
    assert found.guarantee.startswith("No guarantee")


def test_a_run_without_a_finite_merit_counts_as_the_worst_and_is_counted() -> None:
    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        merits: Floats = np.full((len(configurations), runs), 0.5)
        merits[configurations == 1] = np.nan
        merits[configurations == 2, 0] = np.inf
        return merits

    found = select_best(sample, 3, bounds=(0, 1), delta=0.1)
    assert found.best == 0
    assert found.mean[1] == 0
    assert found.quarantined[1] == found.runs[1]
    assert found.quarantined[0] == 0 < found.quarantined[2] < found.runs[2]


@pytest.mark.parametrize("guarantee", ["indifference", "pgs"])
@pytest.mark.parametrize("common", [True, False])
def test_a_configuration_without_a_finite_merit_is_never_selected(
    guarantee: Any,
    common: Any,
) -> None:
    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        merits: Floats = np.full((len(configurations), runs), 0.5)
        merits[configurations == 1] = np.nan
        return merits

    # The worst merit of configuration 1 is above the best of the others.
    found = select_best(
        sample,
        3,
        bounds=[(0, 1), (5, 6), (0, 1)],
        delta=0.1,
        guarantee=guarantee,
        common_random_numbers=common,
    )
    assert found.best in {0, 2}
    assert 1 not in found.survivors
    assert (found.runs[1], found.quarantined[1]) == (10, 10)
    assert all(each.by != 1 for each in found.eliminations)


def test_a_sampler_without_any_finite_merit_selects_nothing() -> None:
    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        return np.full((len(configurations), runs), np.nan)

    with pytest.raises(InputError, match="first 10 runs of every configuration are quarantined"):
        select_best(sample, 3, bounds=(0, 1), delta=0.1)


def test_decisive_bounds_need_the_first_round_only() -> None:
    zeros = bernoulli([0, 0, 0])

    def sample(configurations: Integers, first_run: int, runs: int) -> Floats:
        merits: Floats = np.asarray(zeros(configurations, first_run, runs))
        return merits + 10.0 * configurations[:, np.newaxis]

    bounds = [(0, 1), (10, 11), (20, 21)]
    found = select_best(sample, 3, bounds=bounds, delta=0.5)
    assert found.best == 2
    assert found.runs.tolist() == [10, 10, 10]


@pytest.mark.parametrize("guarantee", ["indifference", "pgs"])
@pytest.mark.parametrize("delta", [0.1, 0.3 - 0.2, 5.0])
def test_the_better_of_two_is_selected_if_bounds_allow_exactly_delta(
    guarantee: Any, delta: float
) -> None:
    found = select_best(
        lambda each, _, runs: np.repeat(0.1 * each[:, np.newaxis], runs, axis=1),
        2,
        bounds=(0, 0.1),
        delta=delta,
        guarantee=guarantee,
    )
    assert found.best == 1


@pytest.mark.parametrize("guarantee", ["indifference", "pgs"])
def test_merits_far_from_zero_are_compared_exactly(guarantee: Any) -> None:
    far = 1e15

    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        return far + np.repeat(0.25 * configurations[:, np.newaxis], runs, axis=1)

    found = select_best(
        sample, 2, bounds=(far, far + 1), delta=0.1, guarantee=guarantee, max_runs=10_000
    )
    assert (found.best, found.stopped) == (1, False)


def test_a_sampler_may_modify_its_arguments() -> None:
    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        merits = np.repeat(0.5 * configurations[:, np.newaxis], runs, axis=1)
        configurations[:] = 0
        return merits

    found = select_best(sample, 3, bounds=(0, 1), delta=0.1)
    assert found.best == 2
    assert found.mean.tolist() == [0, 0.5, 1]


def test_a_lead_far_above_delta_costs_little_more_for_a_tiny_delta() -> None:
    def runs(delta: float) -> int:
        found = select_best(bernoulli([0.5, 0.6]), 2, bounds=(0, 1), delta=delta)
        assert found.best == 1
        return int(found.runs.sum())

    assert runs(1e-6) < 3 * runs(0.02)


def test_with_more_than_a_hundred_configurations_the_best_is_found() -> None:
    shares = [0.3 + 0.4 * (each == 77) for each in range(150)]
    found = select_best(bernoulli(shares), 150, bounds=(0, 1), delta=0.1)
    assert found.best == 77
    assert found.runs.sum() < 15_000


def test_a_selection_among_equals_ends() -> None:
    found = select_best(bernoulli([0.5] * 4), 4, bounds=(0, 1), delta=0.2)
    assert len(found.survivors) == 1


@given(
    merits=st.lists(st.floats(0, 1), min_size=2, max_size=6),
    guarantee=st.sampled_from(["indifference", "pgs"]),
)
def test_without_noise_the_best_is_selected(merits: list[float], guarantee: Any) -> None:
    def sample(configurations: Integers, _: int, runs: int) -> Floats:
        return np.repeat(np.array(merits)[configurations][:, np.newaxis], runs, axis=1)

    found = select_best(sample, len(merits), bounds=(0, 1), delta=0.05, guarantee=guarantee)
    assert merits[found.best] > max(merits) - 0.05


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"k": 0}, "k = 0: must be a whole number from 1 to 100000"),
        ({"k": True}, "k = True: must be a whole number"),
        ({"delta": 0}, "delta = 0: must be a number above 0"),
        ({"delta": float("nan")}, "delta = nan: must be"),
        ({"confidence": 1.0}, "confidence = 1.0: must be a number from 0.5 to below 1"),
        ({"confidence": 95}, "confidence = 95: must be"),
        ({"confidence": np.array([0.9, 0.95])}, "must be a number from 0.5"),
        ({"delta": 10**400}, "must be a number above 0"),
        ({"guarantee": "PCS"}, "guarantee = 'PCS': must be one of 'indifference', 'pgs'"),
        ({"seed": -1}, "seed = -1: must be a whole number from 0 to 2147483647"),
        ({"max_runs": 10}, "max_runs = 10: must be None or a whole number of 20 (10 k) or more"),
        (
            {"bounds": (1, 0)},
            "bounds = (1, 0): must be minimum and maximum merit, finite plain numbers",
        ),
        ({"bounds": (0, np.inf)}, "must be minimum and maximum merit, finite plain numbers"),
        ({"bounds": "wide"}, "bounds = 'wide': must be"),
        ({"bounds": np.zeros((3, 2))}, "a pair, or shape (2, 2)"),
    ],
)
def test_an_invalid_argument_is_named(change: dict[str, Any], expected: str) -> None:
    arguments: dict[str, Any] = {"k": 2, "bounds": (0, 1), "delta": 0.1, **change}
    with pytest.raises(InputError) as error:
        select_best(bernoulli([0.1, 0.9]), **arguments)
    assert expected in str(error.value)


def test_all_invalid_arguments_are_reported() -> None:
    with pytest.raises(InputError) as error:
        select_best(bernoulli([]), -1, bounds=(0, 1), delta=-1, confidence=2, seed=-1)
    assert len(str(error.value).splitlines()) == 4


@pytest.mark.parametrize(
    ("returned", "expected"),
    [
        (
            np.zeros(20),
            "the sampler returned numbers of shape (20,): must be numbers of shape (2, 10), a row",
        ),
        (
            [[0.5] * 10, [0.5]],
            "the sampler returned list with parts of shapes (1,) and (10,): must be",
        ),
        (np.full((2, 10), 1.5), "configuration 0 had a merit of 1.5: must be from 0 to 1"),
    ],
)
def test_an_invalid_result_of_the_sampler_is_an_error(returned: Floats, expected: str) -> None:
    with pytest.raises(InputError) as error:
        select_best(lambda *_: returned, 2, bounds=(0, 1), delta=0.1)
    assert expected in str(error.value)


def test_exceptions_of_the_sampler_are_propagated() -> None:
    def sample(*_: object) -> Floats:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        select_best(sample, 2, bounds=(0, 1), delta=0.1)


def test_selections_are_equal_if_all_their_values_are() -> None:
    def found(seed: int = 0, delta: float = 0.1) -> Selection:
        return select_best(bernoulli([0.2, 0.5], seed), 2, bounds=(0, 1), delta=delta)

    assert found() == found()
    assert found() != found(seed=1)
    assert found() != found(delta=0.2)
    assert found() != object()
    # Configurations without runs have no mean.
    stopped = [
        select_best(bernoulli([0.5]), 1, bounds=(0, 1), delta=1, max_runs=10) for _ in range(2)
    ]
    assert stopped[0] == stopped[1]

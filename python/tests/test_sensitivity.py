"""Sensitivity: shares of the variance of the mean merit, on functions whose shares are known."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from typing import Any

import in_memory_study
import numpy as np
import pytest
from known_shares import (
    GRIDS,
    KNOWN,
    Function,
    Shares,
    categorical,
    enumerated,
    interaction,
    levels,
)

from agent_economy.scenario import Factor
from agent_economy.study import design
from agent_economy.study.answer.evidence import Evidence, Interval, Sample
from agent_economy.study.answer.sensitivity import Sensitivity, sensitivity
from agent_economy.study.answer.side_statements import NotStatedError, SideStatements
from agent_economy.study.arguments import Floats

RESOLUTION = 1e-4
"""Shares have four decimals."""

ROVERS, DRONES, SPEED = "robots.rover.count", "robots.drone.count", "robots.drone.speed_m_s"


def points(function: Function, axes: list[Sequence[Any]]) -> tuple[list[dict[str, Any]], Floats]:
    """Return the configurations of a grid, and the value of a function in each."""
    cells = list(product(*axes))
    named = [{f"x{place}": value for place, value in enumerate(cell)} for cell in cells]
    return named, np.array([function(*cell) for cell in cells])


def evidence(
    configurations: Sequence[dict[str, Any]], merits: Sequence[Floats], quarantined: int = 0
) -> Evidence:
    """Return runs as evidence; all runs of the last configurations may be quarantined."""
    possible = len(merits) - quarantined
    return Evidence(
        tuple(
            Sample(values, {"merit": runs}, {}, 0 if index < possible else len(runs))
            for index, (values, runs) in enumerate(zip(configurations, merits, strict=True))
        ),
        0.95,
    )


def exact(configurations: Sequence[dict[str, Any]], values: Floats) -> Evidence:
    """Return ten runs without noise."""
    return evidence(configurations, [np.full(10, value) for value in values])


def noisy(values: Floats, runs: Sequence[int], noise: float, rng: np.random.Generator) -> list[Any]:
    """Return runs with noise, half of whose variance run r has in common in all configurations.

    Args:
        values: The true means.
        runs: The number of runs per configuration.
        noise: Standard deviation of a run's noise, relative to that of the values.
        rng: Random numbers.
    """
    size = noise * math.sqrt(0.5) * float(values.std())
    common = size * rng.standard_normal(max(runs))
    return [
        value + common[:count] + size * rng.standard_normal(count)
        for value, count in zip(values, runs, strict=True)
    ]


def stated(evidence: Evidence, name: str = "factorial") -> Sensitivity:
    """Return a statement that can be made."""
    found = sensitivity(evidence, name)
    assert found is not None
    return found


def intervals(found: Sensitivity) -> list[tuple[Interval, Interval]]:
    """Return the shares of each factor, in the order of their names."""
    ordered = sorted(found.influences, key=lambda each: each.paths)
    return [(each.alone, each.with_interactions) for each in ordered]


def values(found: Sensitivity) -> Floats:
    """Return the shares of each factor alone and with interactions: (2, factors)."""
    return np.array([[each.value for each in pair] for pair in intervals(found)]).T


def covers(interval: Interval, share: float) -> bool:
    """Return whether an interval contains a share, to its decimals."""
    return interval.low - RESOLUTION <= share <= interval.high + RESOLUTION


@pytest.mark.parametrize("name", GRIDS)
def test_shares_of_a_grid_are_those_of_the_definition(name: str) -> None:
    function, axes = GRIDS[name]
    found = stated(exact(*points(function, axes)))
    assert values(found) == pytest.approx(np.array(enumerated(function, axes)), abs=RESOLUTION)
    assert found.noise == 0
    assert found.unexplained is None


def test_a_pure_interaction_explains_nothing_alone_and_all_together() -> None:
    found = stated(exact(*points(*GRIDS["interaction"])))
    assert values(found).tolist() == [[0, 0], [1, 1]]


def test_an_additive_merit_has_no_interactions() -> None:
    found = values(stated(exact(*points(*GRIDS["additive"]))))
    assert found[0].tolist() == found[1].tolist()
    assert found[0].sum() == pytest.approx(1, abs=RESOLUTION)


def space_filling(function: Function, count: int, name: str, seed: int) -> tuple[Any, Floats]:
    """Return the points of a design over [-1, 1], and the value of a function in each."""
    factors = [Factor(f"x{place}", (), (-1.0, 1.0)) for place in range(count)]
    drawn = design.points(factors, name, seed)
    return drawn, np.array([function(*each.values()) for each in drawn])


@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize(("drawn", "tolerance"), [("sobol:256", 0.025), ("lhs:500", 0.02)])
def test_shares_of_space_filling_points_are_the_known_ones(
    name: str, drawn: str, tolerance: float
) -> None:
    function, count, known = KNOWN[name]
    found = stated(exact(*space_filling(function, count, drawn, 5)), drawn)
    assert values(found) == pytest.approx(np.array(known), abs=tolerance)
    assert found.unexplained is not None
    assert found.unexplained < tolerance
    for place, pair in enumerate(intervals(found)):
        assert all(covers(each, known[share][place]) for share, each in enumerate(pair))


def test_names_and_numbers_of_space_filling_points_have_the_known_shares() -> None:
    factors = [Factor("x0", tuple("badc")), Factor("x1", (), (-1.0, 1.0))]
    drawn = design.points(factors, "lhs:300", 4)
    merits = np.array([categorical(str(each["x0"]), float(each["x1"])) for each in drawn])
    found = stated(exact(drawn, merits), "lhs:300")
    # The heights and slopes of the four lines, each with a quarter of the points.
    heights, slopes = np.array([1, 0.5, 0, -2]), np.array([3, 1, 1, 1]) / 2
    alone, joint = [heights.var(), slopes.mean() ** 2 / 3], slopes.var() / 3
    known = np.array([alone, np.array(alone) + joint]) / (sum(alone) + joint)
    assert values(found) == pytest.approx(known, abs=0.01)


@pytest.mark.parametrize("name", ["factorial", "lhs:200"])
def test_names_are_categories_without_an_order(name: str) -> None:
    side = Factor("x1", (), (-1.0, 1.0)) if ":" in name else Factor("x1", tuple(levels(9)))
    drawn = design.points([Factor("x0", tuple("badc")), side], name, 4)
    rng = np.random.default_rng(3)
    merits = np.array([categorical(str(each["x0"]), float(each["x1"])) for each in drawn])
    runs = noisy(merits, ten(rng, len(merits)), 1, rng)
    other = {"a": "zero", "b": "y", "c": "1", "d": "none"}
    renamed = [{**each, "x0": other[str(each["x0"])]} for each in drawn]
    assert stated(evidence(renamed, runs), name) == stated(evidence(drawn, runs), name)


@pytest.mark.parametrize("name", GRIDS)
def test_the_order_of_the_configurations_does_not_matter(name: str) -> None:
    configurations, merits = points(*GRIDS[name])
    order = np.random.default_rng(3).permutation(len(merits))
    shuffled = exact([configurations[each] for each in order], merits[order])
    assert stated(shuffled) == stated(exact(configurations, merits))


def replications(
    function: Function, axes: list[Sequence[Any]], runs: Callable[..., Any], noise: float
) -> list[Sensitivity]:
    """Return the statements of 100 studies of the same configurations with other noise."""
    configurations, merits = points(function, axes)
    found = []
    for replication in range(100):
        rng = np.random.default_rng([6, replication])
        data = noisy(merits, runs(rng, len(merits)), noise, rng)
        found.append(stated(evidence(configurations, data)))
    return found


def ten(rng: np.random.Generator, count: int) -> list[int]:
    """Return ten runs per configuration."""
    del rng
    return [10] * count


def unequal(rng: np.random.Generator, count: int) -> list[int]:
    """Return numbers of runs as a race ends with: few of most, many of some."""
    counts = rng.choice([10, 13, 21, 46, 200], count, p=[0.4, 0.2, 0.2, 0.1, 0.1])
    return [int(each) for each in counts]


NOISE = [(0.5, ten), (2, ten), (1.5, unequal)]


@pytest.mark.parametrize(("noise", "runs"), NOISE)
@pytest.mark.parametrize("name", ["g-function", "categorical"])
def test_noise_of_the_runs_is_not_variance_of_factors_and_intervals_cover_the_true_shares(
    name: str, noise: float, runs: Callable[..., Any]
) -> None:
    # Of 100 intervals of 95%, more than 13 miss with a probability of 0.05% (binomial), and the
    # mean of an estimate differs by more than 4 standard errors with one of 0.006%. There are 30 of
    # each; the seeds are fixed. As no share is negative, small ones are a little too large.
    function, axes = GRIDS[name]
    known = np.array(enumerated(function, axes))
    found = replications(function, axes, runs, noise)
    estimates = np.array([values(each) for each in found])
    errors = np.abs(estimates.mean(axis=0) - known)
    assert (errors <= 4 * estimates.std(axis=0, ddof=1) / 10 + 0.01).all()
    for place, share in np.ndindex(known.T.shape):
        every = [intervals(each)[place][share] for each in found]
        assert sum(not covers(each, float(known[share, place])) for each in every) <= 13


@pytest.mark.parametrize("name", GRIDS)
def test_no_share_is_smaller_with_interactions_than_alone(name: str) -> None:
    configurations, merits = points(*GRIDS[name])
    for seed, noise in product(range(4), (0.5, 2, 5)):
        rng = np.random.default_rng([7, seed])
        data = noisy(merits, unequal(rng, len(merits)), noise, rng)
        try:
            found = stated(evidence(configurations, data))
        except NotStatedError:
            continue
        for alone, together in intervals(found):
            assert 0 <= alone.low <= alone.value <= alone.high <= 1
            assert 0 <= together.low <= together.value <= together.high <= 1
            assert alone.value <= together.value
            assert alone.low <= together.low
            assert alone.high <= together.high
        assert values(found)[0].sum() <= 1 + RESOLUTION * len(found.influences)


@pytest.mark.parametrize("name", ["g-function", "additive"])
def test_intervals_of_space_filling_points_cover_the_known_shares(name: str) -> None:
    # Of 40 intervals of 95%, more than 8 miss with a probability of 0.02% (binomial). There are 12;
    # the seeds are fixed.
    function, count, known = KNOWN[name]
    found = []
    for seed in range(40):
        drawn, merits = space_filling(function, count, "lhs:150", seed)
        rng = np.random.default_rng([8, seed])
        data = noisy(merits, unequal(rng, len(merits)), 1, rng)
        found.append(intervals(stated(evidence(drawn, data), "lhs:150")))
    for place, share in np.ndindex(count, 2):
        every = [each[place][share] for each in found]
        assert sum(not covers(each, known[share][place]) for each in every) <= 8


def synthetic_shares(grid: Sequence[in_memory_study.Values]) -> Shares:
    """Return the shares of the synthetic study, from twenty thousand runs per team."""
    means = {}
    for each in grid:
        columns = in_memory_study.synthetic(each, 0, 20_000)
        means[tuple(each.values())] = float(in_memory_study.merit(columns).mean())
    mixes, teams = ([*dict.fromkeys(side)] for side in zip(*means, strict=True))
    return enumerated(lambda *cell: means[cell], [mixes, teams])


def test_shares_of_a_race_are_those_of_many_runs_of_all_configurations() -> None:
    # A race ends the runs at a number that depends on them, and on the configuration. Of 40
    # intervals of 95%, more than 8 miss with a probability of 0.02%; the seeds are fixed.
    grid: list[in_memory_study.Values] = [
        {"mix": 8 * mix, ROVERS: robots} for mix, robots in product(range(4), range(1, 11))
    ]
    known = np.array(synthetic_shares(grid))
    found = []
    for seed in range(40):

        def simulator(values: Any, first_run: int, runs: int, seed: int = seed) -> Any:
            return in_memory_study.synthetic(values, first_run + 100_000 * seed, runs)

        answer, _ = in_memory_study.study(grid, simulator, delta=0.3)
        assert answer.sensitivity is not None
        found.append(answer.sensitivity)
    estimates = np.array([values(each) for each in found])
    assert estimates.mean(axis=0) == pytest.approx(known, abs=0.03)
    assert (estimates[:, 0] <= estimates[:, 1]).all()
    for place, share in np.ndindex(2, 2):
        every = [intervals(each)[place][share] for each in found]
        assert sum(not covers(each, float(known[share, place])) for each in every) <= 8


@pytest.mark.parametrize("name", ["factorial", "lhs:400"])
def test_a_factor_of_an_absent_kind_has_its_effect_where_the_kind_is_present(name: str) -> None:
    speed = Factor(SPEED, (), (1.0, 4.0)) if ":" in name else Factor(SPEED, (1, 2, 4))
    factors = [Factor(ROVERS, (1, 2, 3, 4, 5)), Factor(DRONES, (0, 1, 2)), speed]

    def merit(rovers: Any, drones: Any, speed: Any) -> float:
        return float(rovers**0.5 + drones * speed / 2)

    compared = design.points(factors, name)
    found = stated(exact(compared, np.array([merit(*each.values()) for each in compared])), name)
    speeds = speed.values or tuple(np.linspace(1, 4, 100).tolist())
    known = enumerated(merit, [factors[0].values, factors[1].values, speeds])
    assert (found.unexplained is None) == (name == "factorial")
    by_path = {each.paths: each for each in found.influences}
    for place, factor in enumerate(factors):
        each = by_path[factor.path,]
        tolerance = 0.015 if found.unexplained is not None else RESOLUTION
        assert each.alone.value == pytest.approx(known[0][place], abs=tolerance)
        assert each.with_interactions.value == pytest.approx(known[1][place], abs=tolerance)


def teams(most: int) -> tuple[list[dict[str, Any]], Floats]:
    """Return teams of up to a number of robots at three time limits, and their merits."""
    compared = [
        {ROVERS: rovers, DRONES: drones, "time_limit_s": limit_s}
        for rovers, drones, limit_s in product(range(6), range(6), (60, 120, 240))
        if 0 < rovers + drones <= most
    ]
    merits = [
        -0.02 * each[ROVERS] - (60 + each["time_limit_s"]) / (each[ROVERS] + each[DRONES] + 0.5)
        for each in compared
    ]
    return compared, np.array(merits)


def test_numbers_of_robots_are_one_factor_if_their_combinations_are_restricted() -> None:
    compared, merits = teams(most=6)
    found = sensitivity(exact(compared, merits), "factorial", "rover + drone <= 6")
    assert found is not None
    table = merits.reshape(-1, 3)
    alone = {
        (ROVERS, DRONES): table.mean(axis=1).var() / table.var(),
        ("time_limit_s",): table.mean(axis=0).var() / table.var(),
    }
    assert {each.paths for each in found.influences} == alone.keys()
    for each in found.influences:
        assert each.alone.value == pytest.approx(alone[each.paths], abs=RESOLUTION)


def test_a_missing_combination_does_not_make_factors_one() -> None:
    compared, merits = teams(most=10)
    assert len(compared) == 105
    paths = {each.paths for each in stated(exact(compared, merits)).influences}
    assert paths == {(ROVERS,), (DRONES,), ("time_limit_s",)}


def test_restricted_teams_without_another_factor_have_no_shares() -> None:
    compared, merits = teams(most=8)
    rows = [row for row, each in enumerate(compared) if each["time_limit_s"] == 60]
    only = [{path: compared[row][path] for path in (ROVERS, DRONES)} for row in rows]
    with pytest.raises(NotStatedError, match="factors depend on each other"):
        sensitivity(exact(only, merits[rows]), "factorial", "rover + drone <= 8")


@pytest.mark.parametrize("where", [None, "rover <= 3"])
def test_space_filling_points_of_which_some_are_missing_have_no_shares(where: str | None) -> None:
    drawn, merits = space_filling(interaction, 2, "lhs:200", 1)
    given = evidence(drawn, [np.full(10, each) for each in merits], quarantined=0 if where else 20)
    with pytest.raises(NotStatedError, match="factors depend on each other"):
        sensitivity(given, "lhs:200", where)


def test_too_few_space_filling_points_have_no_shares() -> None:
    given = exact(*space_filling(interaction, 2, "lhs:64", 1))
    with pytest.raises(NotStatedError, match="64 points of a space-filling design are too few"):
        sensitivity(given, "lhs:64")


def test_a_merit_that_no_polynomial_explains_has_no_shares() -> None:
    drawn, merits = space_filling(interaction, 2, "lhs:200", 1)
    wild = np.random.default_rng(2).permutation(merits)
    with pytest.raises(NotStatedError, match="leaves .*% of the variance unexplained"):
        sensitivity(exact(drawn, wild), "lhs:200")


def test_means_that_differ_by_noise_only_have_no_shares() -> None:
    # Of 20 studies without a difference, one in 40 may be stated: more than 4 with one of 10,000.
    configurations, merits = points(*GRIDS["additive"])
    rng = np.random.default_rng(5)
    statements = 0
    for _ in range(20):
        given = evidence(configurations, [rng.standard_normal(10) for _ in merits])
        side = SideStatements()
        statements += side.make("sensitivity", partial(sensitivity, given)) is not None
        assert all("not differ by more than" in each.reason for each in side.omissions)
    assert statements <= 4


def test_fewer_than_ten_runs_do_not_show_their_noise() -> None:
    configurations, merits = points(*GRIDS["additive"])
    given = evidence(configurations, [merit + np.arange(9.0) for merit in merits])
    with pytest.raises(NotStatedError, match="with 9 runs per configuration"):
        sensitivity(given)


def test_few_configurations_or_factors_or_equal_merits_have_no_statement() -> None:
    configurations, merits = points(*GRIDS["additive"])
    one = [{"x0": each["x0"], "x1": 0, "x2": 0} for each in configurations]
    assert sensitivity(exact(configurations[:29], merits[:29])) is None
    assert sensitivity(exact(one, merits)) is None
    assert sensitivity(exact(configurations, np.full(len(merits), 0.1))) is None


@pytest.mark.parametrize("rows", range(1, 13))
def test_the_shares_of_every_grid_of_two_factors_are_stated(rows: int) -> None:
    rng = np.random.default_rng(rows)
    for columns in range(1, 13):
        sides: list[Sequence[Any]] = [range(rows), range(columns)]
        configurations, merits = points(lambda one, two: one + two / 2, sides)
        found = sensitivity(evidence(configurations, noisy(merits, ten(rng, len(merits)), 1, rng)))
        assert (found is not None) == (rows > 1 < columns and rows * columns >= 30)

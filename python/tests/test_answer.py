"""Answers: verdicts, dominance, saturation and predicted efforts."""

from collections.abc import Mapping
from dataclasses import replace

import in_memory_study
import numpy as np
import pytest

from agent_economy.study.answer.best import behind_cell
from agent_economy.study.answer.effort import Effort, efforts
from agent_economy.study.answer.evidence import Evidence, Interval, Sample
from agent_economy.study.answer.front import front
from agent_economy.study.answer.labels import label, recommendation
from agent_economy.study.answer.results import Ending, results
from agent_economy.study.answer.saturation import saturations
from agent_economy.study.answer.side_statements import SideStatements
from agent_economy.study.answer.ties import Standing, Verdict, standings
from agent_economy.study.answer.verdict import failures, others

TEAM = "robots.rover.count"
UNIT = (0.0, 1.0)


def sample(
    mean: float, runs: int, values: Mapping[str, float | str] | None = None, **columns: float
) -> Sample:
    """Return runs with merits of 0 or 1 and a given mean; other columns in the same way."""
    rng = np.random.default_rng(round(1e6 * mean) + runs)
    means = {"merit": mean, "time_s": 0.5, "failed": 0.5, "robots": 1.0, **columns}
    shuffled = {
        name: rng.permutation(np.arange(runs) < round(share * runs)).astype(np.float64)
        for name, share in means.items()
    }
    robots = np.full(runs, means["robots"])
    limits = dict.fromkeys(means, UNIT)
    return Sample(values or {}, {**shuffled, "robots": robots}, limits, 0)


def evidence(*samples: Sample) -> Evidence:
    """Return samples as evidence."""
    return Evidence(samples, 0.95)


@pytest.mark.parametrize(
    ("mean", "runs", "delta", "verdict"),
    [
        (0.5, 20_000, 0.1, "tied"),
        (0.2, 2000, 0.1, "worse"),
        (0.5, 50, 0.1, "undecided"),
        (0.4, 400, 0.15, "not better"),
    ],
)
def test_verdicts_follow_from_the_runs(
    mean: float, runs: int, delta: float, verdict: Verdict
) -> None:
    found = standings(evidence(sample(0.5, runs), sample(mean, runs)), 0, delta)
    assert [each.verdict for each in found] == ["best", verdict]


def test_a_false_verdict_is_rarer_than_the_confidence_allows() -> None:
    # Ten equal configurations: any verdict "worse" is false. At most 5% of studies may have one:
    # of 200, more than 20 has a probability below 0.1% (binomial); the seed is fixed.
    rng = np.random.default_rng(8)
    false = 0
    for _ in range(200):
        merits = rng.integers(0, 2, (10, 300)).astype(np.float64)
        same = {"time_s": np.zeros(300), "failed": np.zeros(300), "robots": np.ones(300)}
        limits = dict.fromkeys(("merit", *same), UNIT)
        samples = [Sample({}, {"merit": row, **same}, limits, 0) for row in merits]
        best = int(np.argmax(merits.mean(axis=1)))
        found = standings(evidence(*samples), best, 0.01)
        false += any(each.verdict == "worse" for each in found)
    assert false <= 20


def test_only_a_proved_dominator_dominates() -> None:
    good = sample(0.5, 3000, time_s=0.2, failed=0.1)
    bad = sample(0.5, 3000, time_s=0.6, failed=0.4)
    few = sample(0.5, 12, time_s=0.6, failed=0.4)
    places = front(evidence(good, bad, few))
    assert [place.dominated_by for place in places] == [None, 0, None]


def test_a_cheaper_team_is_not_dominated_by_a_better_one() -> None:
    cheap = sample(0.5, 3000, time_s=0.6, failed=0.4, robots=1.0)
    dear = sample(0.5, 3000, time_s=0.2, failed=0.1, robots=2.0)
    assert [place.dominated_by for place in front(evidence(cheap, dear))] == [None, None]


def teams(means: list[float], runs: int) -> Evidence:
    """Return teams of 1, 2, ... rovers with these mean merits."""
    return evidence(*(sample(mean, runs, {TEAM: size}) for size, mean in enumerate(means, start=1)))


def test_saturation_is_the_size_beyond_which_no_larger_team_gains_delta() -> None:
    (found,) = saturations(teams([0.2, 0.5, 0.8, 0.6, 0.5], 5000), 2, 0.05)
    assert (found.possible, found.proved) == (3, 3)
    assert set(found.gains) == {4, 5}
    assert all(gain.high < 0 for gain in found.gains.values())


def test_saturation_is_undecided_with_few_runs() -> None:
    (found,) = saturations(teams([0.2, 0.5, 0.8, 0.75, 0.5], 60), 2, 0.05)
    assert found.possible <= 3 < found.proved


def test_saturation_holds_other_factors_at_their_selected_values() -> None:
    samples = [
        sample(mean, 5000, {TEAM: size, "mode": mode})
        for mode, means in (("a", [0.2, 0.3]), ("b", [0.8, 0.4]))
        for size, mean in enumerate(means, start=1)
    ]
    (found,) = saturations(evidence(*samples), 2, 0.05)
    assert (found.path, found.proved) == (TEAM, 1)


def test_predicted_efforts_are_within_a_factor_of_three() -> None:
    sizes: list[in_memory_study.Values] = [{TEAM: robots} for robots in range(1, 21)]
    coarse, seen = in_memory_study.study(sizes, in_memory_study.synthetic, delta=0.4)
    for effort in efforts(seen, coarse.best, 0.4):
        taken = in_memory_study.study(sizes, in_memory_study.synthetic, delta=effort.delta)[0].runs
        assert 1 / 3 < effort.runs / taken < 3


@pytest.mark.parametrize("delta", [1e-300, 1e308])
def test_the_effort_of_any_delta_is_finite(delta: float) -> None:
    seen = evidence(sample(0.5, 40, {TEAM: 1}), sample(0.6, 40, {TEAM: 2}))
    assert [effort.delta < delta for effort in efforts(seen, 1, delta)] == [True] * 3


def test_a_side_statement_that_fails_or_is_not_strict_json_is_left_out_with_its_reason() -> None:
    side = SideStatements()
    assert side.make("efforts", lambda: (Effort(0.1, 20),)) == (Effort(0.1, 20),)
    assert side.make("efforts", lambda: (Effort(float("nan"), 20),)) is None
    assert side.make("saturations", lambda: 1 / 0) is None
    first, second = side.omissions
    assert first.statement == "efforts"
    assert "not JSON compliant" in first.reason
    assert (second.statement, second.reason) == (
        "saturations",
        "ZeroDivisionError: division by zero",
    )


def test_dominance_compares_prices_and_not_numbers_of_robots() -> None:
    few = sample(0.5, 3000, time_s=0.2, failed=0.1, robots=1.0)
    many = sample(0.5, 3000, time_s=0.6, failed=0.4, robots=2.0)
    priced = [
        replace(each, columns={**each.columns, "price": np.full(each.runs, price)})
        for each, price in ((few, 900.0), (many, 30.5))
    ]
    assert [place.price for place in front(evidence(*priced))] == [900.0, 30.5]
    assert [place.dominated_by for place in front(evidence(*priced))] == [None, None]
    # Sums of prices are rounded.
    sums = [
        replace(each, columns={**each.columns, "price": np.full(each.runs, price)})
        for each, price in ((few, 0.1 + 0.1 + 0.1), (many, 0.3))
    ]
    assert front(evidence(*sums))[1].dominated_by == 0
    # Without prices, robots count.
    free = [
        replace(each, columns={**each.columns, "price": np.zeros(3000)}) for each in (few, many)
    ]
    assert [place.price for place in front(evidence(*free))] == [1.0, 2.0]
    assert [place.dominated_by for place in front(evidence(*free))] == [None, 0]


def test_a_configuration_that_cannot_be_run_has_no_standing_and_no_part_in_other_statements() -> (
    None
):
    possible = [sample(0.5, 300, {TEAM: size}) for size in (1, 2)]
    impossible = replace(sample(0.0, 10, {TEAM: 3}), quarantined=10)
    seen = evidence(*possible, impossible)
    assert standings(seen, 0, 0.1)[2] == Standing(None, "impossible")
    assert saturations(seen, 0, 0.1)[0].sizes == (1, 2)
    plain = efforts(evidence(*possible), 0, 0.1)
    assert [each.runs for each in efforts(seen, 0, 0.1)] == [
        pytest.approx(each.runs + 10, rel=0.05) for each in plain
    ]
    assert efforts(evidence(impossible, possible[0]), 1, 0.1) == ()


def test_labels_of_configurations_read_naturally() -> None:
    assert label({TEAM: 1}) == "1 rover"
    assert label({TEAM: 4, "contact": "touch"}) == "4 rovers, contact touch"
    assert label({"a.range_m": 1.5, "b.range_m": 2}) == "a.range_m 1.5, b.range_m 2"
    assert (
        recommendation({TEAM: 4, "clock.time_limit_s": 60}) == "Send 4 rovers with time_limit_s 60"
    )
    assert recommendation({"clock.time_limit_s": 60}) == "Choose time_limit_s 60"
    assert recommendation({"robots.rover.is_loud": False}) == "Choose is_loud false"


@pytest.mark.parametrize(
    ("failed", "words"),
    [
        (Interval(0.02, 0.01, 0.04), "about 2 in 100 runs fail (1 to 4)"),
        (Interval(0.0087, 2e-7, 0.12), "about 8.7 in 1,000 runs fail (0 to 120)"),
        (Interval(0.0, 0.0, 0.0004), "none of 300 runs failed (up to 4 in 10,000 may)"),
    ],
)
def test_rare_failures_can_be_read_aloud(failed: Interval, words: str) -> None:
    _, seen = in_memory_study.study([{TEAM: 1}], in_memory_study.synthetic, runs=300)
    ending = Ending(0, (), "", is_guaranteed=False)
    (result,) = results(seen, ending, 0.1)
    assert failures(replace(result, failed=failed)) == words


@pytest.mark.parametrize(
    ("value", "verdict", "words", "cell"),
    [
        (0.03, "undecided", "by 0.03 merit; which is better is not decided", "0.030"),
        (
            -0.0053,
            "undecided",
            "with a mean merit 0.0053 above that of the selected one in their common runs; which "
            "is better is not decided",
            "0.005 ahead",
        ),
        (
            -0.0053,
            "not better",
            "with a mean merit 0.0053 above that of the selected one in their common runs; it is "
            "not better by more than 0.1",
            "0.005 ahead",
        ),
        (
            0.0,
            "undecided",
            "with the same mean merit as that of the selected one in their common runs; which is "
            "better is not decided",
            "0.000",
        ),
        (-0.0001, "tied", "2 rovers does about as well.", "0.000"),
    ],
)
def test_a_configuration_with_a_higher_mean_than_the_selected_one_is_not_behind_it(
    value: float, verdict: Verdict, words: str, cell: str
) -> None:
    seen = evidence(*(sample(0.5, 50, {TEAM: size}) for size in (1, 2)))
    chosen, other = results(seen, Ending(0, (), "", is_guaranteed=False), 0.1)
    behind = Interval(value, -0.2, 0.2)
    other = replace(other, standing=Standing(behind, verdict))
    stated = others(chosen, (chosen, other), 0.1)
    assert stated in (words, f"Next: 2 rovers, {words}.")
    assert behind_cell(behind) == cell

"""Figures of merit: scores, and bounds that hold to the last bit."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agent_economy import InputError, Scenario, study
from agent_economy.scenario.merit import Merit, Term
from agent_economy.study.answer.any_answer import expect_best

numbers = st.floats(-1e9, 1e9)


@st.composite
def scored_columns(
    draw: st.DrawFn,
) -> tuple[Merit, dict[str, tuple[float, float | None]], dict[str, list[float]]]:
    """Return a figure of merit, bounds of its columns and values within these."""
    terms = []
    bounds: dict[str, tuple[float, float | None]] = {}
    columns = {}
    for index in range(draw(st.integers(1, 6))):
        name = f"column {index}"
        least, greatest = sorted((draw(numbers), draw(numbers)))
        is_bounded = draw(st.booleans())
        top = greatest if is_bounded else np.inf
        highest = draw(st.none() | numbers) if is_bounded else draw(numbers)
        weight = draw(st.floats(-1e6, 1e6).filter(lambda weight: weight != 0))
        terms.append(Term(name, name, weight, highest))
        bounds[name] = (least, greatest if is_bounded else None)
        value = st.floats(least, top) | st.sampled_from([least, top])
        columns[name] = draw(st.lists(value, min_size=5, max_size=5))
    return Merit("any", tuple(terms)), bounds, columns


@given(scored_columns())
def test_a_score_is_within_its_bounds_exactly(
    case: tuple[Merit, dict[str, tuple[float, float | None]], dict[str, list[float]]],
) -> None:
    merit, bounds, columns = case
    low, high = merit.bounds(bounds)
    scores = merit.score({name: np.array(values) for name, values in columns.items()})
    assert np.isfinite([low, high]).all()
    assert np.all((low <= scores) & (scores <= high))


def test_the_bounds_are_reached() -> None:
    merit = Merit("m", (Term("time", "time_s", -0.03), Term("found", "found", 2, max=3)))
    assert merit.bounds({"time_s": (0, 120), "found": (0, 4)}) == (-0.03 * 120, 6)


def test_a_column_without_a_bound_gives_a_score_without_one() -> None:
    assert Merit("m", (Term("paints", "paints", -1),)).bounds({"paints": (0, None)}) == (-np.inf, 0)


def test_scores_have_the_shape_of_the_runs_and_a_quarantined_run_has_none() -> None:
    merit = Merit("m", (Term("time", "time_s", -1), Term("paints", "paints", -0.5, max=10)))
    columns = {
        "time_s": np.array([[1, 2], [np.nan, 4]]),
        "paints": np.array([[2, np.inf], [4, np.nan]]),
        "found": np.full((2, 2), np.nan),
    }
    np.testing.assert_array_equal(merit.score(columns), [[-2, -7], [np.nan, np.nan]])


def test_weights_in_a_scenario_are_the_named_figure_of_merit(classic_toml: Path) -> None:
    scenario = Scenario.load(classic_toml)
    terms = scenario.merit.terms
    text = scenario.replace("merit", "time=-0.03,robots=-0.2,failed=-5").merit
    assert text == Merit("time=-0.03,robots=-0.2,failed=-5", terms)
    table = scenario.replace("merit", {"failed": -5, "robots": {"weight": -0.2}, "time": -0.03})
    assert table.merit == text


def test_a_terms_max_is_read_and_shown(classic_toml: Path) -> None:
    capped = {"paints": {"weight": -0.01, "max": 100}}
    merit = Scenario.load(classic_toml).replace("merit", capped).merit
    assert merit == Merit("paints=-0.01 up to 100", (Term("paints", "paints", -0.01, 100),))
    digits = Scenario.load(classic_toml).replace("merit", "time=-0.123456789,found=1e5").merit
    assert digits.name == "time=-0.123456789,found=100000"


def test_all_invalid_weights_are_reported(classic_toml: Path) -> None:
    bad = {"tiem": 1, "failed": float("inf"), "paints": -1}
    with pytest.raises(InputError) as caught:
        Scenario.load(classic_toml).replace("merit", bad)
    lines = str(caught.value).splitlines()
    assert len(lines) == 3
    assert lines[0].endswith("did you mean time?")
    assert lines[1] == "replace: merit.failed = inf: must be a number from -1000000 to 1000000"
    assert "merit.paints = -1: must be a table with a max, such as" in lines[2]


def test_a_study_scores_with_weights_of_any_column(classic_toml: Path, tmp_path: Path) -> None:
    weights = {"collisions": -1, "paints": {"weight": -1, "max": 9}}
    scenario = Scenario.load(classic_toml).replace("merit", weights)
    team = {"robots.wanderer.count": [2, 3]}
    answer = expect_best(study.run(scenario, vary=team, runs=50, out=tmp_path))
    expected = "avg(-collisions - least(coalesce(paints, 9), 9))"
    means = study.open(tmp_path).runs().aggregate(f"configuration, {expected}").fetchall()
    for configuration, mean in means:
        assert answer.results[configuration].merit.value == pytest.approx(mean)
    assert answer.published == ()

"""The report of a study: one page that works offline."""

import re
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import altair as alt
import in_memory_study
import numpy as np
import pytest
import vl_convert
from in_memory_study import WANDERERS

from agent_economy.study import files, report
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.answer.results import Ending
from agent_economy.study.answer.ties import Standing
from agent_economy.study.errors import StudyError
from agent_economy.study.report import charts
from agent_economy.study.report import script as chart_script
from agent_economy.study.report.formatting import MINUS
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.sections import saturation_in_words, sections
from agent_economy.study.selection import Elimination

Study = tuple[Answer, Evidence]
MIX = "mix"
ROVERS = "robots.rover.count"
CONTACTS = ("touch", "within-2", "ahead")


@pytest.fixture(scope="module")
def script() -> str:
    """Return the JavaScript that draws charts."""
    with report.ChartScript() as made:
        return made.text()


@pytest.fixture(scope="module")
def teams() -> Study:
    """Return the 2003 experiment, raced."""
    return in_memory_study.study(
        [{WANDERERS: robots} for robots in range(1, 9)], in_memory_study.classic
    )


@pytest.fixture(scope="module")
def alone() -> Study:
    """Return a study of one configuration."""
    return in_memory_study.study([{}], in_memory_study.classic)


@pytest.fixture(scope="module")
def thousand() -> Study:
    """Return a study of a thousand configurations, with ten runs per configuration."""
    grid = product(range(25), range(1, 41))
    given: list[in_memory_study.Values] = [{MIX: mix, ROVERS: robots} for mix, robots in grid]
    answer, evidence = in_memory_study.study(given, in_memory_study.synthetic, runs=10)
    return answer, evidence


@pytest.fixture(scope="module")
def words() -> Study:
    """Return a full factorial study of a factor with names and a team size."""
    grid = product(CONTACTS, (2, 3, 4))
    given: list[in_memory_study.Values] = [{"contact": name, WANDERERS: n} for name, n in grid]
    return in_memory_study.study(given, in_memory_study.classic, delta=0.3)


@pytest.fixture(params=["teams", "alone", "thousand", "words"])
def any_study(request: pytest.FixtureRequest) -> Study:
    """Return each of the studies."""
    given: Study = request.getfixturevalue(request.param)
    return given


def body(page: str) -> str:
    """Return a page without its scripts, as shown without JavaScript."""
    return re.sub(r"<script>.*?</script>", "", page, flags=re.DOTALL)


def with_first(answer: Answer, **changes: Any) -> Answer:
    """Return an answer with other results of its first configuration."""
    first, *others = answer.results
    return replace(answer, results=(replace(first, **changes), *others))


def test_a_page_is_one_file_that_fetches_nothing(any_study: Study, script: str) -> None:
    page = report.html(*any_study, script)
    assert len(page.encode()) < 1_500_000
    assert not re.search(r"<script |src=|href=|url\(|@import|https?:", body(page))
    assert "default-src 'none'" in page


def test_the_same_answer_gives_the_same_bytes(any_study: Study, script: str) -> None:
    assert report.html(*any_study, script) == report.html(*any_study, script)


def test_the_answer_is_first_then_the_guarantee_and_the_number_of_runs(
    teams: Study, script: str
) -> None:
    answer, _ = teams
    page = body(report.html(*teams, script))
    text = re.sub(r"<[^>]*>", "", page)
    places = [text.index(part) for part in (answer.sentence, answer.guarantee, f"{answer.runs:,}")]
    assert places == sorted(places)
    assert text.index("Figure of merit") > places[-1]


def test_sections_are_in_order_of_importance(teams: Study) -> None:
    assert [section.heading for section in sections(MeritView(*teams))] == [
        "Figure of merit",
        "Failures",
        "Price, time and failures",
        "How many wanderers are enough",
        "Eliminations",
        "Runs for a smaller delta",
        "Times",
        "Williams 2003",
    ]


def test_markup_in_names_and_summaries_stays_text(teams: Study, script: str) -> None:
    nasty = "</script><img src=x onerror=alert(1)>"
    answer, evidence = teams
    scenario = replace(answer.scenario, summary=nasty, name=nasty)
    nasty_answer = replace(with_first(answer, label=nasty), scenario=scenario, sentence=nasty)
    page = report.html(nasty_answer, evidence, script)
    assert "<img" not in body(page)
    assert "<img" not in page.rsplit("const charts = ", 1)[1]


def test_every_chart_is_a_valid_specification_and_can_be_drawn(any_study: Study) -> None:
    for name, chart in charts.specifications(MeritView(*any_study)).items():
        alt.LayerChart.from_dict(chart)
        svg = vl_convert.vegalite_to_svg(chart | {"width": 600})
        assert "<path" in svg, name
        assert "NaN" not in svg, name


def test_every_chart_has_an_element_and_a_table(any_study: Study, script: str) -> None:
    page = body(report.html(*any_study, script))
    made = charts.specifications(MeritView(*any_study))
    assert sorted(re.findall(r'class="chart" id="([^"]+)"', page)) == sorted(made)
    for section in sections(MeritView(*any_study)):
        assert section.tables


def test_a_table_contains_the_data_of_its_chart(teams: Study) -> None:
    drawn = charts.specifications(MeritView(*teams))["merit"]["data"]["values"]
    table = next(sections(MeritView(*teams))).tables[0]
    assert [row.cells[0].text for row in table.rows] == [row["label"] for row in drawn]
    assert [row.cells[1].text for row in table.rows] == [row["verdict"] for row in drawn]
    written = [float(row.cells[2].text.replace(MINUS, "-")) for row in table.rows]
    assert written == pytest.approx([row["value"] for row in drawn], abs=0.0005)


def test_a_single_configuration_has_no_comparisons(alone: Study) -> None:
    assert list(charts.specifications(MeritView(*alone))) == ["times"]
    headings = [section.heading for section in sections(MeritView(*alone))]
    assert "Eliminations" not in headings
    assert "Price, time and failures" not in headings


def test_the_best_fifty_of_a_thousand_configurations_are_shown_with_a_note(
    thousand: Study, script: str
) -> None:
    answer, _ = thousand
    page = body(report.html(*thousand, script))
    assert "50 of 1,000 configurations are shown" in page
    rows = charts.specifications(MeritView(*thousand))["merit"]["data"]["values"]
    best = sorted((result.merit.value for result in answer.results), reverse=True)[:50]
    assert [row["value"] for row in rows] == pytest.approx(best, rel=1e-5)


def test_a_full_grid_of_two_factors_has_a_map_and_other_designs_have_none(
    words: Study, thousand: Study, teams: Study
) -> None:
    assert len(charts.specifications(MeritView(*words))["heat"]["data"]["values"]) == 9
    assert len(charts.specifications(MeritView(*thousand))["heat"]["data"]["values"]) == 1000
    assert "heat" not in charts.specifications(MeritView(*teams))
    answer, evidence = words
    gap = replace(answer, results=answer.results[:-1])
    assert not MeritView(gap, evidence).is_grid


def test_a_single_number_is_an_axis_and_several_factors_are_ranked_names(
    teams: Study, words: Study
) -> None:
    points = charts.specifications(MeritView(*teams))["merit"]
    assert points["layer"][0]["encoding"]["x"]["field"] == "at"
    answer, _ = words
    rows = charts.specifications(MeritView(*words))["merit"]["data"]["values"]
    assert rows[0]["label"] == answer.results[answer.best].label
    assert [row["value"] for row in rows[1:]] == sorted(
        (row["value"] for row in rows[1:]), reverse=True
    )


def test_two_configurations_of_the_same_name_stay_separate(teams: Study) -> None:
    answer, evidence = teams
    twins = tuple(replace(result, label="twin") for result in answer.results[:2])
    twinned = replace(answer, results=(*twins, *answer.results[2:]))
    rows = charts.specifications(MeritView(twinned, evidence))["merit"]["data"]["values"]
    assert len({row["label"] for row in rows}) == 8


def test_quarantined_runs_are_reported_and_counted(teams: Study, script: str) -> None:
    answer, evidence = teams
    assert "quarantined:" not in body(report.html(answer, evidence, script))
    page = body(report.html(with_first(answer, quarantined=3), evidence, script))
    assert "3 runs without a finite merit" in page
    assert "3 of 1 wanderer" in page
    assert "quarantined runs</th>" in page


def test_a_column_that_is_not_finite_is_shown_as_unknown(teams: Study, script: str) -> None:
    answer, evidence = teams
    first, *others = evidence.samples
    times_s = np.full(first.runs, np.nan)
    broken = replace(first, columns={**first.columns, "time_s": times_s})
    evidence = Evidence((broken, *others), evidence.confidence)
    time_s = replace(answer.results[0].time_s, value=np.nan)
    page = report.html(with_first(answer, time_s=time_s), evidence, script)
    assert "unknown" in body(page)
    assert "NaN" not in page.rsplit("const charts = ", 1)[1]


def test_unproved_comparisons_are_called_undecided(script: str) -> None:
    few = in_memory_study.study(
        [{WANDERERS: robots} for robots in (3, 4, 5)], in_memory_study.classic, runs=20
    )
    page = body(report.html(*few, script))
    assert page.count('<td class="words">undecided</td>') == 2
    assert "Undecided between 3 and 5" in page
    assert "No configuration was eliminated" in page


def test_proved_comparisons_are_stated(script: str) -> None:
    # Two teams of the same merit in every run, and one that is always worse.
    answer, evidence = in_memory_study.study(
        [{WANDERERS: robots} for robots in (3, 4, 5)], in_memory_study.classic, runs=4000
    )
    merit, worse = evidence.samples[0].columns["merit"], np.full(4000, -9.0)
    limits = {**evidence.samples[0].limits, "merit": (-10.0, 0.0)}
    samples = tuple(
        replace(sample, columns={**sample.columns, "merit": given}, limits=limits)
        for sample, given in zip(evidence.samples, (merit, merit, worse), strict=True)
    )
    ending = Ending(0, (Elimination(2, 0, 10),), answer.guarantee, is_guaranteed=True)
    proved = in_memory_study.conclude(Evidence(samples, 0.95), ending)
    page = body(report.html(proved, Evidence(samples, 0.95), script))
    assert '<td class="words">tied within delta</td>' in page
    assert '<td class="words">worse</td>' in page
    assert "Decided: 3 are enough" in page
    assert "eliminated after 10 runs" in page


def test_negative_differences_are_explained_where_there_are_some(teams: Study, script: str) -> None:
    answer, evidence = teams
    words = "Where one is negative, the other one has the higher mean there"
    assert words not in body(report.html(answer, evidence, script))
    other = (answer.best + 1) % len(answer.results)
    ahead = Standing(Interval(-0.0053, -0.2, 0.2), "undecided")
    changed = [
        replace(each, standing=ahead) if at == other else each
        for at, each in enumerate(answer.results)
    ]
    answer = replace(answer, results=tuple(changed))
    assert words in body(report.html(answer, evidence, script))


def test_a_largest_team_that_is_best_is_not_called_enough(teams: Study) -> None:
    view = MeritView(*teams)
    beaten = replace(view.saturations[0], proved=8, possible=8)
    assert saturation_in_words(view, beaten).startswith("Not reached")


def test_without_published_results_none_are_shown(teams: Study, script: str) -> None:
    answer, evidence = teams
    scenario = replace(answer.scenario, published=None)
    bare = replace(answer, published=(), scenario=scenario)
    page = body(report.html(bare, evidence, script))
    assert "Williams" not in page
    assert "published" not in charts.specifications(MeritView(bare, evidence))


@pytest.fixture(scope="module")
def mixes() -> Study:
    """Return a study of two factors, with twenty runs per configuration."""
    grid = product(range(4), range(1, 11))
    given: list[in_memory_study.Values] = [{MIX: 8 * mix, ROVERS: robots} for mix, robots in grid]
    return in_memory_study.study(given, in_memory_study.synthetic, runs=20)


def with_sensitivity(found: Study, **changes: Any) -> Study:
    """Return a study with a changed sensitivity."""
    answer, evidence = found
    assert answer.sensitivity is not None
    return replace(answer, sensitivity=replace(answer.sensitivity, **changes)), evidence


def test_shares_of_factors_are_shown_alone_and_with_interactions(mixes: Study, script: str) -> None:
    page = body(report.html(*mixes, script))
    assert "Shares of the variance of the mean merit" in page
    assert "Noise of the runs is" in page
    assert "polynomial" not in page
    rows = charts.specifications(MeritView(*mixes))["sensitivity"]["data"]["values"]
    shares = {(row["label"], row["measure"]): row["value"] for row in rows}
    assert {label for label, _ in shares} == {"mix", "rovers"}
    for label in ("mix", "rovers"):
        assert shares[label, "alone"] <= shares[label, "with interactions"]


def test_shares_of_a_polynomial_are_shown_with_what_it_leaves_unexplained(
    mixes: Study, script: str
) -> None:
    page = body(report.html(*with_sensitivity(mixes, unexplained=0.03), script))
    assert "polynomial in the factors, which leaves 3.0% of the variance unexplained" in page


def test_factors_that_are_one_are_shown_together(mixes: Study, script: str) -> None:
    answer, _ = mixes
    assert answer.sensitivity is not None
    first, *others = answer.sensitivity.influences
    team = replace(first, paths=(ROVERS, "robots.drone.count"))
    page = body(report.html(*with_sensitivity(mixes, influences=(team, *others)), script))
    assert "robots.rover.count, robots.drone.count" in page
    assert "are one factor, the team" in page


@pytest.fixture
def empty_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


def test_the_script_is_bundled_once_by_any_number_of_processes(
    empty_cache: Path, script: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(chart_script, "BUNDLE", f"print({script[:5000]!r}, end='')")
    with report.ChartScript() as first, report.ChartScript() as second:
        assert first.text() == second.text() == script[:5000]
    (cached,) = (empty_cache / "agent-economy").iterdir()
    assert cached.read_text("utf-8") == script[:5000]
    monkeypatch.setattr(chart_script, "BUNDLE", "raise SystemExit(3)")
    with report.ChartScript() as third:
        assert third.text() == script[:5000]


def test_without_a_cache_folder_the_script_is_bundled_each_time(
    empty_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (empty_cache / "agent-economy").touch()
    monkeypatch.setattr(chart_script, "BUNDLE", "print('draw()', end='')")
    for _ in range(2):
        with report.ChartScript() as made:
            assert made.text() == made.text() == "draw()"


@pytest.mark.usefixtures("empty_cache")
def test_a_script_that_cannot_be_bundled_is_an_error_and_noted_in_the_report(
    teams: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(chart_script, "BUNDLE", "raise SystemExit('no memory')")
    with report.ChartScript() as made:
        with pytest.raises(StudyError, match="could not bundle the chart script: no memory"):
            made.text()
        files.write(tmp_path, *teams, made)
    assert "The charts could not be created" in (tmp_path / "report.html").read_text("utf-8")

"""The charts of a report, as Vega-Lite specifications."""

from collections.abc import Iterable
from typing import Any

import altair as alt
import numpy as np

from agent_economy.study.answer import Answer
from agent_economy.study.estimate import Estimate, share
from agent_economy.study.runs import Runs

OURS = "this study"
QUANTILES = {"p5": 0.05, "p25": 0.25, "p50": 0.5, "p75": 0.75, "p95": 0.95}
BLUE, ORANGE = "#1f5fbf", "#d9730d"
HEIGHT = 250
NEAREST_TEAMS = 5

Rows = list[dict[str, Any]]
Chart = alt.LayerChart | alt.FacetChart


def specifications(runs: Runs, answer: Answer) -> dict[str, dict[str, Any]]:
    """Return each chart's Vega-Lite specification, by its name in the report's page."""
    made = {
        "merit": merit_chart(answer),
        "nearest": nearest_chart(answer),
        "times": times_chart(runs, answer),
        "failed": failed_chart(answer),
    }
    return {name: chart.to_dict() for name, chart in made.items()}


def merit_chart(answer: Answer) -> Chart:
    """Return the figure of merit by team size, with intervals, beside the published ones."""
    ours = estimates(OURS, ((team.robots, team.merit) for team in answer.teams))
    theirs = estimates(source(answer), ((team.robots, team.merit) for team in answer.published))
    return with_intervals(ours + theirs, "figure of merit (higher is better)")


def nearest_chart(answer: Answer) -> Chart:
    """Return how far the nearest teams are behind the best, on a scale of their own."""
    behind = [(team.robots, team.behind_best) for team in answer.teams if team.behind_best]
    nearest = sorted(behind, key=lambda pair: pair[1].value)[:NEAREST_TEAMS]
    best = (answer.best, Estimate(0.0, 0.0, 0.0))
    rows = estimates(OURS, [best, *nearest])
    return with_intervals(rows, "merit behind the best (lower is better)")


def failed_chart(answer: Answer) -> Chart:
    """Return the share of failed searches by team size, with exact intervals."""
    ours = estimates(OURS, ((team.robots, team.failed_share) for team in answer.teams))
    published = ((team.robots, share(team.failed, len(team.times_s))) for team in answer.published)
    theirs = estimates(source(answer), published)
    return with_intervals(ours + theirs, "share of searches failed", axis=alt.Axis(format="%"))


def estimates(named: str, pairs: Iterable[tuple[int, Estimate]]) -> Rows:
    """Return a row a team size and estimate, all of one source."""
    return [
        {"robots": robots, "source": named, "value": each.value, "low": each.low, "high": each.high}
        for robots, each in pairs
    ]


def times_chart(runs: Runs, answer: Answer) -> Chart:
    """Return the distribution of times by team size, with each published run as a point."""
    rows: Rows = []
    for robots, outcomes in runs.teams.items():
        quantiles = np.quantile(outcomes.time_s, list(QUANTILES.values()))
        row = dict(zip(QUANTILES, map(float, quantiles), strict=True))
        rows.append({"robots": robots, "source": OURS, **row})
    points: Rows = [
        {"robots": team.robots, "source": source(answer), "time_s": time_s}
        for team in answer.published
        for time_s in team.times_s
    ]
    title = f"time of a search, capped at {answer.scenario.cap_s:g} s (s)"
    base = beside(alt.Chart(data(rows)), sources(rows + points))
    low_high = base.mark_rule(size=2).encode(alt.Y("p5:Q", title=title), y2="p95:Q")
    quartiles = base.mark_bar(size=14, opacity=0.55).encode(alt.Y("p25:Q"), y2="p75:Q")
    median = base.mark_tick(size=20, thickness=3).encode(alt.Y("p50:Q"))
    layers = [low_high, quartiles, median]
    if points:
        circles = beside(alt.Chart(data(points)), sources(rows + points)).mark_point(
            size=28, opacity=0.8
        )
        tooltip = ["source:N", "robots:O", "time_s:Q"]
        layers.append(circles.encode(alt.Y("time_s:Q"), tooltip=tooltip))
    return sized(alt.layer(*layers))


def with_intervals(rows: Rows, title: str, axis: alt.Axis | None = None) -> Chart:
    """Return points with intervals by team size, one colour and shape a source."""
    named = sources(rows)
    base = beside(alt.Chart(data(rows)), named)
    bars = base.mark_errorbar(ticks=True, thickness=2).encode(
        alt.Y("low:Q", title=title), y2="high:Q"
    )
    points = base.mark_point(filled=True, size=60).encode(
        alt.Y("value:Q", title=title, axis=axis or alt.Undefined),
        shape=alt.Shape("source:N", title=None, scale=alt.Scale(domain=named)),
        tooltip=["source:N", "robots:O", "value:Q", "low:Q", "high:Q"],
    )
    return sized(alt.layer(bars, points))


def beside(chart: alt.Chart, named: list[str]) -> alt.Chart:
    """Return a chart by team size, with a place and a colour for each source."""
    color = alt.Scale(domain=named, range=[BLUE, ORANGE])
    place = alt.Scale(domain=named, paddingOuter=1)
    return chart.encode(
        x=alt.X("robots:O", title="robots", axis=alt.Axis(labelAngle=0)),
        xOffset=alt.XOffset("source:N", scale=place),
        color=alt.Color("source:N", title=None, scale=color),
    )


def sources(rows: Rows) -> list[str]:
    """Return the sources of rows, in the order of their first rows."""
    return list(dict.fromkeys(row["source"] for row in rows))


def source(answer: Answer) -> str:
    """Return how charts name the published results."""
    published = answer.scenario.published
    return published.source if published else ""


def data(rows: Rows) -> alt.InlineData:
    """Return rows as inline data."""
    return alt.InlineData(values=rows)


def sized(chart: Chart) -> Chart:
    """Return a chart as wide as the page allows."""
    wide = chart.properties(width="container", height=HEIGHT).configure_view(stroke=None)
    configured: Chart = wide.configure_legend(orient="top")
    return configured

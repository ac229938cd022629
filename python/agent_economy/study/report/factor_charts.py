"""Charts of factors (heat map, gains of larger teams, sensitivity), and of published results."""

from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.answer.ties import VERDICT_TEXT
from agent_economy.study.report.chart_parts import (
    BLUE,
    ORANGE,
    VERDICTS,
    Codes,
    Rows,
    Spec,
    bounds,
    by_name,
    chart,
    coded,
    field,
    heights,
    line_at,
    row_of,
    with_bounds,
)
from agent_economy.study.report.formatting import finite
from agent_economy.study.report.heat_map import heat_map
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.view import factor_name, factor_names

MARKS: Codes = {name: code for name, code in VERDICTS.items() if name != "worse"}
"""The verdicts that mark cells of a heat map; most cells of a finished study are worse."""

MEASURES: Codes = {
    "alone": (BLUE, "circle"),
    "with interactions": (ORANGE, "diamond"),
}
OURS = "this study"


def specifications(view: MeritView) -> dict[str, Spec]:
    """Return the specification of each chart that the answer has data for, by name."""
    made: dict[str, Spec] = {}
    if view.is_grid:
        made["heat"] = heat(view)
    for number, found in enumerate(view.saturations):
        if found.gains:
            made[f"saturation-{number}"] = saturation(view, found)
    if view.answer.sensitivity:
        made["sensitivity"] = sensitivity(view)
    if view.published_axis:
        made["published"] = published(view, view.published_axis)
    return made


def heat(view: MeritView) -> Spec:
    """Return the heat map of the mean merit over two factors, those not decided marked."""
    rows: Rows = [
        {
            **row_of(view, index),
            "value": finite(result.merit.value) if result.is_possible else None,
            "mark": mark_of(view, index),
        }
        for index, result in enumerate(view.answer.results)
    ]
    return heat_map(view, rows, {"title": "mean merit"}, MARKS)


def mark_of(view: MeritView, index: int) -> str | None:
    """Return the verdict that marks a cell of a heat map; None for those that are decided."""
    text = VERDICT_TEXT[view.result(index).standing.verdict]
    return text if text in MARKS else None


def saturation(view: MeritView, found: Saturation) -> Spec:
    """Return the chart of the gains of larger teams, with lines at zero and at delta."""
    rows: Rows = [
        {
            "label": f"{size:,}",
            **bounds(gain),
            "gain": "gain",
        }
        for size, gain in found.gains.items()
    ]
    style = coded("gain", {"gain": (BLUE, "circle")}, rows)
    style = {name: {**channel, "legend": None} for name, channel in style.items()}
    kind = factor_name(found.path)
    title = {"title": f"gain of merit over {found.base:,} {kind}"}
    place = {"y": {**by_name(rows), "title": kind}}
    lines = [line_at("x", 0.0), line_at("x", view.answer.delta, strokeDash=[4, 3], color=ORANGE)]
    return chart([*lines, *with_bounds("x", title, place, style)], rows, heights(rows))


def sensitivity(view: MeritView) -> Spec:
    """Return the chart of the share of the variance of the mean merit that each factor explains."""
    found = view.answer.sensitivity
    rows: Rows = [
        {"label": factor_names(each.paths), "measure": measure, **bounds(share)}
        for each in (found.influences if found else ())
        for measure, share in zip(MEASURES, (each.alone, each.with_interactions), strict=True)
    ]
    place = {"y": by_name(rows), "yOffset": field("measure", "nominal", sort=list(MEASURES))}
    title = {"title": "share of the variance of the mean merit", "axis": {"format": "~%"}}
    layers = with_bounds("x", title, place, coded("measure", MEASURES, rows))
    return chart([line_at("x", 0.0), *layers], rows, {"step": 17})


def published(view: MeritView, path: str) -> Spec:
    """Return the chart of the figures of merit of this study and published ones, by team size."""
    scenario = view.answer.scenario
    theirs = scenario.published.source if scenario.published else ""
    rows: Rows = [
        {
            **published_row(OURS, int(view.result(index).values[path]), view.result(index).merit),
            "configuration": index,
        }
        for index in view.shown
    ]
    rows += [published_row(theirs, each.robots, each.merit) for each in view.answer.published]
    style = coded("source", {OURS: (BLUE, "circle"), theirs: (ORANGE, "diamond")}, rows)
    place = {
        "x": field("at", "ordinal", title=factor_name(path), axis={"labelAngle": 0}),
        "xOffset": field("source", "nominal", scale={"paddingOuter": 1}, sort=[OURS, theirs]),
    }
    title = {"title": "figure of merit (higher is better)", "scale": {"zero": False}}
    return chart(with_bounds("y", title, place, style), rows)


def published_row(source: str, size: int, merit: Interval) -> dict[str, Any]:
    """Return the row of a team's figure of merit from one source."""
    return {
        "label": f"{source}, {size}",
        "at": size,
        "source": source,
        **bounds(merit),
    }

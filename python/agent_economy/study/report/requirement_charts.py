"""The charts of a report about a requirement, as Vega-Lite specifications."""

import math
from typing import Any

import numpy as np

from agent_economy.study.answer.quantiles import observed
from agent_economy.study.report import goal_chart
from agent_economy.study.report.chart_parts import (
    BLUE,
    GREY,
    HEIGHT,
    ORANGE,
    TEAL,
    Codes,
    Rows,
    Spec,
    bounds,
    by_name,
    chart,
    coded,
    field,
    fixed,
    heights,
    line_at,
    row_of,
    with_bounds,
)
from agent_economy.study.report.formatting import finite
from agent_economy.study.report.heat_map import heat_map
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.scale import ValueAxis, scaled

STATUSES: Codes = {
    "selected": (BLUE, "circle"),
    "certified": (TEAL, "square"),
    "open": (ORANGE, "diamond"),
    "may meet": (ORANGE, "triangle-up"),
    "refuted": (GREY, "triangle-down"),
    "not needed": (GREY, "triangle-right"),
}

CONDITION_COLORS = (BLUE, ORANGE, TEAL, GREY, "#9a5ccf", "#c2454f")
"""Colours of conditions, in their order; they repeat if there are more."""

MAX_POINTS = 400
"""Maximum number of points of an empirical distribution in a chart."""


def specifications(view: RequirementView) -> dict[str, Spec]:
    """Return the Vega-Lite specification of each chart that the answer has data for, by name."""
    made = {"share": share(view), "failing": failing(view)}
    if view.is_grid:
        made["heat"] = heat(view)
    if view.compared_distributions:
        made["distribution"] = distribution(view)
    if view.has_prices:
        made["price"] = price(view)
    return made | goal_chart.specifications(view)


def share(view: RequirementView) -> Spec:
    """Return the chart of the share of missions that meet the requirement, by team."""
    rows = [share_row(view, index) for index in view.shown]
    requirement = view.answer.requirement
    spare = requirement.probability + requirement.tolerance
    band = fixed(
        [{"from": requirement.probability, "to": spare}],
        {"type": "rect", "opacity": 0.15, "color": BLUE},
        {"x": field("from"), "x2": {"field": "to"}},
    )
    title = {"title": "share of missions that meet the requirement", "scale": {"zero": False}}
    title["axis"] = {"format": "~%"}
    style = coded("status", STATUSES, rows)
    points = with_bounds("x", title, {"y": by_name(rows)}, style)
    layers = [band, line_at("x", requirement.probability), *points]
    axis = ValueAxis("x", include=(requirement.probability, spare), within=(0.0, 1.0))
    return scaled(chart(layers, rows, heights(rows)), axis, view.answer.contenders)


def share_row(view: RequirementView, index: int) -> dict[str, Any]:
    """Return the row of the share of a team."""
    result = view.result(index)
    met = result.met
    known = bounds(met) if met else {"value": None, "low": None, "high": None}
    return {**row_of(view, index), **known, "status": result.status}


def heat(view: RequirementView) -> Spec:
    """Return the heat map of the share over two factors, with the status of each team."""
    rows: Rows = [
        {
            **row_of(view, index),
            "value": finite(result.met.value) if result.met and result.is_possible else None,
            "mark": result.status,
        }
        for index, result in enumerate(view.answer.results)
    ]
    title = {"title": "share of missions that meet it", "format": "~%"}
    return heat_map(view, rows, title, {**STATUSES, "impossible": (GREY, "cross")})


def failing(view: RequirementView) -> Spec:
    """Return the chart of the share of missions in which each condition does not hold."""
    conditions = [each.text for each in view.answer.requirement.conditions]
    rows: Rows = [
        {
            **row_of(view, index),
            "condition": text,
            "share": finite(part),
        }
        for index in view.shown
        for text, part in zip(conditions, view.result(index).failing, strict=True)
    ]
    repeated = [CONDITION_COLORS[at % len(CONDITION_COLORS)] for at in range(len(conditions))]
    color = field(
        "condition", "nominal", title=None, scale={"domain": conditions, "range": repeated}
    )
    tip = [field("label", "nominal", title=" "), field("condition", "nominal"), field("share")]
    value = field("share", title="share of missions", axis={"format": "~%"}, stack=None)
    encoding = {"y": by_name(rows), "x": value, "color": color, "tooltip": tip}
    encoding["yOffset"] = field("condition", "nominal", sort=conditions)
    return chart([{"mark": "bar", "encoding": encoding}], rows, heights(rows))


def price(view: RequirementView) -> Spec:
    """Return the chart of price and share."""
    rows = [
        {**share_row(view, index), "price": finite(view.result(index).price)}
        for index in view.shown
    ]
    required = view.answer.requirement.probability
    title = {"title": "share of missions that meet the requirement", "scale": {"zero": False}}
    title["axis"] = {"format": "~%"}
    place = {"x": field("price", title="price", scale={"zero": False, "padding": 16})}
    points = with_bounds("y", title, place, coded("status", STATUSES, rows))
    axis = ValueAxis("y", include=(required,), within=(0.0, 1.0))
    made = chart([line_at("y", required), *points], rows, HEIGHT)
    return scaled(made, axis, view.answer.contenders)


def distribution(view: RequirementView) -> Spec:
    """Return the chart of the distribution of the deciding column, for two teams."""
    rows: Rows = []
    condition = view.deciding_condition
    for index in view.compared_distributions:
        rows += distribution_rows(view, index)
    codes: Codes = {
        view.names[index]: (color, "circle")
        for index, color in zip(view.compared_distributions, (BLUE, ORANGE), strict=False)
    }
    style = {"color": coded("label", codes, rows)["color"]}
    x = field("at", title=condition.column, scale={"zero": False})
    share_axis: Spec = {"title": "share of missions up to this", "axis": {"format": "~%"}}
    share_axis["scale"] = {"domain": [0, 1]}
    area = {"x": x, "y": field("low", **share_axis), "y2": {"field": "high"}, **style}
    line = {"x": x, "y": field("value", **share_axis), **style}
    layers: list[Spec] = [
        {"mark": {"type": "area", "interpolate": "step-after", "opacity": 0.15}, "encoding": area},
        {"mark": {"type": "line", "interpolate": "step-after"}, "encoding": line},
        line_at("x", condition.value, strokeDash=[4, 3]),
        line_at("y", view.answer.requirement.probability),
    ]
    return chart(layers, rows, HEIGHT)


def distribution_rows(view: RequirementView, index: int) -> Rows:
    """Return the rows of the empirical distribution of a team, with its band."""
    values = observed(view.evidence.samples[index], view.deciding_condition.column)
    runs, known = len(values), values[np.isfinite(values)]
    if not len(known):
        return []
    width = band_half_width(runs, view.band_alpha)
    picked = np.unique(np.linspace(0, len(known) - 1, MAX_POINTS).astype(int))
    return [
        {
            **row_of(view, index),
            "at": finite(float(known[place])),
            "value": finite(part := float(place + 1) / runs),
            "low": finite(max(0.0, part - width)),
            "high": finite(min(1.0, part + width)),
        }
        for place in picked.tolist()
    ]


def band_half_width(runs: int, alpha: float) -> float:
    """Return the half width of a band around an empirical distribution that is valid at any time.

    Source: Howard and Ramdas (2022), Sequential estimation of quantiles with applications to A/B
        testing and best-arm identification, Bernoulli 28(3), section 1, equation 2.
    """
    return 0.85 * math.sqrt(
        (math.log(math.log(math.e * runs)) + 0.8 * math.log(1612 / alpha)) / runs
    )

"""The charts of a report as Vega-Lite specifications: plain dicts, one function per chart.

Configurations are on the x axis if one number is varied, else on the y axis by name, which leaves
room for names on narrow screens. Every chart works on light and dark backgrounds: its background is
transparent, its colours have medium lightness, and categories also differ in shape.
"""

from typing import Any

import numpy as np

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.ties import VERDICT_TEXT
from agent_economy.study.report import factor_charts, goal_chart
from agent_economy.study.report.chart_parts import (
    BLUE,
    FEW,
    GREY,
    HEIGHT,
    INK,
    ORANGE,
    TEAL,
    VERDICTS,
    Codes,
    Rows,
    Spec,
    axis_of,
    bounds,
    by_name,
    chart,
    coded,
    field,
    fixed,
    heights,
    intervals,
    line_at,
    place_of,
    row_of,
    value_channel,
    with_bounds,
)
from agent_economy.study.report.formatting import finite
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.scale import ValueAxis, scaled

PLACES: Codes = {
    "selected": (BLUE, "circle"),
    "selected, dominated": (BLUE, "cross"),
    "possibly efficient": (TEAL, "square"),
    "dominated": (GREY, "triangle-down"),
}
STATES = {"selected": BLUE, "remaining": TEAL, "eliminated": GREY}
FRONT_HEIGHT = 300
QUANTILES = {"p5": 0.05, "p25": 0.25, "p50": 0.5, "p75": 0.75, "p95": 0.95}


def specifications(view: MeritView) -> dict[str, Spec]:
    """Return the Vega-Lite specification of each chart that the answer has data for, by name."""
    made = {"times": times(view)}
    if view.compares:
        compared = (merit, behind, failed, front, runs)
        made |= {function.__name__: function(view) for function in compared}
    return made | factor_charts.specifications(view) | goal_chart.specifications(view)


def merit(view: MeritView) -> Spec:
    """Return the chart of the figure of merit of each configuration."""
    rows = [judged(view, index, view.result(index).merit) for index in view.shown]
    style = coded("verdict", VERDICTS, rows)
    made = intervals(view, rows, {"title": "figure of merit (higher is better)"}, style)
    return scaled(made, ValueAxis(value_channel(view)), view.answer.contenders)


def failed(view: MeritView) -> Spec:
    """Return the chart of the share of failed runs per configuration."""
    rows = [judged(view, index, view.result(index).failed) for index in view.shown]
    title = {
        "title": "share of runs that failed",
        "axis": {"format": "~%"},
        "scale": {"zero": True},
    }
    made = intervals(view, rows, title, coded("verdict", VERDICTS, rows))
    axis = ValueAxis(value_channel(view), include=(0.0,), within=(0.0, 1.0))
    return scaled(made, axis, view.answer.contenders)


def behind(view: MeritView) -> Spec:
    """Return the chart of differences from the selected one; a band marks delta on both sides."""
    rows = [
        judged(view, index, interval)
        for index in view.nearest
        if (interval := view.result(index).standing.behind)
    ]
    delta = view.answer.delta
    ends = {"x": field("from"), "x2": {"field": "to"}}
    band = fixed(
        [{"from": -delta, "to": delta}], {"type": "rect", "opacity": 0.15, "color": BLUE}, ends
    )
    title = {"title": "difference of merit from the selected one"}
    points = with_bounds("x", title, {"y": by_name(rows)}, coded("verdict", VERDICTS, rows))
    made = chart([band, line_at("x", 0.0), *points], rows, heights(rows))
    return scaled(made, ValueAxis("x", include=(-delta, delta)), view.answer.contenders)


def judged(view: MeritView, index: int, interval: Interval) -> dict[str, Any]:
    """Return the row of a configuration's interval, with its verdict."""
    verdict = verdict_of(view, index)
    return {**place_of(view, index), **bounds(interval), "verdict": verdict}


def verdict_of(view: MeritView, index: int) -> str:
    """Return the verdict on a configuration in words."""
    return VERDICT_TEXT[view.result(index).standing.verdict]


def front(view: MeritView) -> Spec:
    """Return the chart of price, time and failures."""
    # The selected one is drawn last, on top of the others.
    rows = [front_row(view, index) for index in reversed(view.on_front)]
    space: Spec = {"zero": False, "padding": 16}
    name, *unit = view.price_title
    title = f"{name} ({unit[0]})" if unit else name
    price = field("price", title=title, scale=space, axis={"grid": False, "tickMinStep": 1})
    seconds: Spec = {"title": "mean time (s)", "scale": space}
    at = {"x": price, "y": field("value", **seconds)}
    size = field("failed", title="failed", scale={"range": [50, 500], "zero": True})
    symbols = {"symbolFillColor": GREY, "symbolStrokeColor": GREY}
    size["legend"] = {"format": "~%", "tickCount": 3, **symbols}
    tip = [
        field("label", "nominal", title=" "),
        field("price"),
        field("value", title="mean time (s)"),
    ]
    dots = {**at, **coded("place", PLACES, rows), "size": size, "tooltip": [*tip, field("failed")]}
    spans = {"x": price, "y": field("low", **seconds), "y2": {"field": "high"}}
    layers: list[Spec] = [
        {"mark": {"type": "rule", "color": GREY, "opacity": 0.7}, "encoding": spans},
        {"mark": {"type": "point", "filled": True, "opacity": 0.85}, "encoding": dots},
    ]
    return scaled(chart(layers, rows, FRONT_HEIGHT), ValueAxis("y"), view.answer.contenders)


def front_row(view: MeritView, index: int) -> dict[str, Any]:
    """Return the row of a configuration's price, time and failures."""
    result = view.result(index)
    return {
        **row_of(view, index),
        **bounds(result.time_s),
        "price": finite(result.place.price),
        "failed": finite(result.failed.value),
        "place": place_on_front(view, index),
    }


def place_on_front(view: MeritView, index: int) -> str:
    """Return whether a configuration is on the Pareto front, in words."""
    is_efficient = view.result(index).place.dominated_by is None
    if index != view.answer.best:
        return "possibly efficient" if is_efficient else "dominated"
    return "selected" if is_efficient else "selected, dominated"


def runs(view: MeritView) -> Spec:
    """Return the chart of the number of runs per configuration."""
    rows: Rows = [
        {**row_of(view, index), "runs": view.result(index).runs, "state": state(view, index)}
        for index in view.by_runs
    ]
    base = {"y": by_name(rows), "x": field("runs", title="runs")}
    colors = {name: (color, "square") for name, color in STATES.items()}
    style = {"color": coded("state", colors, rows)["color"]}
    tip = [field("label", "nominal", title=" "), field("runs"), field("state", "nominal")]
    text = {"type": "text", "align": "left", "dx": 4}
    layers = [
        {"mark": "bar", "encoding": {**base, **style, "tooltip": tip}},
        {"name": INK, "mark": text, "encoding": {**base, "text": field("runs", format=",")}},
    ]
    return chart(layers, rows, heights(rows))


def state(view: MeritView, index: int) -> str:
    """Return whether a configuration was selected or eliminated, or remains."""
    if index == view.answer.best:
        return "selected"
    return "eliminated" if view.result(index).eliminated else "remaining"


def times(view: MeritView) -> Spec:
    """Return the chart of the times: middle 90%, middle 50%, and median."""
    rows = [row for index in view.shown if (row := quantile_row(view, index))]
    channel, place, value = axis_of(view, rows)
    tip = [field("label", "nominal", title=" "), *map(field, QUANTILES)]
    base = {channel: place, "tooltip": tip}
    box = 14 if len(rows) <= FEW else 6
    blue = {"type": "rule", "color": BLUE}
    dot = {"type": "point", "filled": True, "color": ORANGE, "shape": "diamond", "opacity": 1}

    def between(low: str, high: str) -> Spec:
        title = {"title": "time of a run (s)"}
        return {**base, value: field(low, **title), f"{value}2": {"field": high}}

    layers: list[Spec] = [
        {"mark": blue, "encoding": between("p5", "p95")},
        {"mark": {**blue, "size": box, "opacity": 0.6}, "encoding": between("p25", "p75")},
        {"mark": {**dot, "size": 45}, "encoding": {**base, value: field("p50")}},
    ]
    made = chart(layers, rows, HEIGHT if channel == "x" else heights(rows))
    axis = ValueAxis(value, value="p50", ends=("p5", "p95"))
    return scaled(made, axis, view.answer.contenders)


def quantile_row(view: MeritView, index: int) -> dict[str, Any] | None:
    """Return the row of quantiles of a configuration's times; None if it has none."""
    times_s = view.evidence.samples[index].columns["time_s"]
    known = times_s[np.isfinite(times_s)]
    if not len(known):
        return None
    quantiles = np.quantile(known, list(QUANTILES.values()))
    pairs = zip(QUANTILES, map(finite, quantiles.tolist()), strict=True)
    return {**place_of(view, index), **dict(pairs)}

"""Parts of the Vega-Lite specifications of a report's charts."""

from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.formatting import finite
from agent_economy.study.report.view import factor_name

Spec = dict[str, Any]
Rows = list[dict[str, Any]]
Codes = dict[str, tuple[str, str]]
"""Colour and shape by category."""

BLUE, ORANGE, TEAL, GREY = "#2f7fd1", "#d9730d", "#1a9a8a", "#87909b"
"""Distinguishable with colour blindness, and visible on light and dark backgrounds."""

VERDICTS: Codes = {
    "selected": (BLUE, "circle"),
    "tied within delta": (TEAL, "square"),
    "not better by delta": (TEAL, "triangle-right"),
    "undecided": (ORANGE, "diamond"),
    "worse": (GREY, "triangle-down"),
}
"""The verdicts on configurations in a study of merit."""

SCHEMA = "https://vega.github.io/schema/vega-lite/v6.json"
INK = "ink"
"""Name of text layers, which take the text colour of the page."""
HEIGHT = 260
FEW = 12
TEXT_STYLE = {
    "labelColor": GREY,
    "labelFontSize": 12,
    "titleColor": GREY,
    "titleFontSize": 12,
    "titleFontWeight": "normal",
}


def chart(layers: list[Spec], rows: Rows, height: int | Spec = HEIGHT) -> Spec:
    """Return layers as a chart of the width of its container."""
    return {
        "$schema": SCHEMA,
        "width": "container",
        "height": height,
        "background": "transparent",
        "data": {"values": rows},
        "layer": layers,
        "config": {
            "view": {"stroke": None},
            "axis": {**TEXT_STYLE, "gridColor": GREY, "gridOpacity": 0.3, "tickColor": GREY},
            "axisQuantitative": {"tickCount": 7},
            # On a narrow screen a title may be wider than the plot; it extends to the left.
            "axisX": {"titleAnchor": "end"},
            "legend": {**TEXT_STYLE, "orient": "top"},
            "text": {"color": GREY},
        },
    }


def field(name: str, kind: str = "quantitative", **settings: Any) -> Spec:
    """Return the definition of an encoding channel."""
    return {"field": name, "type": kind, **settings}


def fixed(rows: Rows, mark: Spec, encoding: Spec) -> Spec:
    """Return a layer with its own data."""
    return {"data": {"values": rows}, "mark": mark, "encoding": encoding}


def line_at(channel: str, at: float, **style: Any) -> Spec:
    """Return a line across the chart."""
    mark = {"type": "rule", "color": GREY, **style}
    return fixed([{"line": at}], mark, {channel: field("line")})


def coded(name: str, codes: Codes, rows: Rows) -> Spec:
    """Return the encodings of colour and shape for the categories that occur."""
    used = [category for category in codes if any(row[name] == category for row in rows)]

    def scale(side: int) -> Spec:
        return {"domain": used, "range": [codes[category][side] for category in used]}

    return {
        "color": field(name, "nominal", scale=scale(0), title=None),
        "shape": field(name, "nominal", scale=scale(1), title=None),
    }


def with_bounds(value: str, title: Spec, place: Spec, style: Spec) -> list[Spec]:
    """Return the layers of points with their intervals.

    Args:
        value: The channel of values, "x" or "y".
        title: Settings of its channel: title, axis, scale.
        place: The encoding of the other channel.
        style: Encodings of colour and shape.
    """
    bounds = {value: field("low", **title), f"{value}2": {"field": "high"}}
    lines = {**place, **bounds, "color": style["color"]}
    tip = [field("label", "nominal", title=" "), *map(field, ("value", "low", "high"))]
    points = {**place, value: field("value", **title), **style, "tooltip": tip}
    dot = {"type": "point", "filled": True, "size": 70, "opacity": 1}
    return [
        {"mark": {"type": "rule", "size": 2}, "encoding": lines},
        {"mark": dot, "encoding": points},
    ]


def heights(rows: Rows) -> Spec:
    """Return the height of a chart with a row per name."""
    return {"step": 26 if len(rows) <= FEW else 19}


def by_name(rows: Rows) -> Spec:
    """Return the y axis of names, in the order of the rows."""
    names = list(dict.fromkeys(row["label"] for row in rows))
    # With an offset, so that a point at the edge does not cover a name.
    axis = {"grid": True, "ticks": False, "domain": False, "offset": 8}
    return field("label", "nominal", title=None, sort=names, axis=axis)


def bounds(interval: Interval) -> dict[str, float | None]:
    """Return an interval as a row has it."""
    return {name: finite(getattr(interval, name)) for name in ("value", "low", "high")}


def row_of(view: AnyView, index: int) -> dict[str, Any]:
    """Return the number and name of a configuration, the same in all of its rows."""
    return {"label": view.names[index], "configuration": index}


def place_of(view: AnyView, index: int) -> dict[str, Any]:
    """Return the configuration of a row, with its position on the axis."""
    row = row_of(view, index)
    if view.numeric_factor:
        row["at"] = finite(float(view.result(index).values[view.numeric_factor]))
    return row


def axis_of(view: AnyView, rows: Rows) -> tuple[str, Spec, str]:
    """Return the channel along which configurations lie, its encoding, and the other channel."""
    if view.numeric_factor is None:
        return "y", by_name(rows), "x"
    whole = all(float(row["at"]).is_integer() for row in rows)
    ticks = {"tickMinStep": 1, "grid": False} if whole else {"grid": False}
    scale = {"zero": False, "nice": False, "padding": 14}
    title = factor_name(view.numeric_factor)
    return "x", field("at", title=title, axis=ticks, scale=scale), "y"


def value_channel(view: AnyView) -> str:
    """Return the channel of values: that along which configurations do not lie."""
    return "x" if view.numeric_factor is None else "y"


def intervals(view: AnyView, rows: Rows, title: Spec, style: Spec) -> Spec:
    """Return a chart of points with intervals along the axis of configurations."""
    channel, place, value = axis_of(view, rows)
    layers = with_bounds(value, {"scale": {"zero": False}, **title}, {channel: place}, style)
    return chart(layers, rows, HEIGHT if channel == "x" else heights(rows))

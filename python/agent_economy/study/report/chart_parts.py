"""What the charts of a report are put together from: pieces of Vega-Lite specifications."""

from typing import Any

from agent_economy.study.report.view import View, factor_name
from agent_economy.study.report.writing import finite

Spec = dict[str, Any]
Rows = list[dict[str, Any]]
Codes = dict[str, tuple[str, str]]
"""Colour and shape by meaning."""

BLUE, ORANGE, TEAL, GREY = "#2f7fd1", "#d9730d", "#1a9a8a", "#87909b"
"""They differ for the colour-blind, and can be seen on white and on near black."""

SCHEMA = "https://vega.github.io/schema/vega-lite/v6.json"
INK = "ink"
"""The name of layers of text: a page gives what they draw the colour of its text."""
HEIGHT = 260
FEW = 12
WRITING = {
    "labelColor": GREY,
    "labelFontSize": 12,
    "titleColor": GREY,
    "titleFontSize": 12,
    "titleFontWeight": "normal",
}


def chart(layers: list[Spec], rows: Rows, height: int | Spec = HEIGHT) -> Spec:
    """Return layers as a chart as wide as its page allows."""
    return {
        "$schema": SCHEMA,
        "width": "container",
        "height": height,
        "background": "transparent",
        "data": {"values": rows},
        "layer": layers,
        "config": {
            "view": {"stroke": None},
            "axis": {**WRITING, "gridColor": GREY, "gridOpacity": 0.3, "tickColor": GREY},
            "axisQuantitative": {"tickCount": 7},
            # A title may be wider than the plot on a narrow screen; there it has room to the left.
            "axisX": {"titleAnchor": "end"},
            "legend": {**WRITING, "orient": "top"},
            "text": {"color": GREY},
        },
    }


def field(name: str, kind: str = "quantitative", **settings: Any) -> Spec:
    """Return the definition of a channel."""
    return {"field": name, "type": kind, **settings}


def fixed(rows: Rows, mark: Spec, encoding: Spec) -> Spec:
    """Return a layer with data of its own."""
    return {"data": {"values": rows}, "mark": mark, "encoding": encoding}


def line_at(channel: str, at: float, **look: Any) -> Spec:
    """Return a line across the chart."""
    mark = {"type": "rule", "color": GREY, **look}
    return fixed([{"line": at}], mark, {channel: field("line")})


def coded(name: str, codes: Codes, rows: Rows) -> Spec:
    """Return colour and shape by meaning, for those meanings that are there."""
    there = [meaning for meaning in codes if any(row[name] == meaning for row in rows)]

    def scale(side: int) -> Spec:
        return {"domain": there, "range": [codes[meaning][side] for meaning in there]}

    return {
        "color": field(name, "nominal", scale=scale(0), title=None),
        "shape": field(name, "nominal", scale=scale(1), title=None),
    }


def with_bounds(value: str, title: Spec, place: Spec, looks: Spec) -> list[Spec]:
    """Return points with their intervals.

    Args:
        value: The channel of values, "x" or "y".
        title: Settings of its channel: title, axis, scale.
        place: The encoding of the other channel.
        looks: Encodings of colour and shape.
    """
    bounds = {value: field("low", **title), f"{value}2": {"field": "high"}}
    lines = {**place, **bounds, "color": looks["color"]}
    tip = [field("label", "nominal", title=" "), *map(field, ("value", "low", "high"))]
    points = {**place, value: field("value", **title), **looks, "tooltip": tip}
    dot = {"type": "point", "filled": True, "size": 70, "opacity": 1}
    return [
        {"mark": {"type": "rule", "size": 2}, "encoding": lines},
        {"mark": dot, "encoding": points},
    ]


def heights(rows: Rows) -> Spec:
    """Return the height of a chart with a row a name."""
    return {"step": 26 if len(rows) <= FEW else 19}


def by_name(rows: Rows) -> Spec:
    """Return the y axis of names, in the order of the rows."""
    names = list(dict.fromkeys(row["label"] for row in rows))
    # Off the plot, so that a point at its edge hides no name.
    axis = {"grid": True, "ticks": False, "domain": False, "offset": 8}
    return field("label", "nominal", title=None, sort=names, axis=axis)


def row_of(view: View, index: int) -> dict[str, Any]:
    """Return a configuration's number and what it is called, as all rows that stand for one."""
    return {"label": view.names[index], "configuration": index}


def place_of(view: View, index: int) -> dict[str, Any]:
    """Return which configuration a row is of, and where that stands on the axis."""
    row = row_of(view, index)
    if view.numeric_factor:
        row["at"] = finite(float(view.result(index).values[view.numeric_factor]))
    return row


def axis_of(view: View, rows: Rows) -> tuple[str, Spec, str]:
    """Return the channel along which configurations lie, its encoding, and the other channel."""
    if view.numeric_factor is None:
        return "y", by_name(rows), "x"
    whole = all(float(row["at"]).is_integer() for row in rows)
    ticks = {"tickMinStep": 1, "grid": False} if whole else {"grid": False}
    scale = {"zero": False, "nice": False, "padding": 14}
    title = factor_name(view.numeric_factor)
    return "x", field("at", title=title, axis=ticks, scale=scale), "y"


def intervals(view: View, rows: Rows, title: Spec, looks: Spec) -> Spec:
    """Return points with intervals along the axis of configurations."""
    channel, place, value = axis_of(view, rows)
    layers = with_bounds(value, {"scale": {"zero": False}, **title}, {channel: place}, looks)
    return chart(layers, rows, HEIGHT if channel == "x" else heights(rows))

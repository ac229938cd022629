"""Charts of measurements in Vega-Lite: points with intervals, curves, panels."""

import hashlib
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import vl_convert

Spec = dict[str, Any]
"""A Vega-Lite specification, or a part of one."""

Z95 = 1.96
"""Standard errors on either side of a 95% interval."""

INK, GREY = "#1f2937", "#9ca3af"
COLOURS = ["#2563eb", "#ea580c", "#0d9488", "#9333ea", "#b45309", "#475569"]
SHAPES = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down"]
WIDTH, HEIGHT = 480, 280


@dataclass(frozen=True)
class Row:
    """A measured number."""

    series: str
    x: float
    measured: float
    standard_error: float
    expected: float | None

    @property
    def sigmas(self) -> float:
        """Return the distance from the closed form in standard errors."""
        if self.expected is None or self.measured == self.expected:
            return 0.0
        return (self.measured - self.expected) / self.standard_error

    @property
    def precision(self) -> float:
        """Return the standard error relative to the closed form."""
        return self.standard_error / self.expected if self.expected else math.inf


@dataclass(frozen=True)
class Axes:
    """The properties of two axes."""

    x: str = "linear"
    y: str = "linear"
    x_ticks: tuple[float, ...] = ()
    y_ticks: tuple[float, ...] = ()
    y_format: str = "~g"
    y_domain: tuple[float, float] | None = None
    whole: bool = False
    """Whether x is a count."""

    def horizontal(self, title: str) -> Spec:
        """Return the x axis and its scale."""
        axis: Spec = {"title": title}
        if self.x == "log":
            axis["format"] = "~g"
        if self.x_ticks:
            axis["values"] = list(self.x_ticks)
        if self.whole:
            axis["tickMinStep"] = 1
        is_linear = self.x == "linear"
        return {"axis": axis, "scale": {"type": self.x, "nice": is_linear, "zero": is_linear}}

    def vertical(self, title: str) -> Spec:
        """Return the y axis and its scale."""
        axis: Spec = {"title": title, "format": self.y_format}
        if self.y_ticks:
            axis["values"] = list(self.y_ticks)
        scale: Spec = {"type": self.y}
        if self.y_domain:
            scale["domain"] = list(self.y_domain)
        return {"axis": axis, "scale": scale}


LINEAR = Axes()


def interval(value: float, error: float, digits: int = 1) -> str:
    """Return a number with its 95% interval."""
    return f"{value:.{digits}f} ± {Z95 * error:.{digits}f}"


def picture(spec: Spec) -> str:
    """Return a chart as SVG, with a hash of its specification at the end."""
    drawn = json.dumps(spec, sort_keys=True).encode()
    svg: str = vl_convert.vegalite_to_svg(spec)
    return f"{svg}\n<!-- {hashlib.sha256(drawn).hexdigest()} -->\n"


def points(some: Iterable[Row], *, legend: bool = True) -> list[Spec]:
    """Return points with their 95% intervals, by series."""
    some = list(some)
    data = {"values": [values(row) for row in some]}
    whiskers = {
        "data": data,
        "mark": {"type": "rule"},
        "encoding": {
            "x": field("x"),
            "y": field("low"),
            "y2": {"field": "high"},
            "color": colour(some, legend=legend),
        },
    }
    dots = {
        "data": data,
        "mark": {"type": "point", "filled": True, "size": 45, "opacity": 1},
        "encoding": {
            **plain(),
            "color": colour(some, legend=legend),
            "shape": {**colour(some, legend=legend), "scale": scale(some, SHAPES)},
        },
    }
    return [whiskers, dots] if any(row.standard_error > 0 for row in some) else [dots]


def curves(some: Iterable[Row], interpolate: str = "linear") -> list[Spec]:
    """Return the closed forms of series as connected lines."""
    forms = [{**values(row), "y": row.expected} for row in some if row.expected is not None]
    return [lines(forms, interpolate=interpolate)]


def connected(some: Iterable[Row], *, legend: bool = True) -> list[Spec]:
    """Return points with their 95% intervals, connected by a line for each series."""
    some = list(some)
    return [lines([values(row) for row in some]), *points(some, legend=legend)]


def lines(data: list[dict[str, Any]], **mark: str) -> Spec:
    """Return a thin line for each series of the data."""
    line = path(data, strokeWidth=1, **mark)
    line["encoding"]["detail"] = {"field": "series", "type": "nominal"}
    return line


def path(places: list[dict[str, Any]], **mark: Any) -> Spec:
    """Return a line through places."""
    return {
        "data": {"values": places},
        "mark": {"type": "line", "color": INK, **mark},
        "encoding": plain(),
    }


def values(row: Row) -> dict[str, float | str]:
    """Return the fields of a row that a chart uses."""
    half = Z95 * row.standard_error
    low, high = row.measured - half, row.measured + half
    return {"series": row.series, "x": row.x, "y": row.measured, "low": low, "high": high}


def colour(some: list[Row], *, legend: bool) -> Spec:
    """Return the channel of the series."""
    shown = {"title": None, "orient": "top", "columns": 2, "labelLimit": 400} if legend else None
    return {
        "field": "series",
        "type": "nominal",
        "scale": scale(some, COLOURS),
        "legend": shown,
    }


def scale(some: list[Row], looks: list[str]) -> Spec:
    """Return the styles of series, in the order of their first occurrence."""
    series = list(dict.fromkeys(row.series for row in some))
    return {"domain": series, "range": looks[: len(series)]}


def plain() -> Spec:
    """Return the channels of positions."""
    return {"x": field("x"), "y": field("y")}


def field(name: str) -> Spec:
    """Return the channel of a number."""
    return {"field": name, "type": "quantitative"}


def panel(
    layers: list[Spec],
    x: str,
    y: str,
    *,
    width: int = WIDTH,
    axes: Axes = LINEAR,
) -> Spec:
    """Return layers over common axes with titles."""
    places = {"x": axes.horizontal(x), "y": axes.vertical(y)}
    for layer in layers:
        encoding = layer["encoding"]
        for channel in encoding.keys() & places.keys():
            encoding[channel] = {**encoding[channel], **places[channel]}
    return {"layer": layers, "width": width, "height": HEIGHT}


def side_by_side(*panels: Spec) -> Spec:
    """Return panels in a row, each with its own series."""
    own = {"color": "independent", "shape": "independent"}
    return {"hconcat": list(panels), "resolve": {"scale": own}}


def page_of(body: Spec) -> Spec:
    """Return a complete specification with a light background."""
    return {
        "$schema": "https://vega.github.io/schema/vega-lite/v6.json",
        "background": "white",
        "padding": 12,
        "config": {
            "axis": {"labelFontSize": 12, "titleFontSize": 13, "gridColor": "#e5e7eb"},
            "legend": {"labelFontSize": 12, "symbolSize": 70},
            "text": {"fontSize": 13},
            "view": {"stroke": "#d1d5db"},
        },
        **body,
    }

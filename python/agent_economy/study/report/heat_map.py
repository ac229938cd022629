"""A heat map over two factors, whose cells have marks that are readable without colour."""

from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.chart_parts import (
    ORANGE,
    Codes,
    Rows,
    Spec,
    chart,
    coded,
    field,
    fixed,
)
from agent_economy.study.report.view import factor_name

TALLEST = 480
"""Height of a heat map in pixels, unless its rows become too thin."""

MARK = {"type": "point", "filled": True, "fill": "#000", "stroke": "#fff", "opacity": 1}
"""Black with a white edge, which is visible on every colour and on dark pages."""


def heat_map(view: AnyView, rows: Rows, title: Spec, codes: Codes) -> Spec:
    """Return a heat map of a row per configuration; the selected one is framed.

    Args:
        view: The study, with two varied factors.
        rows: As `row_of`, with "value", the colour, and "mark", a category of `codes` or None.
        title: Title of the values, and their format if it is not the usual one.
        codes: Shapes of the marks; their colours are not used.
    """
    across, down = view.varied
    for values, row in zip(view.configurations, rows, strict=True):
        row |= {"across": values[across], "down": values[down]}
    height = max(8, min(26, TALLEST // len({row["down"] for row in rows})))
    lattice = axes(rows, across, down)
    tip = [
        field("label", "nominal", title=" "),
        field("value", **title),
        field("mark", "nominal", title="status"),
    ]
    color = field("value", title=title["title"], scale={"scheme": "viridis"})
    color |= {"legend": {"format": title["format"]}} if "format" in title else {}
    layers = [{"mark": "rect", "encoding": {**lattice, "color": color, "tooltip": tip}}]
    if view.selected is not None:
        frame = {"type": "rect", "filled": False, "stroke": ORANGE, "strokeWidth": 4}
        layers.append(fixed([rows[view.selected]], frame, lattice))
    if marked := [row for row in rows if row["mark"] is not None]:
        symbols = {"symbolFillColor": "#000", "symbolStrokeColor": "#fff"}
        shape = {**coded("mark", codes, marked)["shape"], "legend": symbols}
        mark = {**MARK, "size": (0.4 * height) ** 2, "strokeWidth": 1}
        layers.append(fixed(marked, mark, {**lattice, "shape": shape, "tooltip": tip}))
    return chart(layers, rows, {"step": height})


def axes(rows: Rows, across: str, down: str) -> Spec:
    """Return the axes of the two factors."""
    named = {"labelAngle": 0, "labelOverlap": True, "grid": False}
    lattice = {
        "x": field("across", "ordinal", title=factor_name(across), axis=named),
        "y": field("down", "ordinal", title=factor_name(down), axis=named),
    }
    for channel, low_first in (("x", True), ("y", False)):
        lattice[channel]["sort"] = steps(rows, lattice[channel]["field"], low_first=low_first)
    return lattice


def steps(rows: Rows, name: str, *, low_first: bool) -> list[float | str]:
    """Return the values along one axis of a heat map: numbers sorted, names in their order."""
    found = list(dict.fromkeys(row[name] for row in rows))
    if any(isinstance(value, str) for value in found):
        return found
    return sorted(found, reverse=not low_first)

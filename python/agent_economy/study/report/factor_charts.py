"""Charts of what factors do: a map of two, gains of larger teams, sensitivity; and of others."""

from typing import Any

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.labels import robot_kind
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.report.chart_parts import (
    BLUE,
    ORANGE,
    Codes,
    Rows,
    Spec,
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
from agent_economy.study.report.view import View, factor_name
from agent_economy.study.report.writing import finite

TALLEST = 480
"""Height of a map, px, unless its rows get too thin."""

MEASURES: Codes = {
    "alone": (BLUE, "circle"),
    "with all its interactions": (ORANGE, "diamond"),
}
OURS = "this study"


def specifications(view: View) -> dict[str, Spec]:
    """Return each chart's specification by name: those that have something to show."""
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


def heat(view: View) -> Spec:
    """Return the mean merit over a full grid of two factors, the selected one framed."""
    across, down = view.varied
    rows: Rows = [
        {
            **row_of(view, index),
            "across": result.values[across],
            "down": result.values[down],
            "value": finite(result.merit.value),
        }
        for index, result in enumerate(view.answer.results)
    ]
    named = {"labelAngle": 0, "labelOverlap": True, "grid": False}
    lattice = {
        "x": field("across", "ordinal", title=factor_name(across), axis=named),
        "y": field("down", "ordinal", title=factor_name(down), axis=named),
    }
    for channel, low_first in (("x", True), ("y", False)):
        lattice[channel]["sort"] = steps(rows, lattice[channel]["field"], low_first=low_first)
    color = field("value", title="mean merit", scale={"scheme": "viridis"})
    tip = [field("label", "nominal", title=" "), field("value", title="mean merit")]
    frame = {"type": "rect", "filled": False, "stroke": ORANGE, "strokeWidth": 4}
    layers = [
        {"mark": "rect", "encoding": {**lattice, "color": color, "tooltip": tip}},
        fixed([rows[view.answer.best]], frame, lattice),
    ]
    levels = len({row["down"] for row in rows})
    return chart(layers, rows, {"step": max(8, min(26, TALLEST // levels))})


def steps(rows: Rows, name: str, *, low_first: bool) -> list[float | str]:
    """Return the values along one side of a map: numbers by size, words as they come."""
    found = list(dict.fromkeys(row[name] for row in rows))
    if any(isinstance(value, str) for value in found):
        return found
    return sorted(found, reverse=not low_first)


def saturation(view: View, found: Saturation) -> Spec:
    """Return what larger teams gain over one size, against nothing and against delta."""
    rows: Rows = [
        {
            "label": f"{size:,}",
            "value": finite(gain.value),
            "low": finite(gain.low),
            "high": finite(gain.high),
            "gain": "gain",
        }
        for size, gain in found.gains.items()
    ]
    looks = coded("gain", {"gain": (BLUE, "circle")}, rows)
    looks = {name: {**channel, "legend": None} for name, channel in looks.items()}
    kind = f"{robot_kind(found.path)}s"
    title = {"title": f"gain of merit over {found.base:,} {kind}"}
    place = {"y": {**by_name(rows), "title": kind}}
    lines = [line_at("x", 0.0), line_at("x", view.answer.delta, strokeDash=[4, 3], color=ORANGE)]
    return chart([*lines, *with_bounds("x", title, place, looks)], rows, heights(rows))


def sensitivity(view: View) -> Spec:
    """Return how much of the merit each factor explains, with errors."""
    found = view.answer.sensitivity
    rows: Rows = []
    for each in found.influences if found else ():
        shares = ((each.first_order, each.first_order_error), (each.total, each.total_error))
        rows += [
            {
                "label": factor_name(each.path),
                "measure": measure,
                "value": finite(share),
                "low": finite(share - error),
                "high": finite(share + error),
            }
            for measure, (share, error) in zip(MEASURES, shares, strict=True)
        ]
    place = {"y": by_name(rows), "yOffset": field("measure", "nominal", sort=list(MEASURES))}
    title = {"title": "influence on the merit (0 none, 1 all)"}
    layers = with_bounds("x", title, place, coded("measure", MEASURES, rows))
    return chart([line_at("x", 0.0), *layers], rows, {"step": 17})


def published(view: View, path: str) -> Spec:
    """Return our figures of merit beside those of others, by team size."""
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
    looks = coded("source", {OURS: (BLUE, "circle"), theirs: (ORANGE, "diamond")}, rows)
    place = {
        "x": field("at", "ordinal", title=factor_name(path), axis={"labelAngle": 0}),
        "xOffset": field("source", "nominal", scale={"paddingOuter": 1}, sort=[OURS, theirs]),
    }
    title = {"title": "figure of merit (higher is better)", "scale": {"zero": False}}
    return chart(with_bounds("y", title, place, looks), rows)


def published_row(source: str, size: int, merit: Interval) -> dict[str, Any]:
    """Return the figure of merit of a team, as somebody found it."""
    return {
        "label": f"{source}, {size}",
        "at": size,
        "source": source,
        "value": finite(merit.value),
        "low": finite(merit.low),
        "high": finite(merit.high),
    }

"""Draw docs/validation.md: its pictures and its tables, from what the checks have measured.

What was measured stands in docs/validation/*.csv, which the simulator's tests write and compare
(crates/sim/tests/validation). Tables stand between `<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/validation.py            write pictures and page anew
    python scripts/validation.py --check    exit with 1 if they are not what would be written
"""

import csv
import hashlib
import json
import math
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

import vl_convert
from paired import HEADER, compared

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation.md"
FOLDER = ROOT / "docs" / "validation"

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
    """One number that was measured."""

    series: str
    x: float
    measured: float
    standard_error: float
    expected: float | None

    @property
    def sigmas(self) -> float:
        """Return standard errors from the closed form."""
        if self.expected is None or self.measured == self.expected:
            return 0.0
        return (self.measured - self.expected) / self.standard_error

    @property
    def precision(self) -> float:
        """Return the standard error as a share of the closed form."""
        return self.standard_error / self.expected if self.expected else math.inf


@dataclass(frozen=True)
class Axes:
    """What two axes are like."""

    x: str = "linear"
    y: str = "linear"
    x_ticks: tuple[float, ...] = ()
    y_ticks: tuple[float, ...] = ()
    y_format: str = "~g"
    y_domain: tuple[float, float] | None = None
    whole: bool = False
    """Whether x counts something."""

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


def main() -> None:
    """Write pictures and page, or check them."""
    made = {FOLDER / f"{name}.svg": picture(spec) for name, spec in specifications().items()}
    old = PAGE.read_text(encoding="utf-8")
    made[PAGE] = re.sub(r"<!-- (\w+) -->\n.*?<!-- end -->", block, old, flags=re.DOTALL)
    stale = [file for file, text in made.items() if is_stale(file, text)]
    if "--check" in sys.argv[1:]:
        if stale:
            names = ", ".join(str(file.relative_to(ROOT)) for file in stale)
            sys.exit(f"not what `make validation` writes: {names}")
        return
    for file in stale:
        file.write_text(made[file], encoding="utf-8")
        print(file.relative_to(ROOT))


def is_stale(file: Path, text: str) -> bool:
    """Return whether a file says another thing; pictures are compared by what they were drawn from.

    How wide letters are, and so where a picture has its parts, can differ from machine to machine.
    """
    if not file.exists():
        return True
    old = file.read_text(encoding="utf-8")
    if file.suffix == ".svg":
        return old.splitlines()[-1] != text.splitlines()[-1]
    return old != text


def picture(spec: Spec) -> str:
    """Return a picture as SVG that ends with a hash of its specification."""
    drawn = json.dumps(spec, sort_keys=True).encode()
    svg: str = vl_convert.vegalite_to_svg(spec)
    return f"{svg}\n<!-- {hashlib.sha256(drawn).hexdigest()} -->\n"


def block(found: re.Match[str]) -> str:
    """Return a block of the page with its table computed."""
    name = found[1]
    own = {"overview": overview, "search_minds": search_minds}
    made = own[name]() if name in own else table_of(name.replace("_", "-"))
    return f"<!-- {name} -->\n{made}\n<!-- end -->"


@cache
def rows(name: str) -> tuple[Row, ...]:
    """Return what a check measured."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return tuple(
            Row(
                series=line["series"],
                x=float(line["x"]),
                measured=float(line["measured"]),
                standard_error=float(line["standard_error"]),
                expected=float(line["expected"]) if line["expected"] else None,
            )
            for line in csv.DictReader(file)
        )


# Tables.


def table_of(name: str) -> str:
    """Return a table with a line for each series of a check: its surest number, its worst miss."""
    lines = [series_line(list(each)) for _, each in groupby(rows(name), key=lambda row: row.series)]
    header = ["", "numbers", "the surest, at", "is", "closed form", "farthest off"]
    return table(header, lines)


def series_line(series: list[Row]) -> list[str]:
    """Return the line of one series."""
    compared = [row for row in series if row.expected is not None]
    surest = min(compared or series[-1:], key=lambda row: (row.precision, row.standard_error))
    return [
        series[0].series,
        str(len(series)),
        f"{surest.x:g}",
        interval(surest),
        number(surest.expected) if surest.expected is not None else "none",
        farthest(series),
    ]


def farthest(series: list[Row]) -> str:
    """Return how far the worst number of a series is from the closed form."""
    compared = [row for row in series if row.expected is not None]
    if not compared:
        return ""
    if any(row.standard_error > 0 for row in compared):
        return f"{max(abs(row.sigmas) for row in compared):.1f} standard errors"
    return number(max(abs(row.measured - (row.expected or 0.0)) for row in compared))


def interval(row: Row) -> str:
    """Return a number with its 95% interval."""
    if row.standard_error == 0:
        return number(row.measured)
    half = Z95 * row.standard_error
    digits = max(0, 1 - math.floor(math.log10(half)))
    return f"{row.measured:.{digits}f} ± {half:.{digits}f}"


def number(value: float) -> str:
    """Return a number with five digits."""
    return f"{value:.5g}"


def overview() -> str:
    """Return the page's first table: each claim, and how near the simulator is to it."""
    lines = [
        ["random search: 1 - exp(-n w v t / A)", *nearness("random-search")],
        ["lanes: min(1, w v t / A)", *nearness("lanes")],
        ["looks until detection: geometric", *nearness("looks")],
        ["false alarms in a look: Poisson", *nearness("false-alarms")],
        ["arcs: circles", f"off by {largest('arcs'):.0e} m after 100,000 steps", "exact"],
        ["stopping: v² / 2a", f"off by less than {relative('stopping'):.0e} of it", "exact"],
        [
            "battery: capacity / power",
            f"{latest('battery'):.2f} s later at most",
            "one step: 0.1 s",
        ],
        ["radio: (1 - loss) in range, 0 beyond; delay; cut", *nearness("radio")],
        ["collisions: a gas of discs in the plane", *nearness("collisions")],
        ["swarms: order falls with noise (Vicsek 1995)", *nearness("vicsek")],
        ["places: uniform where it is free", *nearness("placement")],
        ["beliefs: of those held with c, a share of c is true", *nearness("calibration")],
    ]
    return table(["claim", "simulated", "farthest off"], lines)


def search_minds() -> str:
    """Return how long searching by belief takes beside lanes, over all worlds."""
    return table(HEADER, compared(FOLDER / "search-minds.csv"))


def nearness(name: str) -> tuple[str, str]:
    """Return the best precision of a check, and its worst miss in standard errors."""
    compared = [row for row in rows(name) if row.expected is not None and row.standard_error > 0]
    best = min(row.precision for row in compared)
    worst = max(abs(row.sigmas) for row in compared)
    return (
        f"{len(compared)} numbers, the surest to {max(Z95 * best, 0.001):.1%}",
        f"{worst:.1f} standard errors",
    )


def largest(name: str) -> float:
    """Return the greatest number of the simulator's own series."""
    return max(row.measured for row in rows(name) if "Euler" not in row.series)


def relative(name: str) -> float:
    """Return by how much of the closed form a number is off at most, to what files show."""
    off = (abs(row.measured / row.expected - 1) for row in rows(name) if row.expected)
    return max(*off, 1e-7)


def latest(name: str) -> float:
    """Return by how much a number is above the closed form at most."""
    return max(row.measured - row.expected for row in rows(name) if row.expected is not None)


def table(header: list[str], lines: Iterable[list[str]]) -> str:
    """Return a Markdown table."""
    lines = [header, ["---"] * len(header), *lines]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


# Pictures.


def specifications() -> dict[str, Spec]:
    """Return each picture's specification by its name."""
    return {
        "random-search": random_search(),
        "lanes": simple("lanes", "way along lanes, m", "share of items found"),
        "looks": simple("looks", "looks", "share not detected yet", Axes(y="log", whole=True)),
        "false-alarms": simple(
            "false-alarms", "false alarms in a look", "share of looks", Axes(whole=True)
        ),
        "arcs": arcs(),
        "stopping": stopping(),
        "battery": battery(),
        "radio": radio(),
        "collisions": simple("collisions", "robots", "contacts of a robot with others, 1/s"),
        "vicsek": simple("vicsek", "width of noise, rad", "order: length of the mean course"),
        "placement": placement(),
        "sense": sense(),
        "calibration": calibration(),
    }


def random_search() -> Spec:
    """Return the share found by what has been swept, beside Koopman's law."""
    swept = [step / 50 for step in range(101)]
    law = [{"x": x, "y": 1 - math.exp(-x)} for x in swept]
    measured = [row for row in rows("random-search") if row.series != "all"]
    label = {"x": 0.72, "y": 0.62, "text": "1 - exp(-n w v t / A)"}
    layers = [
        {"data": {"values": law}, "mark": {"type": "line", "color": INK}, "encoding": plain()},
        {
            "data": {"values": [label]},
            "mark": {"type": "text", "align": "right", "color": INK},
            "encoding": {**plain(), "text": {"field": "text"}},
        },
        *points(measured),
    ]
    return page_of(panel(layers, "swept: n w v t / A", "share of items found"))


def simple(name: str, x: str, y: str, axes: Axes = LINEAR) -> Spec:
    """Return a check's numbers over their closed form."""
    has_series = len({row.series for row in rows(name)}) > 1
    layers = [*curves(rows(name)), *points(rows(name), legend=has_series)]
    return page_of(panel(layers, x, y, axes=axes))


def arcs() -> Spec:
    """Return how far bodies are from their circles."""
    shown = [row for row in rows("arcs") if row.measured > 0]
    layers = [{**line(), "data": {"values": [values(row) for row in shown]}}, *points(shown)]
    decades = Axes("log", "log", x_ticks=(1, 10, 100, 1000, 10_000, 100_000), y_format=".0e")
    return page_of(panel(layers, "steps", "distance from the circle, m", axes=decades))


def stopping() -> Spec:
    """Return stopping distances, and the speed of a robot that goes towards a wall."""
    left = [*curves(rows("stopping"), "monotone"), *points(rows("stopping"))]
    bound = [{"x": row.x, "y": row.expected} for row in rows("sight")]
    right = [
        {"data": {"values": bound}, "mark": {"type": "line", "color": INK}, "encoding": plain()},
        *points(rows("sight"), legend=False),
    ]
    return page_of(
        side_by_side(
            panel(left, "speed, m/s", "stopping distance, m", width=WIDTH // 2),
            panel(right, "from the hull to the wall, m", "speed, m/s", width=WIDTH // 2),
        )
    )


def battery() -> Spec:
    """Return by how much batteries last longer than capacity by power."""
    later = [
        Row(row.series, row.x, row.measured - row.expected, 0.0, None)
        for row in rows("battery")
        if row.expected is not None
    ]
    step = {
        "data": {"values": [{"low": 0, "high": 0.1}]},
        "mark": {"type": "rect", "color": GREY, "opacity": 0.2},
        "encoding": {"y": {"field": "low", "type": "quantitative"}, "y2": {"field": "high"}},
    }
    return page_of(
        panel(
            [step, *points(later)],
            "capacity, J",
            "life less capacity / power, s",
            axes=Axes(x="log", x_ticks=(100, 300, 1000, 3000, 10_000)),
        )
    )


def radio() -> Spec:
    """Return what radios deliver: by distance, by messages, by delay, and at a slow brain."""
    panels = [
        (["share delivered"], "distance, m", "share delivered"),
        (
            ["messages of one caller", "callers of one message"],
            "messages in a step",
            "messages heard in a step",
        ),
        (["age when heard"], "delay, s", "age when heard, s"),
        (["ages at a slow brain"], "age when heard, s", "share of messages"),
    ]
    drawn = []
    for series, x, y in panels:
        some = [row for row in rows("radio") if row.series in series]
        form = staircase() if series == ["age when heard"] else curves(some)
        layers = [*form, *points(some, legend=len(series) > 1)]
        drawn.append(panel(layers, x, y, width=WIDTH // 2))
    return page_of({"vconcat": [side_by_side(*drawn[:2]), side_by_side(*drawn[2:])]})


def staircase() -> list[Spec]:
    """Return delays rounded up to steps of 0.1 s, and one at least."""
    delays = [number / 100 for number in range(101)]
    ages = [max(1, math.ceil(delay * 10 - 1e-9)) / 10 for delay in delays]
    stairs = [{"x": x, "y": y} for x, y in zip(delays, ages, strict=True)]
    mark = {"type": "line", "color": INK, "strokeWidth": 1, "interpolate": "step-before"}
    return [{"data": {"values": stairs}, "mark": mark, "encoding": plain()}]


def placement() -> Spec:
    """Return what of the items and robots is in each column, as a share of what should be."""
    columns = 20
    items = [row for row in rows("placement") if row.series == "items" and row.expected]
    by_column = [
        [row for row in items if int(row.x) % columns == column] for column in range(columns)
    ]
    made = [together("items", column, some) for column, some in enumerate(by_column)]
    robots = [row for row in rows("placement") if row.series == "robots"]
    made += [together("robots", int(row.x), [row]) for row in robots]
    one = {
        "data": {"values": [{"y": 1}]},
        "mark": {"type": "rule", "color": INK},
        "encoding": {"y": {"field": "y", "type": "quantitative"}},
    }
    axes = Axes(y_domain=(0.75, 1.25))
    return page_of(
        panel([one, *points(made)], "x, m", "share of all / share of the area", axes=axes)
    )


def calibration() -> Spec:
    """Return the share of beliefs that is true by their confidence: alone, and with radio."""
    panels = []
    for title, radio in (("alone", "alone"), ("with radio", "radio")):
        some = [row for row in rows("calibration") if radio in row.series]
        right = [{"x": 0, "y": 0}, {"x": 1, "y": 1}]
        diagonal = {
            "data": {"values": right},
            "mark": {"type": "line", "color": INK, "strokeWidth": 1},
            "encoding": plain(),
        }
        axes = Axes(x_ticks=(0, 0.2, 0.4, 0.6, 0.8, 1), y_domain=(0, 1))
        x = f"believed with, {title}"
        panels.append(
            panel([diagonal, *points(some)], x, "share true", width=WIDTH // 2, axes=axes)
        )
    return page_of(side_by_side(*panels))


def together(series: str, column: int, some: list[Row]) -> Row:
    """Return several shares as one, divided by what it should be."""
    expected = sum(row.expected or 0.0 for row in some)
    error = math.sqrt(sum(row.standard_error**2 for row in some))
    measured = sum(row.measured for row in some)
    x = column + (0.4 if series == "items" else 0.6)
    return Row(series, x, measured / expected, error / expected, None)


def sense() -> Spec:
    """Return mean times by the number of robots, and by their speed."""
    panels = []
    kinds = (
        ("robots", "robots", (1.0, 2.0, 4.0, 8.0, 16.0)),
        ("m/s", "greatest speed of four robots, m/s", (0.25, 0.5, 1.0, 2.0)),
    )
    for series, x, ticks in kinds:
        some = [row for row in rows("sense") if row.series == series]
        layers = [
            {**line(), "data": {"values": [values(row) for row in some]}},
            *points(some, legend=False),
        ]
        y = "mean time until all is found, s"
        times = (50.0, 2000.0)
        axes = Axes("log", "log", x_ticks=ticks, y_ticks=(50, 100, 200, 500, 1000), y_domain=times)
        panels.append(panel(layers, x, y, width=WIDTH // 2, axes=axes))
    return page_of({"hconcat": panels})


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
    """Return the closed forms of series as lines from number to number."""
    forms = [{**values(row), "y": row.expected} for row in some if row.expected is not None]
    curve = line()
    curve["mark"]["interpolate"] = interpolate
    return [{**curve, "data": {"values": forms}}]


def line() -> Spec:
    """Return a thin line for each series, without its data."""
    return {
        "mark": {"type": "line", "color": INK, "strokeWidth": 1},
        "encoding": {**plain(), "detail": {"field": "series", "type": "nominal"}},
    }


def values(row: Row) -> dict[str, float | str]:
    """Return what a picture needs of a row."""
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
    """Return looks for series, in the order in which they come."""
    series = list(dict.fromkeys(row.series for row in some))
    return {"domain": series, "range": looks[: len(series)]}


def plain() -> Spec:
    """Return the channels of places."""
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
    """Return a whole specification on light ground."""
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


if __name__ == "__main__":
    main()

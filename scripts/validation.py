"""Draw docs/validation.md: its pictures and its tables, from what the checks have measured.

What was measured stands in docs/validation/*.csv, which the simulator's tests write and compare
(crates/sim/tests/validation). Tables stand between `<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/validation.py            write pictures and page anew
    python scripts/validation.py --check    exit with 1 if they are not what would be written
"""

import csv
import math
from functools import cache
from itertools import groupby

from page import Page, table
from paired import HEADER, compared
from plots import (
    GREY,
    INK,
    LINEAR,
    WIDTH,
    Z95,
    Axes,
    Row,
    Spec,
    curves,
    line,
    page_of,
    panel,
    plain,
    points,
    side_by_side,
    values,
)

PAGE = Page("validation")


def main() -> None:
    """Write pictures and page, or check them."""
    PAGE.draw(made, specifications())


def made(name: str) -> str:
    """Return a table of the page."""
    own = {"overview": overview, "search_minds": search_minds}
    return own[name]() if name in own else table_of(name.replace("_", "-"))


@cache
def rows(name: str) -> tuple[Row, ...]:
    """Return what a check measured."""
    with (PAGE.folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
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
    return table(HEADER, compared(PAGE.folder / "search-minds.csv"))


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


if __name__ == "__main__":
    main()

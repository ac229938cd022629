"""Generate the tables and charts of docs/validation.md from the measurements of the checks.

The measurements are docs/validation/*.csv, which the simulator's tests write and compare
(crates/sim/tests/validation). Tables are between `<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/validation.py            write charts and page
    python scripts/validation.py --check    exit with status 1 if they are out of date
"""

import math
from functools import cache
from itertools import groupby

from measured import Page, table
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
    connected,
    curves,
    interval,
    page_of,
    panel,
    path,
    plain,
    points,
    side_by_side,
)

PAGE = Page("validation")

SUREST = [(0.9, 0.95), (0.95, 0.99), (0.99, 1.0)]
"""The surest beliefs, by confidence."""

MAX_SIGMAS = 3
"""Beliefs that are farther from their confidence are not calibrated, in standard errors."""

MEAN_LEFT, CLEARANCE = "mean number left", 0.675
"""A series of the check of mines left, and the share of mines that its search finds."""


def main() -> None:
    """Write charts and page, or check them."""
    PAGE.draw(made, specifications())


def made(name: str) -> str:
    """Return a table of the page."""
    own = {
        "overview": overview,
        "surest_beliefs": surest_beliefs,
        "calibration_limits": calibration_limits,
        "poses": poses,
        "belief_search": belief_search,
    }
    return own[name]() if name in own else table_of(name.replace("_", "-"))


@cache
def rows(name: str) -> list[Row]:
    """Return the measurements of a check."""
    return PAGE.read(name, Row)


# Tables.


def table_of(name: str) -> str:
    """Return a table with a line per series: the most precise value and the largest deviation."""
    lines = [series_line(list(each)) for _, each in groupby(rows(name), key=lambda row: row.series)]
    header = ["", "values", "most precise at", "measured", "closed form", "largest deviation"]
    return table(header, lines)


def series_line(series: list[Row]) -> list[str]:
    """Return the line of a series."""
    compared = [row for row in series if row.expected is not None]
    best = min(compared or series[-1:], key=lambda row: (row.precision, row.standard_error))
    return [
        series[0].series,
        str(len(series)),
        f"{best.x:g}",
        with_interval(best),
        number(best.expected) if best.expected is not None else "none",
        largest_deviation(compared),
    ]


def largest_deviation(compared: list[Row]) -> str:
    """Return the largest deviation from the closed form."""
    if not compared:
        return ""
    if any(row.standard_error > 0 for row in compared):
        return f"{max(abs(row.sigmas) for row in compared):.1f} standard errors"
    return number(max(abs(row.measured - (row.expected or 0.0)) for row in compared))


def with_interval(row: Row) -> str:
    """Return a value with its 95% interval."""
    if row.standard_error == 0:
        return number(row.measured)
    digits = max(0, 1 - math.floor(math.log10(Z95 * row.standard_error)))
    return interval(row.measured, row.standard_error, digits)


def number(value: float) -> str:
    """Return a number with five digits."""
    return f"{value:.5g}"


def overview() -> str:
    """Return the first table: the claims, and the deviation of the simulator from them."""
    lines = [
        ["random search: 1 - exp(-n w v t / A)", *deviation("random-search")],
        ["lanes: min(1, w v t / A)", *deviation("lanes")],
        ["scans until detection: geometric", *deviation("scans")],
        ["false alarms per scan: Poisson", *deviation("false-alarms")],
        ["search effort at random / in lanes: -ln(1 - p) / p", *deviation("search-effort")],
        ["blind sensors: at most 1 - b is found", *deviation("blind-share")],
        ["items left: Poisson, whatever was found", *deviation("mines-left")],
        ["nothing found in n samples: (1 - θ)^n", *deviation("samples")],
        ["arcs: circles", f"{largest('arcs'):.0e} m off after 100,000 steps", "exact"],
        ["stopping: v² / 2a", f"relative error below {relative('stopping'):.0e}", "exact"],
        [
            "battery: capacity / power",
            f"up to {latest('battery'):.2f} s longer",
            "one step: 0.1 s",
        ],
        ["radio: 1 - loss in range, 0 beyond; delay; capacity", *deviation("radio")],
        ["collisions: two-dimensional gas of discs", *deviation("collisions")],
        ["swarms: order falls with noise (Vicsek 1995)", *deviation("vicsek")],
        ["placement: uniform in the free area", *deviation("placement")],
        ["beliefs: of those with confidence c, the fraction c is true", *deviation("calibration")],
        ["the same with confused kinds and a blind share", *deviation("uncertain-kinds")],
        [
            "poses: 0.989 and 0.997 within three deviations",
            f"at least {min(row.measured for row in rows('poses')):.3f}, up to 2 s late",
            "one-sided",
        ],
    ]
    return table(["claim", "simulated", "largest deviation"], lines)


def surest_beliefs() -> str:
    """Return what is held and the true share of the surest beliefs, by detector."""
    lines = []
    for series, each in groupby(rows("calibration-limits"), key=lambda row: row.series):
        held = list(each)
        groups = [[row for row in held if low <= row.x < high] for low, high in SUREST]
        lines.append([series, *(", ".join(map(held_and_true, group)) for group in groups)])
    return table(["held: true", *(f"{low:g} to {high:g}" for low, high in SUREST)], lines)


def held_and_true(row: Row) -> str:
    """Return the mean confidence of a group of beliefs, and the true share with its interval."""
    return f"{row.x:.4f}: {interval(row.measured, row.standard_error, 4)}"


def calibration_limits() -> str:
    """Return the groups of beliefs that are not calibrated, the worst first."""
    off = [row for row in rows("calibration-limits") if abs(row.sigmas) > MAX_SIGMAS]
    lines = [
        [row.series, f"{row.x:.4f}", f"{row.measured:.4f}", f"{row.sigmas:+.1f}"]
        for row in sorted(off, key=lambda row: -abs(row.sigmas))
    ]
    return table(["", "held", "true", "standard errors"], lines)


def poses() -> str:
    """Return the shares of poses within three stated deviations, by delay."""
    delays = sorted({row.x for row in rows("poses")})
    lines = []
    for series, each in groupby(rows("poses"), key=lambda row: row.series):
        shares = {row.x: f"{row.measured:.3f}" for row in each}
        lines.append([series, *(shares.get(delay, "") for delay in delays)])
    return table(["", *(f"{delay:g} s" for delay in delays)], lines)


def belief_search() -> str:
    """Return the times of both searches, over all worlds."""
    return table(HEADER, compared(PAGE.read("belief-search", dict[str, float])))


def deviation(name: str) -> tuple[str, str]:
    """Return the best precision of a check, and its largest deviation in standard errors."""
    compared = [row for row in rows(name) if row.expected is not None and row.standard_error > 0]
    best = min(row.precision for row in compared)
    precision = f"{len(compared)} values, the most precise to {max(Z95 * best, 0.001):.1%}"
    return precision, largest_deviation(compared)


def largest(name: str) -> float:
    """Return the largest value of the simulator's own series."""
    return max(row.measured for row in rows(name) if "Euler" not in row.series)


def relative(name: str) -> float:
    """Return the largest relative error of a check, to the precision of its file."""
    off = (abs(row.measured / row.expected - 1) for row in rows(name) if row.expected)
    return max(*off, 1e-7)


def latest(name: str) -> float:
    """Return the largest excess over the closed form."""
    return max(row.measured - row.expected for row in rows(name) if row.expected is not None)


# Charts.


def specifications() -> dict[str, Spec]:
    """Return the specification of each chart by its name."""
    return {
        "random-search": random_search(),
        "lanes": simple("lanes", "distance along lanes, m", "fraction of items found"),
        "scans": simple("scans", "scans", "fraction not detected", Axes(y="log", whole=True)),
        "false-alarms": simple(
            "false-alarms", "false alarms per scan", "fraction of scans", Axes(whole=True)
        ),
        "arcs": arcs(),
        "stopping": stopping(),
        "battery": battery(),
        "radio": radio(),
        "collisions": simple("collisions", "robots", "contacts of a robot with others per second"),
        "vicsek": simple("vicsek", "width of noise, rad", "order (length of the mean course)"),
        "placement": placement(),
        "sense": sense(),
        "calibration": calibration(),
        "uncertain-kinds": uncertain_kinds(),
        "search-effort": simple(
            "search-effort", "effort: swept area / area", "fraction of items found"
        ),
        "blind-share": simple(
            "blind-share", "looks of each robot", "fraction of items found", Axes(x="log")
        ),
        "mines-left": mines_left(),
    }


def random_search() -> Spec:
    """Return the fraction found by the swept area, and Koopman's formula."""
    swept = [step / 50 for step in range(101)]
    law = [{"x": x, "y": 1 - math.exp(-x)} for x in swept]
    measured = [row for row in rows("random-search") if row.series != "all"]
    label = text(0.72, 0.62, "1 - exp(-n w v t / A)", INK)
    layers = [path(law), label, *points(measured)]
    return page_of(panel(layers, "swept area n w v t / A", "fraction of items found"))


def text(x: float, y: float, words: str, colour: str) -> Spec:
    """Return words that end at a place."""
    return {
        "data": {"values": [{"x": x, "y": y, "text": words}]},
        "mark": {"type": "text", "align": "right", "color": colour},
        "encoding": {**plain(), "text": {"field": "text"}},
    }


def simple(name: str, x: str, y: str, axes: Axes = LINEAR) -> Spec:
    """Return the values of a check and their closed form."""
    has_series = len({row.series for row in rows(name)}) > 1
    layers = [*curves(rows(name)), *points(rows(name), legend=has_series)]
    return page_of(panel(layers, x, y, axes=axes))


def arcs() -> Spec:
    """Return the distance of bodies from their circles."""
    shown = [row for row in rows("arcs") if row.measured > 0]
    decades = Axes("log", "log", x_ticks=(1, 10, 100, 1000, 10_000, 100_000), y_format=".0e")
    return page_of(panel(connected(shown), "steps", "distance from the circle, m", axes=decades))


def stopping() -> Spec:
    """Return stopping distances, and the speed of a robot that drives towards a wall."""
    left = [*curves(rows("stopping"), "monotone"), *points(rows("stopping"))]
    bound = [{"x": row.x, "y": row.expected} for row in rows("sight")]
    right = [path(bound), *points(rows("sight"), legend=False)]
    return page_of(
        side_by_side(
            panel(left, "speed, m/s", "stopping distance, m", width=WIDTH // 2),
            panel(
                right, "distance from the footprint to the wall, m", "speed, m/s", width=WIDTH // 2
            ),
        )
    )


def battery() -> Spec:
    """Return by how much battery lives exceed capacity / power."""
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
            "battery life - capacity / power, s",
            axes=Axes(x="log", x_ticks=(100, 300, 1000, 3000, 10_000)),
        )
    )


def radio() -> Spec:
    """Return delivery by distance, messages and delay, and ages at a slow brain."""
    panels = [
        (["share delivered"], "distance, m", "fraction delivered"),
        (
            ["messages of one caller", "callers of one message"],
            "messages sent per step",
            "messages received per step",
        ),
        (["age at receipt"], "delay, s", "age at receipt, s"),
        (["ages at a slow brain"], "age at receipt, s", "share of messages"),
    ]
    drawn = []
    for series, x, y in panels:
        some = [row for row in rows("radio") if row.series in series]
        form = staircase() if series == ["age at receipt"] else curves(some)
        layers = [*form, *points(some, legend=len(series) > 1)]
        drawn.append(panel(layers, x, y, width=WIDTH // 2))
    return page_of({"vconcat": [side_by_side(*drawn[:2]), side_by_side(*drawn[2:])]})


def staircase() -> list[Spec]:
    """Return delays rounded up to steps of 0.1 s, with a minimum of one step."""
    delays = [number / 100 for number in range(101)]
    ages = [max(1, math.ceil(delay * 10 - 1e-9)) / 10 for delay in delays]
    stairs = [{"x": x, "y": y} for x, y in zip(delays, ages, strict=True)]
    return [path(stairs, strokeWidth=1, interpolate="step-before")]


def placement() -> Spec:
    """Return the items and robots in each column, relative to the expected fraction."""
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
        panel(
            [one, *points(made)], "x, m", "fraction in the column / fraction of the area", axes=axes
        )
    )


def calibration() -> Spec:
    """Return the fraction of true beliefs by confidence, alone and with radio."""
    panels = []
    for title, radio in (("alone", "alone"), ("with radio", "radio")):
        some = [row for row in rows("calibration") if radio in row.series]
        panels.append(reliability(some, f"confidence, {title}", width=WIDTH // 2))
    return page_of(side_by_side(*panels))


def uncertain_kinds() -> Spec:
    """Return the fraction of true beliefs in uncertain kinds by confidence."""
    return page_of(reliability(rows("uncertain-kinds"), "confidence"))


def reliability(some: list[Row], x: str, width: int = WIDTH) -> Spec:
    """Return the fraction of true beliefs by confidence, and the diagonal."""
    diagonal = path([{"x": 0, "y": 0}, {"x": 1, "y": 1}], strokeWidth=1)
    axes = Axes(x_ticks=(0, 0.2, 0.4, 0.6, 0.8, 1), y_domain=(0, 1))
    return panel([diagonal, *points(some)], x, "fraction true", width=width, axes=axes)


def mines_left() -> Spec:
    """Return the fraction of runs by the mines left, and the mean number left by those found."""
    left = [row for row in rows("mines-left") if row.series != MEAN_LEFT]
    mean = [row for row in rows("mines-left") if row.series == MEAN_LEFT]
    flat = [{"x": row.x, "y": (row.x + 1) * (1 - CLEARANCE) / CLEARANCE} for row in mean]
    right = [
        path(flat, color=GREY, strokeDash=[4, 4]),
        text(7.5, 4.7, "flat prior", GREY),
        *curves(mean),
        *points(mean, legend=False),
    ]
    return page_of(
        side_by_side(
            panel(
                [*curves(left), *points(left)],
                "mines left",
                "fraction of runs",
                width=WIDTH // 2,
                axes=Axes(whole=True),
            ),
            panel(
                right, "mines found", "mean number left", width=WIDTH // 2, axes=Axes(whole=True)
            ),
        )
    )


def together(series: str, column: int, some: list[Row]) -> Row:
    """Return the sum of several fractions, divided by the expected sum."""
    expected = sum(row.expected or 0.0 for row in some)
    error = math.sqrt(sum(row.standard_error**2 for row in some))
    measured = sum(row.measured for row in some)
    x = column + (0.4 if series == "items" else 0.6)
    return Row(series, x, measured / expected, error / expected, None)


def sense() -> Spec:
    """Return mean times by team size, and by maximum speed."""
    panels = []
    kinds = (
        ("robots", "robots", (1.0, 2.0, 4.0, 8.0, 16.0)),
        ("m/s", "maximum speed of four robots, m/s", (0.25, 0.5, 1.0, 2.0)),
    )
    for series, x, ticks in kinds:
        some = [row for row in rows("sense") if row.series == series]
        layers = connected(some, legend=False)
        y = "mean time until all items are found, s"
        times = (50.0, 2000.0)
        axes = Axes("log", "log", x_ticks=ticks, y_ticks=(50, 100, 200, 500, 1000), y_domain=times)
        panels.append(panel(layers, x, y, width=WIDTH // 2, axes=axes))
    return page_of({"hconcat": panels})


if __name__ == "__main__":
    main()

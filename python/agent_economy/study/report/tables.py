"""The tables of a report: the numbers of its charts, as text."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.labels import word
from agent_economy.study.answer.quantiles import Quantile, Quantiles
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.charts import QUANTILES, quantile_row, state, verdict_of
from agent_economy.study.report.factor_charts import mark_of
from agent_economy.study.report.formatting import (
    INFINITE,
    NOTHING,
    UNKNOWN,
    brief,
    decimal,
    percent,
    percent_span,
)
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.view import MAX_SHOWN, factor_name

WIDEST = 10
"""Maximum number of columns of a heat map's table."""


@dataclass(frozen=True)
class Cell:
    """A cell: its text, its interval or status if any, and whether it contains words."""

    text: str
    range: str = ""
    is_words: bool = False


@dataclass(frozen=True)
class Row:
    """A row; its first cell is its header.

    `style` is its CSS class, `configuration` the number of its configuration, if it is about one.
    """

    cells: tuple[Cell, ...]
    style: str = ""
    configuration: int | None = None


@dataclass(frozen=True)
class Table:
    """A table with its caption."""

    caption: str
    heads: tuple[str, ...]
    rows: tuple[Row, ...]


def words(text: str) -> Cell:
    """Return a cell of words."""
    return Cell(text, is_words=True)


def measured(interval: Interval, decimals: int) -> Cell:
    """Return a cell of a mean and its bounds."""
    low, high = decimal(interval.low, decimals), decimal(interval.high, decimals)
    return Cell(decimal(interval.value, decimals), f"{low} to {high}")


def shares(interval: Interval, decimals: int) -> Cell:
    """Return a cell of a share and its bounds."""
    return Cell(percent(interval.value, decimals), percent_span(interval, decimals))


def table(caption: str, heads: tuple[str, ...], rows: Iterable[tuple[Cell, ...]]) -> Table:
    """Return a table whose rows are not about configurations."""
    return Table(caption, heads, tuple(map(Row, rows)))


def by_configuration(
    view: MeritView,
    caption: str,
    heads: tuple[str, ...],
    shown: Iterable[int],
    cells: Callable[[int], Iterable[Cell]],
) -> Table:
    """Return a table with a row per configuration; `cells` returns those after its name."""
    rows = {index: tuple(cells(index)) for index in shown}
    all_heads = ("configuration", *heads)
    return styled(view, caption, all_heads, rows, lambda at: view.result(at).verdict)


def styled(
    view: AnyView,
    caption: str,
    heads: tuple[str, ...],
    cells: Mapping[int, tuple[Cell, ...]],
    style: Callable[[int], str],
) -> Table:
    """Return a table with a row per configuration: its name, its cells, and its style."""
    rows = (Row((words(view.names[at]), *each), style(at), at) for at, each in cells.items())
    return Table(caption, heads, tuple(rows))


def marking(view: AnyView) -> Callable[[int], str]:
    """Return the styles of rows of which only the selected one is marked."""
    return lambda index: "best" if index == view.selected else ""


def merit(view: MeritView) -> Table:
    """Return the table of merit, difference from the selected one, verdict and runs."""
    has_quarantined = any(result.quarantined for result in view.answer.results)

    def cells(index: int) -> Iterable[Cell]:
        result = view.result(index)
        behind = result.standing.behind
        yield words(verdict_of(view, index))
        yield merit_cell(view, index)
        yield measured(behind, view.merit_places) if behind else Cell(NOTHING)
        yield Cell(f"{result.runs:,}")
        if has_quarantined:
            yield Cell(f"{result.quarantined:,}")

    heads = ("verdict", "figure of merit", "difference from selected", "runs")
    shown_heads = (*heads, "quarantined runs") if has_quarantined else heads
    caption = "Figure of merit of each configuration"
    shown = (*view.shown, *view.impossible[:MAX_SHOWN])
    return by_configuration(view, caption, shown_heads, shown, cells)


def merit_cell(view: MeritView, index: int) -> Cell:
    """Return the cell of a configuration's merit; it has none if it cannot be run."""
    if not view.result(index).is_possible:
        return Cell(NOTHING)
    return measured(view.result(index).merit, view.merit_places)


def heat(view: MeritView) -> tuple[Table, ...]:
    """Return the mean merit over two factors; the cells of a heat map's marks have its words."""
    cells = [
        Cell(merit_cell(view, index).text, mark_of(view, index) or "")
        for index in range(len(view.answer.results))
    ]
    return grid(view, "Mean merit", cells)


def grid(view: AnyView, quantity: str, cells: Iterable[Cell]) -> tuple[Table, ...]:
    """Return a cell per configuration over two factors, in tables that fit on a printed page."""
    across, down = view.varied
    placed = {
        (values[across], values[down]): cell
        for values, cell in zip(view.configurations, cells, strict=True)
    }
    columns = tuple(dict.fromkeys(one for one, _ in placed))
    rows = tuple(dict.fromkeys(other for _, other in placed))
    name = f"{quantity}; rows: {factor_name(down)}, columns: {factor_name(across)}"
    return tuple(
        table(
            name,
            ("", *map(written, part)),
            ((words(written(other)), *(placed[one, other] for one in part)) for other in rows),
        )
        for part in (columns[first : first + WIDEST] for first in range(0, len(columns), WIDEST))
    )


def written(value: float | str) -> str:
    """Return a factor's value."""
    return word(value) if isinstance(value, str | bool) else brief(value)


def failed(view: MeritView) -> Table:
    """Return the table of failed runs."""

    def cells(index: int) -> Iterable[Cell]:
        yield shares(view.result(index).failed, view.share_places)
        yield Cell(f"{view.result(index).runs:,}")

    heads = ("failed", "runs")
    return by_configuration(view, "Share of runs that failed", heads, view.shown, cells)


def front(view: MeritView) -> Table:
    """Return the table of price, time, failures and dominance."""

    def cells(index: int) -> Iterable[Cell]:
        result = view.result(index)
        rival = result.place.dominated_by
        yield Cell(decimal(result.place.price, 0 if float(result.place.price).is_integer() else 2))
        yield measured(result.time_s, view.time_places)
        yield shares(result.failed, view.share_places)
        if rival is None:
            yield words("possibly efficient")
        else:
            yield words(f"dominated by {view.names[rival]}")

    caption = "Price, time and failures of each configuration"
    heads = (", ".join(view.price_title), "mean time, s", "failed", "Pareto front")
    return by_configuration(view, caption, heads, view.on_front, cells)


def gains(view: MeritView, found: Saturation) -> Table:
    """Return the table of gains of larger teams."""
    kind = factor_name(found.path)
    rows = (
        (Cell(f"{size:,}"), measured(gain, view.merit_places)) for size, gain in found.gains.items()
    )
    return table(f"Gain of more than {found.base:,} {kind}", (kind, "gain of merit"), rows)


def history(view: MeritView) -> Table:
    """Return the table of runs and eliminations."""

    def cells(index: int) -> Iterable[Cell]:
        out = view.result(index).eliminated
        yield Cell(f"{view.result(index).runs:,}")
        if out:
            yield words(f"eliminated after {out.runs:,} runs")
            yield words(NOTHING if out.by is None else view.names[out.by])
        else:
            yield words(state(view, index))
            yield words(NOTHING)

    caption = "Runs and elimination of each configuration"
    return by_configuration(view, caption, ("runs", "status", "eliminated by"), view.by_runs, cells)


def sensitivity(view: MeritView) -> Table:
    """Return the table of the influence of each factor."""
    found = view.answer.sensitivity
    rows = (
        (words(", ".join(each.paths)), shares(each.alone, 1), shares(each.with_interactions, 1))
        for each in (found.influences if found else ())
    )
    caption = "Share of the variance of the mean merit, with individual 95% intervals"
    return table(caption, ("factor", "alone", "with interactions"), rows)


def efforts(view: MeritView) -> Table:
    """Return the table of predicted runs for smaller deltas."""
    rows = (
        (
            Cell(brief(each.delta)),
            Cell(f"{each.runs:,}"),
            Cell(f"{each.runs / view.answer.runs:,.1f}"),
        )
        for each in view.answer.efforts
    )
    heads = ("delta", "predicted runs", "relative to this study")
    return table("Predicted runs for smaller deltas", heads, rows)


def times(view: MeritView) -> Table:
    """Return the table of quantiles of times."""

    def cells(index: int) -> Iterable[Cell]:
        found = quantile_row(view, index) or {}
        for name in QUANTILES:
            number = found.get(name)
            yield Cell(UNKNOWN if number is None else decimal(number, view.time_places))

    heads = ("5%", "25%", "50% (median)", "75%", "95%")
    return by_configuration(view, "Quantiles of the time of a run, s", heads, view.shown, cells)


def success_times(view: MeritView) -> Table:
    """Return the table of quantiles of the time of success, and of runs without success."""

    def cells(index: int) -> Iterable[Cell]:
        (found,) = view.result(index).quantiles
        yield from quantile_cells(found, view.time_places)

    caption = "Quantiles of the time of success, s, with their intervals"
    return by_configuration(view, caption, QUANTILE_HEADS, view.shown, cells)


QUANTILE_HEADS = ("median", "90%", "95%", "never")
"""The columns of a table of quantiles."""


def quantile_cells(found: Quantiles, decimals: int) -> Iterable[Cell]:
    """Yield the cells of quantiles, and of the share of runs in which the column is infinite."""
    for each in found.quantiles:
        bounds = bounds_of(each, decimals)
        yield Cell(number_or_never(each.value, decimals), bounds)
    yield Cell(percent(found.never, 1))


def bounds_of(quantile: Quantile, decimals: int) -> str:
    """Return the bounds of a quantile: "40 to never", "up to 60", "unknown"."""
    low, high = quantile.low, number_or_never(quantile.high, decimals)
    if low is None:
        return UNKNOWN if high == INFINITE else f"up to {high}"
    first = number_or_never(low, decimals)
    return first if first == high == INFINITE else f"{first} to {high}"


def number_or_never(number: float, decimals: int) -> str:
    """Return a number; "never" if it is infinite."""
    return INFINITE if number == math.inf else decimal(number, decimals)


def published(view: MeritView) -> Table:
    """Return the table of published results."""
    rows = (
        (
            Cell(f"{each.robots:,}"),
            Cell(f"{len(each.times_s):,}"),
            Cell(decimal(each.time_s, view.time_places)),
            shares(each.failed_share, 0),
            measured(each.merit, 2),
        )
        for each in view.answer.published
    )
    heads = ("robots", "runs", "mean time, s", "failed", "figure of merit")
    return table("Published results", heads, rows)

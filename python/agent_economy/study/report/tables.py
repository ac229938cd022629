"""The tables of a report: the numbers of its charts, as text."""

from collections.abc import Iterable
from dataclasses import dataclass

from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.labels import word
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.report.chart_parts import around
from agent_economy.study.report.charts import QUANTILES, quantile_row, state, verdict_of
from agent_economy.study.report.formatting import NOTHING, UNKNOWN, brief, decimal, percent
from agent_economy.study.report.view import View, factor_name

WIDEST = 10
"""Maximum number of columns of a heat map's table."""


@dataclass(frozen=True)
class Cell:
    """A cell: its text, its interval if any, and whether it contains words, not a number."""

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
    low, high = percent(interval.low, decimals), percent(interval.high, decimals)
    return Cell(percent(interval.value, decimals), f"{low} to {high}")


def row(view: View, index: int, cells: Iterable[Cell]) -> Row:
    """Return a configuration's row."""
    style = "best" if index == view.answer.best else view.result(index).standing.verdict
    return Row((words(view.names[index]), *cells), style, index)


def merit(view: View) -> Table:
    """Return the table of merit, difference from the selected one, verdict and runs."""
    has_quarantined = any(result.quarantined for result in view.answer.results)

    def cells(index: int) -> Iterable[Cell]:
        result = view.result(index)
        behind = result.standing.behind
        yield words(verdict_of(view, index))
        yield measured(result.merit, view.merit_places)
        yield measured(behind, view.merit_places) if behind else Cell(NOTHING)
        yield Cell(f"{result.runs:,}")
        if has_quarantined:
            yield Cell(f"{result.quarantined:,}")

    heads = ("configuration", "verdict", "figure of merit", "difference from selected", "runs")
    return Table(
        "Figure of merit of each configuration",
        (*heads, "quarantined runs") if has_quarantined else heads,
        tuple(row(view, index, cells(index)) for index in view.shown),
    )


def heat(view: View) -> tuple[Table, ...]:
    """Return the mean merit over two factors, in tables that fit on a printed page."""
    across, down = view.varied
    merits = {
        (result.values[across], result.values[down]): decimal(result.merit.value, view.merit_places)
        for result in view.answer.results
    }
    columns = tuple(dict.fromkeys(one for one, _ in merits))
    rows = tuple(dict.fromkeys(other for _, other in merits))
    name = f"Mean merit; rows: {factor_name(down)}, columns: {factor_name(across)}"
    return tuple(
        Table(
            name,
            ("", *map(written, part)),
            tuple(
                Row((words(written(other)), *(Cell(merits[one, other]) for one in part)))
                for other in rows
            ),
        )
        for part in (columns[first : first + WIDEST] for first in range(0, len(columns), WIDEST))
    )


def written(value: float | str) -> str:
    """Return a factor's value."""
    return word(value) if isinstance(value, str | bool) else brief(value)


def failed(view: View) -> Table:
    """Return the table of failed runs."""
    return Table(
        "Share of runs that failed",
        ("configuration", "failed", "runs"),
        tuple(
            row(
                view,
                index,
                (
                    shares(view.result(index).failed, view.share_places),
                    Cell(f"{view.result(index).runs:,}"),
                ),
            )
            for index in view.shown
        ),
    )


def front(view: View) -> Table:
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

    return Table(
        "Price, time and failures of each configuration",
        ("configuration", "price, robots", "mean time, s", "failed", "Pareto front"),
        tuple(row(view, index, cells(index)) for index in view.on_front),
    )


def gains(view: View, found: Saturation) -> Table:
    """Return the table of gains of larger teams."""
    kind = factor_name(found.path)
    return Table(
        f"Gain of more than {found.base:,} {kind}",
        (kind, "gain of merit"),
        tuple(
            Row((Cell(f"{size:,}"), measured(gain, view.merit_places)))
            for size, gain in found.gains.items()
        ),
    )


def history(view: View) -> Table:
    """Return the table of runs and eliminations."""

    def cells(index: int) -> Iterable[Cell]:
        out = view.result(index).eliminated
        yield Cell(f"{view.result(index).runs:,}")
        if out:
            yield words(f"eliminated after {out.runs:,} runs")
            yield words(view.names[out.by])
        else:
            yield words(state(view, index))
            yield words(NOTHING)

    return Table(
        "Runs and elimination of each configuration",
        ("configuration", "runs", "status", "eliminated by"),
        tuple(row(view, index, cells(index)) for index in view.by_runs),
    )


def sensitivity(view: View) -> Table:
    """Return the table of the influence of each factor."""
    found = view.answer.sensitivity
    influences = found.influences if found else ()
    return Table(
        "Influence of each factor, with individual 95% bootstrap intervals",
        ("factor", "alone", "with interactions"),
        tuple(
            Row(
                (
                    words(each.path),
                    measured(around(each.first_order, each.first_order_error), 2),
                    measured(around(each.total, each.total_error), 2),
                )
            )
            for each in influences
        ),
    )


def efforts(view: View) -> Table:
    """Return the table of predicted runs for smaller deltas."""
    return Table(
        "Predicted runs for smaller deltas",
        ("delta", "predicted runs", "relative to this study"),
        tuple(
            Row(
                (
                    Cell(brief(each.delta)),
                    Cell(f"{each.runs:,}"),
                    Cell(f"{each.runs / view.answer.runs:,.1f}"),
                )
            )
            for each in view.answer.efforts
        ),
    )


def times(view: View) -> Table:
    """Return the table of quantiles of times."""

    def cells(index: int) -> Iterable[Cell]:
        found = quantile_row(view, index) or {}
        for name in QUANTILES:
            number = found.get(name)
            yield Cell(UNKNOWN if number is None else decimal(number, view.time_places))

    return Table(
        "Quantiles of the time of a run, s",
        ("configuration", "5%", "25%", "50% (median)", "75%", "95%"),
        tuple(row(view, index, cells(index)) for index in view.shown),
    )


def published(view: View) -> Table:
    """Return the table of published results."""
    return Table(
        "Published results",
        ("robots", "runs", "mean time, s", "failed", "figure of merit"),
        tuple(
            Row(
                (
                    Cell(f"{each.robots:,}"),
                    Cell(f"{len(each.times_s):,}"),
                    Cell(decimal(each.time_s, view.time_places)),
                    shares(each.failed_share, 0),
                    measured(each.merit, 2),
                )
            )
            for each in view.answer.published
        ),
    )

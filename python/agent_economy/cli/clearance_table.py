"""The table of lanes that teams declared clear, on the terminal."""

from collections.abc import Sequence

from rich import box
from rich.table import Table
from rich.text import Text

from agent_economy.study.answer.any_answer import AnyResult
from agent_economy.study.answer.clearance import Clearance, percent
from agent_economy.study.answer.evidence import Interval

NAME = 12
"""Minimum width of the name of a configuration."""


def clearance_table(results: Sequence[AnyResult], *, ranges: bool) -> Table | None:
    """Return a table of the given configurations; None if none of them has a lane."""
    known = [(result.label, result.clearance) for result in results if result.clearance]
    if not known:
        return None
    table = Table(
        title=Text("Lanes declared clear; risk: share of these that were not clear"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("configuration", overflow="fold", min_width=NAME)
    for name in ("lanes", "declared", "risk", "stated", "declared after, s"):
        table.add_column(name, justify="right", no_wrap=True)
    for label, of in known:
        table.add_row(Text(label), *cells(of, ranges=ranges))
    return table


def cells(of: Clearance, *, ranges: bool) -> tuple[str, ...]:
    """Return the cells of a configuration after its name."""

    def share(given: Interval) -> str:
        bounds = f" ({percent(given.low)}..{percent(given.high)})" if ranges else ""
        return f"{percent(given.value)}{bounds}"

    return (
        f"{of.lanes:,}",
        share(of.declared_share),
        "not known" if of.risk is None else share(of.risk),
        "" if of.stated_risk is None else percent(of.stated_risk),
        "" if of.declared_s is None else f"{of.declared_s:.0f}",
    )

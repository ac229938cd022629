"""The section on lanes that teams declared clear: the risk beside the share declared; a front."""

from collections.abc import Iterator

from agent_economy.study.answer.clearance import Clearance, in_words, percent
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.verdict import upper
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.formatting import NOTHING, decimal
from agent_economy.study.report.section import Section
from agent_economy.study.report.tables import Cell, Table, marking, styled
from agent_economy.study.report.view import MAX_SHOWN
from agent_economy.study.selection import percentage

HEADS = ("lanes", "declared clear", "risk", "stated risk", "mean time until declared, s")
CLEARED_HEADS = ("cleared", "stated", "stated interval", "in the interval")
VEHICLE_HEADS = ("first lost", "stated", "last lost", "stated")
FRONT_HEADS = ("price", "declared clear", "risk", "mean time of all lanes, s")


def clearance(view: AnyView) -> Section:
    """Return the section on lanes that were declared clear."""
    of = None if view.selected is None else view.result(view.selected).clearance
    own = [f"{upper(in_words(of))}."] if of else []
    meaning = (
        "Risk: the share of the lanes declared clear in which a mine was left. It is not known of "
        "a team that declared none; such a team is not safe. Stated risk: what the controllers "
        "believed, in the mean over the same lanes. Each interval is exact (Clopper and Pearson) "
        "for its own team and a fixed number of runs, with "
        f"{percentage(view.answer.confidence)} confidence; they do not hold simultaneously, and "
        "decide nothing."
    )
    on_front = (
        "On the front, no other team with a declared lane has a price, a time and a risk that are "
        "all at most as high. This holds for these runs, and is not proved. Lanes that were not "
        "declared count with the time limit, and the risk by the upper end of its interval, so "
        "that few declarations do not look safe."
    )
    total = sum(result.clearance is not None for result in view.answer.results)
    shown = len(view.with_clearance)
    some = f"{MAX_SHOWN} of {total:,} configurations are shown; answer.json contains all."
    return Section(
        "Lanes declared clear",
        (*own, meaning, *([on_front] if front(view) else []), *([some] if shown < total else [])),
        tables=(
            table(view),
            *cleared_tables(view),
            *vehicle_tables(view),
            *([front_table(view)] if front(view) else []),
        ),
        is_folded=False,
    )


def table(view: AnyView) -> Table:
    """Return the table of all shown configurations."""
    rows = {
        index: (
            Cell(f"{of.lanes:,}"),
            share(of.declared_share),
            risk(of),
            Cell(NOTHING if of.stated_risk is None else percent(of.stated_risk)),
            seconds(of.declared_s),
        )
        for index, of in view.with_clearance.items()
    }
    caption = "Lanes declared clear, and the share of these that were not clear"
    return styled(view, caption, ("configuration", *HEADS), rows, marking(view))


def cleared_tables(view: AnyView) -> Iterator[Table]:
    """Yield a table for each kind of mines: the share that is cleared, in the mean."""
    shown = view.with_clearance.items()
    for kind in dict.fromkeys(each.kind for _, of in shown for each in of.cleared):
        rows = {
            index: (
                Cell(percent(each.share)),
                Cell(percent(each.stated)),
                Cell(f"{percent(each.low)} to {percent(each.high)}"),
                Cell(percent(each.inside)),
            )
            for index, of in shown
            for each in of.cleared
            if each.kind == kind
        }
        caption = (
            f"Share of {kind} that was cleared in declared lanes, in the mean; a lane without any "
            "counts as cleared"
        )
        yield styled(view, caption, ("configuration", *CLEARED_HEADS), rows, marking(view))


def vehicle_tables(view: AnyView) -> Iterator[Table]:
    """Yield the table of vehicles that passed declared lanes, if there were any."""
    rows = {
        index: (
            share(of.vehicles.first_lost),
            Cell(percent(of.vehicles.first_stated)),
            share(of.vehicles.last_lost),
            Cell(percent(of.vehicles.last_stated)),
        )
        for index, of in view.with_clearance.items()
        if of.vehicles is not None
    }
    if rows:
        caption = "Lanes in which the first and the last vehicle were lost"
        yield styled(view, caption, ("configuration", *VEHICLE_HEADS), rows, marking(view))


def front_table(view: AnyView) -> Table:
    """Return the table of the configurations on the front, the cheapest first."""
    rows = {
        index: (
            Cell(f"{view.price(index):,.12g}"),
            share(of.declared_share),
            risk(of),
            seconds(of.cleared_s),
        )
        for index, of in front(view).items()
    }
    caption = "Front of price, time and risk"
    return styled(view, caption, ("configuration", *FRONT_HEADS), rows, marking(view))


def front(view: AnyView) -> dict[int, Clearance]:
    """Return the configurations that no other one dominates, the cheapest first; none of one."""
    points = {
        index: (view.price(index), of.cleared_s, of.risk.high)
        for index, of in view.with_clearance.items()
        if of.risk is not None and of.cleared_s is not None
    }
    if len(points) == 1:
        return {}
    best = (
        index
        for index, point in points.items()
        if not any(dominates(other, point) for other in points.values())
    )
    return {index: view.with_clearance[index] for index in sorted(best, key=points.__getitem__)}


def dominates(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Return whether a point is nowhere higher than another, and differs from it."""
    return one != other and all(low <= high for low, high in zip(one, other, strict=True))


def share(interval: Interval) -> Cell:
    """Return the cell of a share and its bounds."""
    bounds = f"{percent(interval.low)} to {percent(interval.high)}"
    return Cell(percent(interval.value), bounds)


def risk(of: Clearance) -> Cell:
    """Return the cell of the share of declared lanes that were not clear."""
    return Cell("not known") if of.risk is None else share(of.risk)


def seconds(time_s: float | None) -> Cell:
    """Return the cell of a time."""
    return Cell(NOTHING if time_s is None else decimal(time_s, 0))

"""The sections of a report about a requirement: notes, charts and tables."""

from collections.abc import Iterator

from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.answer.requirement_words import spare_of
from agent_economy.study.report import tables
from agent_economy.study.report.clearance_section import clearance
from agent_economy.study.report.formatting import NOTHING, percent, places
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.section import Picture, Section
from agent_economy.study.report.sections import goal_time
from agent_economy.study.report.tables import (
    QUANTILE_HEADS,
    Cell,
    Table,
    quantile_cells,
    shares,
    styled,
    words,
)
from agent_economy.study.report.view import MAX_SHOWN, factor_name
from agent_economy.study.selection import percentage


def requirement_sections(view: RequirementView) -> Iterator[Section]:
    """Return the sections that the answer has data for."""
    yield share(view)
    if view.is_grid:
        yield heat(view)
    if view.with_clearance:
        yield clearance(view)
    yield failing(view)
    if view.compared_distributions:
        yield distribution(view)
    if view.with_goal_time:
        yield goal_time(view)
    if view.has_prices:
        yield Section("Price", (), (Picture("price", "Price and share of missions that meet it"),))


def share(view: RequirementView) -> Section:
    """Return the section on the share of missions that meet the requirement."""
    requirement = view.answer.requirement
    low, high = percentage(requirement.probability), spare_of(requirement)
    confidently = f"with {percentage(view.answer.confidence)} confidence"
    lines = (
        f"The line is the required share, {low}; the band above it is the tolerance, up to {high}. "
        f"A team is certified when its share is shown to be at least {low}, and refuted when it is "
        f"shown to be below {low}. One that is shown to be below {high} only may meet the "
        "requirement."
    )
    statements = (
        f"These are statements of their own: what is certified, and what is below {high}, belongs "
        f"to the promise above; the intervals hold simultaneously for all teams, {confidently}, "
        "and decide nothing."
    )
    some = (
        f"{MAX_SHOWN} of {len(view.known):,} teams with runs are shown; answer.json contains all."
    )
    notes = [lines, statements, *([some] if len(view.known) > MAX_SHOWN else [])]
    picture = Picture("share", "Share of missions that meet the requirement, with its interval")
    return Section(
        "Missions that meet the requirement",
        tuple(notes),
        (picture,),
        (table(view),),
        is_folded=False,
    )


def heat(view: RequirementView) -> Section:
    """Return the section on the share over two factors."""
    across, down = map(factor_name, view.varied)
    shows = "Share of missions that meet the requirement; the selected team is framed"
    note = (
        "The mark of a cell is the status of its team. A cell without colour has no runs, and the "
        "share of a team that is open or not needed may be of few runs."
    )
    heading = f"Missions that meet it by {across} and {down}"
    cells = map(heat_cell, view.answer.results)
    found = tables.grid(view, "Share of missions and status", cells)
    return Section(heading, (note,), (Picture("heat", shows),), found)


def heat_cell(result: RequirementResult) -> Cell:
    """Return the cell of the share and the status of a team."""
    if result.met is None or not result.is_possible:
        return Cell(NOTHING, result.status)
    return Cell(percent(result.met.value, 1), result.status)


def table(view: RequirementView) -> Table:
    """Return the table of all shown teams, and of those of the same cost as the selected one."""

    def row(index: int) -> tuple[Cell, ...]:
        result = view.result(index)
        met = shares(result.met, 1) if result.met else Cell(NOTHING)
        cost = Cell(f"{result.cost:,.12g}")
        return cost, words(result.status), met, Cell(f"{result.runs:,}")

    rows = {index: row(index) for index in (*view.shown, *others(view))}
    heads = ("team", view.answer.cost, "status", "share that meets it", "runs")
    return styled(view, "Share of missions that meet the requirement", heads, rows, view.style)


def others(view: RequirementView) -> tuple[int, ...]:
    """Return the teams of the same cost as the selected one, and those that cannot be run."""
    selected = view.answer.selected
    cost = None if selected is None else view.result(selected).cost
    results = enumerate(view.answer.results)
    found = (at for at, each in results if each.cost == cost or not each.is_possible)
    return tuple(found)[:MAX_SHOWN]


def failing(view: RequirementView) -> Section:
    """Return the section on why missions did not meet the requirement."""
    conditions = [each.text for each in view.answer.requirement.conditions]

    rows = {
        index: tuple(Cell(percent(each, 1)) for each in failing)
        for index in view.shown
        for failing in [view.result(index).failing]
    }
    note = "A mission may fail several conditions. A time of a mission without success is infinite."
    caption = "Share of missions in which a condition does not hold"
    found = styled(view, caption, ("team", *conditions), rows, lambda _: "")
    picture = Picture("failing", "Share of missions in which each condition does not hold")
    return Section("Why missions failed", (note,), (picture,), (found,))


def distribution(view: RequirementView) -> Section:
    """Return the section on the distribution of the deciding column."""
    condition = view.deciding_condition
    teams = " and ".join(view.names[index] for index in view.compared_distributions)
    fails = (
        f"{condition.text} is the condition that fails most often."
        if view.fails(condition)
        else "No mission of these teams failed a condition."
    )
    note = (
        f"{fails} The band around each distribution is valid at any time; both together with "
        f"{percentage(view.answer.confidence)} confidence."
    )
    picture = Picture("distribution", f"Distribution of {condition.column}: {teams}")
    return Section("The deciding condition", (note,), (picture,), (quantiles(view),))


def quantiles(view: RequirementView) -> Table:
    """Return the table of quantiles of the column of the deciding condition."""
    column = view.deciding_condition.column
    decimals = places(view.deciding_condition.value / 50)
    rows = {
        index: tuple(quantile_cells(each, decimals))
        for index in view.shown
        for each in view.result(index).quantiles
        if each.column == column
    }
    caption = f"Quantiles of {column}, with their intervals"
    return styled(view, caption, ("team", *QUANTILE_HEADS), rows, view.style)

"""The table of an answer about a requirement on the terminal."""

from rich import box
from rich.table import Table
from rich.text import Text

from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import RequirementResult

NAME = 12
"""Minimum width of the name of a configuration."""

MAX_ROWS = 20
"""Maximum number of configurations in a table."""

DECIDED = {"selected": "bold", "refuted": "dim", "not needed": "dim", "impossible": "dim"}
"""The style of each status that has one."""


def requirement_table(answer: RequirementAnswer, *, ranges: bool) -> Table:
    """Return a table of the teams by their cost, with ranges or without."""
    shown = by_cost(answer)
    left_out = len(answer.results) - len(shown)
    table = Table(
        title=Text(answer.scenario.summary),
        caption=f"and {left_out} more, in answer.json" if left_out else None,
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("configuration", overflow="fold", min_width=NAME)
    for name in (answer.cost, "runs", "met", "most frequent failure", ""):
        table.add_column(name, justify="right", no_wrap=name != "most frequent failure")
    for result in shown:
        table.add_row(
            Text(result.label),
            f"{result.cost:,.12g}",
            f"{result.runs:,}" if result.runs else "",
            met(result, ranges=ranges),
            Text(failure(answer, result)),
            result.status,
            style=DECIDED.get(result.status),
        )
    return table


def met(result: RequirementResult, *, ranges: bool) -> str:
    """Return the share of missions that meet the requirement."""
    if result.met is None or not result.is_possible:
        return ""
    value, low, high = result.met.value, result.met.low, result.met.high
    return f"{value:.1%} ({low:.1%}..{high:.1%})" if ranges else f"{value:.1%}"


def failure(answer: RequirementAnswer, result: RequirementResult) -> str:
    """Return the condition that fails most often, and in which share of missions."""
    if not any(result.failing) or not result.is_possible:
        return ""
    worst = max(range(len(result.failing)), key=result.failing.__getitem__)
    condition = answer.requirement.conditions[worst].text
    return f"{condition}: {result.failing[worst]:.1%}"


def by_cost(answer: RequirementAnswer) -> list[RequirementResult]:
    """Return the teams by their cost; of many, the selected one and those next to it."""
    ordered = sorted(answer.results, key=lambda result: result.cost)
    if len(ordered) <= MAX_ROWS:
        return ordered
    selected = (at for at, result in enumerate(ordered) if result.status == "selected")
    known = max((at for at, result in enumerate(ordered) if result.runs), default=0)
    last = min(len(ordered), max(MAX_ROWS, next(selected, known) + MAX_ROWS // 4))
    return ordered[last - MAX_ROWS : last]

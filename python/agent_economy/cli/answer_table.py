"""An answer on the terminal."""

from pathlib import Path

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy.cli.clearance_table import clearance_table
from agent_economy.cli.requirement_table import by_cost, requirement_table
from agent_economy.cli.whole_table import print_whole
from agent_economy.study import files
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.goal_time import GoalTime, in_words
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.results import Result
from agent_economy.study.answer.verdict import repeated, upper

WIDE = 118
"""Width of a table with ranges, and of output that is not a terminal."""

NAME = 12
"""Minimum width of the name of a configuration."""

MAX_ROWS = 20
"""Maximum number of configurations in a table."""


def show(answer: AnyAnswer, report: Path | None, *, as_json: bool) -> None:
    """Print an answer: as JSON, or as a table, a sentence and the path of the report if it has."""
    if as_json:
        typer.echo(files.as_json(answer), nl=False)
        return
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    is_wide = console.width >= WIDE
    if isinstance(answer, RequirementAnswer):
        table, precision = requirement_table(answer, ranges=is_wide), ""
        lanes = clearance_table(by_cost(answer), ranges=is_wide)
    else:
        table, precision = results_table(answer, ranges=is_wide), f"delta {answer.delta:g}, "
        lanes = clearance_table(best_first(answer)[:MAX_ROWS], ranges=is_wide)
    print_whole(table, console, NAME)
    if lanes:
        print_whole(lanes, console, NAME)
    first, *lines, small = answer.verdict
    console.print(first, style="bold", markup=False, emoji=False)
    for line in lines:
        console.print(line, markup=False, emoji=False)
    if time := selected_goal_time(answer):
        console.print(upper(in_words(time)), markup=False, emoji=False)
    console.print(f"{small}\n", style="dim", markup=False, emoji=False)
    console.print(
        f"{answer.guarantee} ({precision}{answer.runs:,} runs)\n",
        markup=False,
        emoji=False,
    )
    if len(answer.questions) > 1:
        typer.echo(f"{repeated(answer.questions)}\n")
    if report:
        typer.echo(f"Report: {report}")


def selected_goal_time(answer: AnyAnswer) -> GoalTime | None:
    """Return where the time of a goal goes with the selected team; None if it has no goals."""
    index = answer.selected if isinstance(answer, RequirementAnswer) else answer.best
    return None if index is None else answer.results[index].goal_time


def results_table(answer: Answer, *, ranges: bool) -> Table:
    """Return a table of the best configurations, with ranges or without."""

    def failed(result: Result) -> str:
        if not result.is_possible:
            return ""
        if result.failed.value == 0:
            return f"none (..{result.failed.high:.2%})" if ranges else "none"
        return cell(result.failed, "z.2%")

    def cell(given: Interval, style: str) -> str:
        value, low, high = (format(each, style) for each in (given.value, given.low, given.high))
        return f"{value} ({low}..{high})" if ranges else value

    shown = best_first(answer)[:MAX_ROWS]
    left_out = len(answer.results) - len(shown)
    caption = f"and {left_out} more, in answer.json" if left_out else None
    table = Table(
        title=Text(answer.scenario.summary),
        caption=caption,
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("configuration", overflow="fold", min_width=NAME)
    has_quarantined = any(result.quarantined for result in answer.results)
    names = ["runs", "quarantined"] if has_quarantined else ["runs"]
    for name in (*names, "time, s", "failed", "merit", "behind", ""):
        table.add_column(name, justify="right", no_wrap=True)
    for result in shown:
        counts = [result.runs, result.quarantined][: len(names)]
        table.add_row(
            Text(result.label),
            *(f"{count:,}" for count in counts),
            cell(result.time_s, "z.1f") if result.is_possible else "",
            failed(result),
            cell(result.merit, "z.2f") if result.is_possible else "",
            f"{result.standing.behind.value:z.3f}" if result.standing.behind else "",
            result.standing.verdict,
            style="bold" if result is answer.results[answer.best] else None,
        )
    return table


def best_first(answer: Answer) -> list[Result]:
    """Return all results in the configurations' order if they all fit, else the best ones first."""
    if len(answer.results) <= MAX_ROWS:
        return list(answer.results)
    chosen = answer.results[answer.best]
    others = [result for result in answer.results if result is not chosen]

    def rank(result: Result) -> tuple[bool, float]:
        return not result.is_possible, -result.merit.value

    return [chosen, *sorted(others, key=rank)]

"""An answer on the terminal."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy.cli.clearance_table import clearance_table
from agent_economy.cli.whole_table import print_whole
from agent_economy.study import files
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.goal_time import in_words
from agent_economy.study.answer.verdict import repeated, upper

WIDE = 118
"""Width of a table with ranges, and of output that is not a terminal."""

NAME = 12
"""Minimum width of the name of a configuration."""

MAX_ROWS = 20
"""Maximum number of configurations in a table."""

WRAPPED = "most frequent failure"
"""The column of words, which may take several lines."""


def show(answer: AnyAnswer, report: Path | None, *, as_json: bool) -> None:
    """Print an answer: as JSON, or as a table, a sentence and the path of the report if it has."""
    if as_json:
        typer.echo(files.as_json(answer), nl=False)
        return
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    is_wide = console.width >= WIDE
    lanes = clearance_table(answer.foremost(MAX_ROWS), ranges=is_wide)
    place = ", in answer.json" if report else ""
    print_whole(results_table(answer, place, ranges=is_wide), console, NAME)
    if lanes:
        print_whole(lanes, console, NAME)
    first, *lines, small = answer.verdict
    console.print(first, style="bold", markup=False, emoji=False)
    for line in lines:
        console.print(line, markup=False, emoji=False)
    if answer.chosen and answer.chosen.goal_time:
        console.print(upper(in_words(answer.chosen.goal_time)), markup=False, emoji=False)
    console.print(f"{small}\n", style="dim", markup=False, emoji=False)
    console.print(
        f"{answer.guarantee} ({answer.precision}{answer.runs:,} runs)\n",
        markup=False,
        emoji=False,
    )
    if len(answer.questions) > 1:
        typer.echo(f"{repeated(answer.questions)}\n")
    if report:
        typer.echo(f"Report: {report}")


def results_table(answer: AnyAnswer, place: str, *, ranges: bool) -> Table:
    """Return a table of the foremost configurations, with ranges or without.

    Args:
        answer: The answer.
        place: Where the others are, as the end of a line; empty for the answer of a stopped study,
            which is not in a file.
        ranges: Whether with ranges.
    """
    shown: Sequence[Any] = answer.foremost(MAX_ROWS)
    left_out = len(answer.results) - len(shown)
    table = Table(
        title=Text(answer.scenario.summary),
        caption=f"and {left_out} more{place}" if left_out else None,
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
    )
    table.add_column("configuration", overflow="fold", min_width=NAME)
    for name in answer.heads:
        table.add_column(name, justify="right", no_wrap=name != WRAPPED)
    for result in shown:
        cells = (result.label, *answer.cells(result, ranges=ranges))
        table.add_row(*map(Text, cells), style=answer.style(result))
    return table

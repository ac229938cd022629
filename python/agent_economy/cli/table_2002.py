"""Prints a drive beside the program of 2002."""

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy.cli.whole_table import print_whole
from agent_economy.live.program_2002 import Comparison, Course

MIN_NAME = 8


def print_comparison(comparison: Comparison) -> None:
    """Print a row whenever one of the two programs sends something else, then how 2002 ended."""
    table = Table(title=comparison.robot, title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("time, s", justify="right")
    for name in ("2002 sends", "behaviour", "bearing, error", "heading age, s"):
        table.add_column(name, no_wrap=True)
    for name in ("sent", "bearing, error"):
        table.add_column(name, no_wrap=True)
    for row in comparison.rows:
        table.add_row(
            f"{row.time_s:.2f}",
            Text(lines(row.sent_2002)),
            row.behaviour_2002,
            course(row.course_2002),
            f"{row.heading_age_s:.1f}",
            Text(lines(row.sent)),
            course(row.course),
        )
    print_whole(table, Console(highlight=False), MIN_NAME)
    typer.echo(ending(comparison))


def lines(sent: tuple[tuple[str, str], ...]) -> str:
    """Return lines with the ports of those that are not for the motors."""
    return " ".join(line if port == "motors" else f"{port}: {line}" for port, line in sent)


def course(given: Course | None) -> str:
    """Return a bearing and a course error in degrees."""
    return "" if given is None else f"{given.bearing_deg:.1f}, {given.difference_deg:.1f}"


def ending(comparison: Comparison) -> str:
    """Return how the program of 2002 stands at the end of the recording."""
    unread = ", ".join(f"{count:,} of {port}" for port, count in comparison.unread.items())
    left = f" Lines that it had not read: {unread}." if unread else ""
    if comparison.ended is not None:
        return f"The program of 2002 ended: {comparison.ended}; the robot drives on.{left}"
    waited = f"had waited {comparison.waits_s:.1f} s for a line of {comparison.waits_for}"
    return f"At the end, the program of 2002 {waited}.{left}"

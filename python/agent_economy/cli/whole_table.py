"""Prints tables of which no column is lost, however narrow the terminal is."""

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

LONGEST = 100_000
"""A width that no table exceeds."""


def print_whole(table: Table, console: Console, min_name: int) -> None:
    """Print a table with all of its columns.

    On a terminal, the first column is folded where that helps, to `min_name` characters at least.
    If the terminal is narrower still, it wraps the lines itself. Elsewhere, each row is one line,
    for programs that read it.
    """
    name = table.columns[0]
    name.max_width = min_name if console.is_terminal else None
    options = console.options.update(max_width=LONGEST)
    needed = Measurement.get(console, options, table).maximum
    name.max_width = None
    Console(highlight=False, width=max(console.width, needed)).print(table)

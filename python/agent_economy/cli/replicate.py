"""The command `replicate`."""

import io
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import numpy as np
import pyarrow as pa
import typer
from pyarrow import csv, parquet
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy import api
from agent_economy._core import InputError
from agent_economy.cli.answer_table import WIDE
from agent_economy.cli.errors import error_exits, print_warnings
from agent_economy.cli.options import ScenarioArgument, Seed, Sets, overrides
from agent_economy.cli.run_progress import progress_bar
from agent_economy.cli.run_summary import Summary, quarantined, summarised
from agent_economy.cli.whole_table import print_whole
from agent_economy.runs.outcome import find_times, without_items
from agent_economy.runs.quarantine import reason
from agent_economy.scenario import Scenario
from agent_economy.study.store.folder import write_whole
from agent_economy.whole_file import check_writable, remove_abandoned

WRITERS: dict[str, Callable[[pa.Table, io.BytesIO], None]] = {
    ".parquet": parquet.write_table,
    ".csv": csv.write_csv,
}
"""Writers of a table, by file extension."""

PART_S = 1.0
"""Approximate time between progress updates."""

PER_THREAD = 4
"""Minimum number of runs per thread in a block: some take longer than others."""

NOT_COUNTED = "not counted"
"""The mean of a quantity that no robot has."""

WHOLE = 1000
"""Numbers from here on are shown without a fraction."""


def replicate(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[Path, ScenarioArgument],
    *,
    count: Annotated[
        int, typer.Option("--runs", min=1, max=10_000_000, help="Number of runs.")
    ] = 1000,
    seed: Seed = 0,
    threads: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=1024,
            help="Number of threads; results do not depend on it.",
            show_default="one per processor",
        ),
    ] = None,
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write all runs to this file: NAME.parquet or NAME.csv; if it is a symbolic link, "
            "to its target.",
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the summary as JSON instead of a table.")
    ] = False,
) -> None:
    """Run a scenario many times and print means with 95% confidence intervals.

    Exit codes: 0 success; 1 the file cannot be written; 2 an argument or the scenario is invalid;
    130 stopped by Ctrl-C.

    Example: agent-economy replicate search --runs 1000 --out runs.parquet
    """
    with error_exits():
        writer = None if out is None else writer_of(out)
        given = Scenario.load(scenario, overrides(sets))
        print_warnings(given.warnings)
        table = watched(given, count, seed, threads)
        if writer and out:
            buffer = io.BytesIO()
            writer(table, buffer)
            remove_abandoned(out.parent)
            write_whole(out, buffer.getvalue())
    summary, note = summarised(given, table), quarantine_note(given, seed, table)
    if note:
        typer.echo(note, err=True)
    if as_json:
        head = {"scenario": given.name, "seed": seed, "runs": count}
        head |= {"quarantined": int(quarantined(table).sum())}
        typer.echo(json.dumps({**head, "columns": summary}, indent=2, allow_nan=False))
    else:
        show(f"{given.name}, seed {seed}, {count:,} runs", summary)
    if out:
        typer.echo(f"All runs: {out}", err=as_json)


def writer_of(out: Path) -> Callable[[pa.Table, io.BytesIO], None]:
    """Return the writer for a file name; checked before the first run, not after the last.

    Raises:
        InputError: If the extension is unknown or the file cannot be written.
    """
    writer = WRITERS.get(out.suffix)
    if writer is None:
        message = f"--out {out}: must end in one of {', '.join(WRITERS)}"
        raise InputError(message)
    if not out.parent.is_dir():
        message = f"--out {out}: must be in an existing folder; {out.parent} is not one"
        raise InputError(message)
    if out.is_dir():
        message = f"--out {out}: must be a file; it is a folder"
        raise InputError(message)
    try:
        check_writable(out)
    except OSError as error:
        message = f"--out {out}: is not writable: {error.strerror or error}"
        raise InputError(message) from None
    return writer


def watched(scenario: Scenario, count: int, seed: int, threads: int | None) -> pa.Table:
    """Run in blocks, with a progress bar if it takes long."""
    least = PER_THREAD * (threads or os.cpu_count() or 1)
    begin = time.monotonic()
    tables: list[pa.Table] = []
    done, part = 0, least
    with progress_bar(count, "runs") as report:
        while done < count:
            report(done)
            part = min(part, count - done)
            tables.append(api.replicate(scenario, part, seed, threads, first_run=done))
            done += part
            rate = done / max(time.monotonic() - begin, 1e-9)
            part = max(least, int(rate * PART_S))
    return pa.concat_tables(tables)


def quarantine_note(scenario: Scenario, seed: int, table: pa.Table) -> str:
    """Return how many runs were quarantined, why the first was, and how they count."""
    runs = np.flatnonzero(quarantined(table))
    if not len(runs):
        return ""
    are = "was" if len(runs) == 1 else "were"
    return (
        f"{len(runs):,} of {table.num_rows:,} runs {are} quarantined "
        f"({reason(scenario, seed, int(runs[0]))}). Such runs count as the worst possible in time, "
        "completion, items found and missed, goals served and merit; other means leave them out."
    )


def show(title: str, summary: Summary) -> None:
    """Print a summary as a table, without the times of finds, and without items if it has none."""
    columns = [row["column"] for row in summary]
    left_out = find_times(columns) | without_items(columns)
    summary = [row for row in summary if row["column"] not in left_out]
    table = Table(title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("", no_wrap=True)
    for name in ("runs", "mean", "95% interval", "minimum", "maximum"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in summary:
        low, high = row["low"], row["high"]
        interval = "" if low is None else f"{cell(low)} .. {cell(high)}"
        ends = [cell(row["minimum"]), cell(row["maximum"])]
        mean = NOT_COUNTED if row["column"] == "energy_j" and not row["runs"] else cell(row["mean"])
        table.add_row(row["column"], f"{row['runs']:,}", mean, interval, *ends)
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    print_whole(table, console, max(len(row["column"]) for row in summary))


def cell(value: float | None) -> str:
    """Return a number with a readable number of digits."""
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= WHOLE else f"{value + 0.0:.4g}"

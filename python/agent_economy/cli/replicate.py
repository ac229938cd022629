"""The command `replicate`."""

import io
import json
import os
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pyarrow as pa
import typer
from pyarrow import csv, parquet
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy import api, arrow
from agent_economy._core import InputError
from agent_economy.cli.answer_table import WIDE
from agent_economy.cli.errors import error_exits
from agent_economy.cli.options import ScenarioArgument, Seed, Sets, overrides
from agent_economy.cli.run_progress import progress_bar
from agent_economy.cli.whole_table import print_whole
from agent_economy.scenario import Scenario
from agent_economy.study.answer import estimate
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.store.folder import check_writable, write_whole

WRITERS: dict[str, Callable[[pa.Table, io.BytesIO], None]] = {
    ".parquet": parquet.write_table,
    ".csv": csv.write_csv,
}
"""Writers of a table, by file extension."""

PART_S = 1.0
"""Approximate time between progress updates."""

PER_THREAD = 4
"""Minimum number of runs per thread in a block: some take longer than others."""

WHOLE = 1000
"""Numbers from here on are shown without a fraction."""

Summary = list[dict[str, Any]]


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
        table = watched(given, count, seed, threads)
        if writer and out:
            buffer = io.BytesIO()
            writer(table, buffer)
            write_whole(out, buffer.getvalue())
    summary = summarized(table)
    if as_json:
        head = {"scenario": given.name, "seed": seed, "runs": count}
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


def summarized(table: pa.Table) -> Summary:
    """Return the mean of each column with its 95% interval; for a flag, the share."""
    columns = [name for name in table.column_names if name != "run"]
    return [{"column": name, **summary_of(table[name].drop_null())} for name in columns]


def summary_of(values: pa.ChunkedArray) -> dict[str, Any]:
    """Return the number of runs with a value, their mean, its interval, minimum and maximum."""
    count = len(values)
    if count == 0:
        return dict.fromkeys(("mean", "low", "high", "minimum", "maximum")) | {"runs": 0}
    if pa.types.is_boolean(values.type):
        share = estimate.share(int(arrow.numbers(values).sum()), count)
        return {"runs": count, **renamed(share), "minimum": None, "maximum": None}
    numbers = arrow.numbers(values).astype(np.float64)
    ends = {"minimum": float(numbers.min()), "maximum": float(numbers.max())}
    if count == 1:
        return {"runs": count, "mean": ends["minimum"], "low": None, "high": None, **ends}
    return {"runs": count, **renamed(estimate.mean(numbers)), **ends}


def renamed(interval: Interval) -> dict[str, float]:
    """Return an interval with the names of a summary."""
    given = asdict(interval)
    return {"mean": given.pop("value"), **given}


def show(title: str, summary: Summary) -> None:
    """Print a summary as a table."""
    table = Table(title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("", no_wrap=True)
    for name in ("runs", "mean", "95% interval", "minimum", "maximum"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in summary:
        low, high = row["low"], row["high"]
        interval = "" if low is None else f"{cell(low)} .. {cell(high)}"
        ends = [cell(row["minimum"]), cell(row["maximum"])]
        table.add_row(row["column"], f"{row['runs']:,}", cell(row["mean"]), interval, *ends)
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    print_whole(table, console, max(len(row["column"]) for row in summary))


def cell(value: float | None) -> str:
    """Return a number with a readable number of digits."""
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= WHOLE else f"{value:.4g}"

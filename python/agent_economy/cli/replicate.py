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

from agent_economy import api
from agent_economy._core import InputError
from agent_economy.cli.gauge import gauge
from agent_economy.cli.given import Seed, Sets, overrides
from agent_economy.cli.table import WIDE
from agent_economy.cli.told import faults_told
from agent_economy.scenario import Scenario
from agent_economy.study.answer import estimate
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.store.folder import try_out, write_whole

WRITERS: dict[str, Callable[[pa.Table, io.BytesIO], None]] = {
    ".parquet": parquet.write_table,
    ".csv": csv.write_csv,
}
"""What writes a table, by the ending of the file's name."""

PART_S = 1.0
"""About how long runs go on between two words of progress."""

PER_THREAD = 4
"""Least runs that a thread gets at once: some take longer than others."""

WHOLE = 1000
"""From here on, numbers are shown without a fraction."""

Summary = list[dict[str, Any]]


def replicate(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[
        Path, typer.Argument(help="A scenario's TOML file, or the name of one.", show_default=False)
    ],
    *,
    count: Annotated[int, typer.Option("--runs", min=1, max=10_000_000, help="How many.")] = 1000,
    seed: Seed = 0,
    threads: Annotated[
        int | None,
        typer.Option(min=1, max=1024, help="Changes no result.", show_default="one a processor"),
    ] = None,
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option(help="File for all runs: NAME.parquet or NAME.csv.", show_default=False),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the summary as JSON instead of the table.")
    ] = False,
) -> None:
    """Run a scenario many times, and tell the means with their 95% intervals.

    Exit codes: 0 all is run, 1 the file cannot be written, 2 something given is not allowed,
    130 stopped by Ctrl-C.

    Example: agent-economy replicate search --runs 1000 --out runs.parquet
    """
    with faults_told():
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
    """Return what writes a file of a name.

    Raises:
        InputError: If nothing does, or the file cannot be written: before the first run, not after
            the last.
    """
    writer = WRITERS.get(out.suffix)
    if writer is None:
        message = f"--out {out}: must end in one of {', '.join(WRITERS)}"
        raise InputError(message)
    if not out.parent.is_dir():
        message = f"--out {out}: must be in a folder that is there; {out.parent} is none"
        raise InputError(message)
    if out.is_dir():
        message = f"--out {out}: must be a file, and is a folder"
        raise InputError(message)
    try:
        try_out(out)
    except OSError as error:
        message = f"--out {out}: must be where files can be written: {error.strerror or error}"
        raise InputError(message) from None
    return writer


def watched(scenario: Scenario, count: int, seed: int, threads: int | None) -> pa.Table:
    """Run many times, part by part, and show how far it is if that takes long."""
    least = PER_THREAD * (threads or os.cpu_count() or 1)
    begin = time.monotonic()
    tables: list[pa.Table] = []
    done, part = 0, least
    with gauge(count, "runs") as tell:
        while done < count:
            tell(done)
            part = min(part, count - done)
            tables.append(api.replicate(scenario, part, seed, threads, first_run=done))
            done += part
            rate = done / max(time.monotonic() - begin, 1e-9)
            part = max(least, int(rate * PART_S))
    return pa.concat_tables(tables)


def summarized(table: pa.Table) -> Summary:
    """Return the mean of each column with its 95% interval; of a flag, the share."""
    columns = [name for name in table.column_names if name != "run"]
    return [{"column": name, **summary_of(table[name].drop_null())} for name in columns]


def summary_of(values: pa.ChunkedArray) -> dict[str, Any]:
    """Return runs with a value, and their mean, its interval, the least and the greatest."""
    count = len(values)
    if count == 0:
        return dict.fromkeys(("mean", "low", "high", "least", "greatest")) | {"runs": 0}
    if pa.types.is_boolean(values.type):
        share = estimate.share(values.to_numpy().sum().item(), count)
        return {"runs": count, **renamed(share), "least": None, "greatest": None}
    numbers = values.to_numpy().astype(np.float64)
    ends = {"least": float(numbers.min()), "greatest": float(numbers.max())}
    if count == 1:
        return {"runs": count, "mean": ends["least"], "low": None, "high": None, **ends}
    return {"runs": count, **renamed(estimate.mean(numbers)), **ends}


def renamed(interval: Interval) -> dict[str, float]:
    """Return an interval as a summary has it."""
    given = asdict(interval)
    return {"mean": given.pop("value"), **given}


def show(title: str, summary: Summary) -> None:
    """Print a summary for people."""
    table = Table(title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("", no_wrap=True)
    for name in ("runs", "mean", "95% interval", "least", "greatest"):
        table.add_column(name, justify="right", no_wrap=True)
    for row in summary:
        low, high = row["low"], row["high"]
        interval = "" if low is None else f"{cell(low)} .. {cell(high)}"
        ends = [cell(row["least"]), cell(row["greatest"])]
        table.add_row(row["column"], f"{row['runs']:,}", cell(row["mean"]), interval, *ends)
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    console.print(table)


def cell(value: float | None) -> str:
    """Return a number as people read it."""
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= WHOLE else f"{value:.4g}"

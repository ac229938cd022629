"""The command line: it asks, shows and exits; what it shows is made elsewhere."""

import json
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy import __version__
from agent_economy._core import CONTACTS, MERITS, InputError
from agent_economy.progress import Teller
from agent_economy.scenario import Override, Scenario
from agent_economy.study import conclude, files, report, run_teams
from agent_economy.study.answer import Answer
from agent_economy.study.estimate import Estimate
from agent_economy.study.teams import TeamResult

BAD_INPUT = 2
"""Exit code when something given is not allowed."""

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""

WIDE = 100
"""Columns that a table with ranges needs, and that there are where the output is no terminal."""

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)


def print_version(wanted: bool) -> None:  # noqa: FBT001  (typer's callback)
    """Print the version and end."""
    if wanted:
        typer.echo(f"agent-economy {__version__}")
        raise typer.Exit


@app.callback()
def root(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=print_version, is_eager=True, help="Version.")
    ] = False,
) -> None:
    """How many robots, of which kinds, does this job need?

    Example: agent-economy study scenarios/classic.toml
    """


@app.command()
def study(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[Path, typer.Argument(help="A scenario's TOML file.", show_default=False)],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(help="What to compare, as robots.wanderer.count=1..12 or =1,2,4."),
    ] = None,
    runs: Annotated[int | None, typer.Option(help="Runs of each team.")] = None,
    contact: Annotated[
        str | None,
        typer.Option(help=f"What counts as finding an item: {', '.join(CONTACTS)}."),
    ] = None,
    merit: Annotated[
        str | None,
        typer.Option(
            help=f"How runs are scored: {', '.join(MERITS)} or weights, as time=-0.03,robots=-0.2."
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option(min=0, max=2**64 - 1, help="Of the random starts: same seed, same bytes.")
    ] = 0,
    out: Annotated[
        Path | None, typer.Option(help="Folder of the results.", show_default="studies/NAME")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print answer.json instead of the table.")
    ] = False,
) -> None:
    """Run every team of a scenario and say how many robots to send.

    Writes report.html, runs.parquet and answer.json. An option wins over what the file says.

    Exit codes: 0 answered, 2 something given is not allowed, 130 stopped by Ctrl-C.

    Example: agent-economy study scenarios/classic.toml --vary robots.wanderer.count=1..12
    """
    teller = Teller()
    with stop_told(teller), bad_input_told():
        changes = overrides(vary or [], runs=runs, contact=contact, merit=merit)
        asked = Scenario.load(scenario, changes)
        folder = out or Path("studies") / asked.name
        files.check_writable(folder)
        with report.ChartScript() as script, teller.shown(asked) as on_progress:
            results = run_teams(asked, seed, on_progress)
            answer = conclude(results)
            page = report.html(results, answer, script)
        with uninterrupted():
            files.write_all(folder, results, answer, page)
    if as_json:
        typer.echo(json.dumps(files.answer_dict(answer), indent=2, allow_nan=False))
    else:
        show(answer, folder)


@contextmanager
def stop_told(teller: Teller) -> Iterator[None]:
    """Say what was done when Ctrl-C stops a study."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(f"\nStopped after {teller.done:,} runs; nothing was written.", err=True)
        raise typer.Exit(INTERRUPTED) from None


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Let Ctrl-C pass: the files of a study belong together, and writing them takes a moment."""
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)


@contextmanager
def bad_input_told() -> Iterator[None]:
    """Say what is not allowed and end with the exit code for it."""
    try:
        yield
    except InputError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from None


def overrides(
    vary: list[str], *, runs: int | None, contact: str | None, merit: str | None
) -> tuple[Override, ...]:
    """Return what options say, as values put over the file's.

    Raises:
        InputError: If a --vary is not PATH=VALUES, or given twice for one path.
    """
    changes = [varied(text) for text in vary]
    paths = [change.path[-1] for change in changes]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice:
        message = f"--vary {twice}: is given twice: must be given once, such as {twice}=1..4,8"
        raise InputError(message)
    if runs is not None:
        changes.append(Override(("study", "runs"), runs, "--runs"))
    if contact is not None:
        changes.append(Override(("contact",), contact, "--contact"))
    if merit is not None:
        changes.append(Override(("merit",), merit, "--merit"))
    return tuple(changes)


def varied(text: str) -> Override:
    """Return the factor and values of PATH=VALUES."""
    path, equals, values = text.partition("=")
    if not equals:
        message = f"--vary = {text!r}: must be PATH=VALUES, such as robots.wanderer.count=1..12"
        raise InputError(message)
    return Override(("study", "vary", path.strip()), values.strip(), "--vary")


def show(answer: Answer, folder: Path) -> None:
    """Print the table, the answer, and where the report is."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDE
    console.print(teams_table(answer, ranges=console.width >= WIDE))
    console.print(f"{answer.sentence}\n", style="bold", markup=False, emoji=False)
    typer.echo(f"Report: {folder / 'report.html'}")


def teams_table(answer: Answer, *, ranges: bool) -> Table:
    """Return a table of all teams, with the ranges of what is estimated or without."""

    def cell(given: Estimate, style: str) -> str:
        value, low, high = (format(each, style) for each in (given.value, given.low, given.high))
        return f"{value} ({low}..{high})" if ranges else value

    title = Text(answer.scenario.summary)
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for name in ("robots", "mean time, s", "searches failed", "figure of merit", "behind best"):
        table.add_column(name, justify="right", no_wrap=True)
    for team in answer.teams:
        table.add_row(
            str(team.robots),
            cell(team.time_s, ".1f"),
            cell(team.failed_share, ".2%"),
            cell(team.merit, ".2f"),
            behind_best(team),
            style="bold" if team.robots == answer.best else None,
        )
    return table


def behind_best(team: TeamResult) -> str:
    """Return how far a team is behind the best."""
    if not team.behind_best:
        return "best"
    return f"{team.behind_best.value:.3f}{' tie' if team.is_tied else ''}"

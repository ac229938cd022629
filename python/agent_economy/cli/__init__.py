"""The command line: it asks, shows and exits; what it shows is made elsewhere.

One file a command; `told` turns what goes wrong into words and exit codes, `progress` and `table`
are what a person sees.
"""

from typing import Annotated

import typer

from agent_economy import __version__
from agent_economy.cli.answer import answer
from agent_economy.cli.check import check
from agent_economy.cli.replicate import replicate
from agent_economy.cli.rerun import rerun
from agent_economy.cli.run import run
from agent_economy.cli.scenarios import scenarios
from agent_economy.cli.study import study
from agent_economy.cli.ui import ui
from agent_economy.cli.watch import watch

__all__ = ["app"]

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

    Example: agent-economy study classic
    """


app.command()(study)
app.command()(answer)
app.command()(watch)
app.command()(run)
app.command()(replicate)
app.command()(rerun)
app.command()(check)
app.command()(ui)
app.command()(scenarios)

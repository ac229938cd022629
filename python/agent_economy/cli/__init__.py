"""The command line: reads options, calls the library, prints, and sets the exit code.

One file per command, imported only when the command is used. `errors` maps exceptions to exit
codes; `options` has what commands share; `run_progress`, `study_progress` and `answer_table` print.
"""

from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from agent_economy.cli.errors import error_exits

__all__ = ["app"]

COMMANDS = {
    "study": "Find the best team, with the fewest runs.",
    "report": "Rebuild the answer and the report of a study.",
    "watch": "Show the progress of a running study.",
    "run": "Run a scenario once and print the outcome.",
    "replicate": "Run a scenario many times and print statistics.",
    "replay": "Replay a recording and verify it.",
    "check": "Check scenario and fleet files.",
    "drive": "Drive real robots to their waypoints.",
    "stop": "Stop all robots that are being driven.",
    "ui": "Open the browser interface.",
    "scenarios": "List the bundled scenarios.",
    "bender-emulator": "Emulate Bender, the robot of 2003.",
}
"""Each command, and its line in the list of all commands."""


class LazyGroup(TyperGroup):
    """Lists all commands without importing them; imports the one that is used."""

    def __init__(self, **settings: Any) -> None:
        """Register the names and one-line descriptions."""
        super().__init__(**settings)
        self.commands = {name: TyperCommand(name, help=line) for name, line in COMMANDS.items()}

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the name, the command and the remaining arguments."""
        name, command, rest = super().resolve_command(ctx, args)
        return name, command and load(str(command.name)), rest


def load(name: str) -> Any:
    """Import the command of a name, from the module and the function of the same name."""
    identifier = name.replace("-", "_")
    with error_exits():  # Ctrl-C during the import
        function = getattr(import_module(f"agent_economy.cli.{identifier}"), identifier)
    single = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    single.command(name)(function)
    return typer.main.get_command(single)


def print_version(is_requested: bool) -> None:  # noqa: FBT001  (typer's callback)
    """Print the version and exit."""
    if is_requested:
        from agent_economy.build import version_line  # noqa: PLC0415  (slow to find)

        typer.echo(version_line())
        raise typer.Exit


# Without rich, which takes longer to load than all the rest of the help.
app = typer.Typer(
    cls=LazyGroup,
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


@app.callback()
def root(
    *,
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=print_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    """How many robots, of which kinds, does a job need? Answered by fast simulation.

    Example: agent-economy study classic
    """

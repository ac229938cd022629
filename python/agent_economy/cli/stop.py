"""The command `stop`."""

from typing import Annotated

import typer

from agent_economy.live.discovery.stopping import stop_drives


def stop(
    *,
    process: Annotated[
        int | None,
        typer.Option(
            metavar="PID",
            help="Stop one drive only: the one with this process.",
            min=1,
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list with the answer of each drive.")
    ] = False,
) -> None:
    """Stop all robots that this user drives from this machine: an emergency stop.

    The stop is latched: the robots have to be released and armed again before they move.

    Root stops the drives of all users. docs/live.md states where drives are looked for.

    Exit codes: 0 all drives have accepted the stop; 1 no drive was found, or one did not answer.

    Example: agent-economy stop
    """
    report = stop_drives(process, typer.echo, as_json=as_json)
    for line in report.errors:
        typer.echo(line, err=True)
    raise typer.Exit(report.exit_code)

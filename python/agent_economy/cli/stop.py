"""The command `stop`."""

import json
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated

import typer

from agent_economy.live.running_drives import running

NOT_STOPPED = 1


def stop(
    *,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list with the answer of each drive.")
    ] = False,
) -> None:
    """Stop all robots that this user drives from this machine: an emergency stop.

    The stop is latched: the robots have to be released and armed again before they move.

    Exit codes: 0 all drives have accepted the stop; 1 no drive runs, or one did not answer.

    Example: agent-economy stop
    """
    drives = running()
    # At the same time: one that does not answer must not delay the stop of the others.
    with ThreadPoolExecutor(max(1, len(drives))) as pool:
        requests = [pool.submit(drive.request, "/stop") for drive in drives]
        answers = [(drive, *each.result()) for drive, each in zip(drives, requests, strict=True)]
    if as_json:
        rows = [
            {"pid": drive.pid, "fleet": drive.fleet, "is_stopped": accepted, "message": text}
            for drive, accepted, text in answers
        ]
        typer.echo(json.dumps(rows, indent=2))
    else:
        for drive, _, text in answers:
            typer.echo(f"{drive.fleet} (process {drive.pid}): {text}")
        if not answers:
            typer.echo("No drive runs on this machine.", err=True)
    if not answers or not all(accepted for _, accepted, _ in answers):
        raise typer.Exit(NOT_STOPPED)

"""The command `drive`."""

import json
import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, TextIO

import typer

from agent_economy.built_page import missing_page
from agent_economy.live.warden.endings import End
from agent_economy.live.warden.sentences import sentence
from agent_economy.live.warden.shell import Options, drive_fleet


def drive(  # noqa: PLR0913  (typer's options are arguments)
    fleet: Annotated[Path, typer.Argument(help="A fleet file (TOML).", show_default=False)],
    *,
    headless: Annotated[
        bool,
        typer.Option(
            "--headless",
            help="End when all waypoints and goals are reached, or when a stop is latched.",
        ),
    ] = False,
    arm: Annotated[
        bool, typer.Option("--arm", help="Arm each robot once, as soon as it can be armed.")
    ] = False,
    record: Annotated[
        Path | None,
        typer.Option(
            help="The recording, NAME.mcap, which must not exist. "
            "[default: FLEET-TIME.mcap in this folder]",
            show_default=False,
        ),
    ] = None,
    every: Annotated[
        int,
        typer.Option(
            min=1,
            help="Number of steps between recorded states, percepts and scans. Everything that a "
            "replay verifies is recorded in each step.",
        ),
    ] = 1,
    seed: Annotated[int, typer.Option(help="Seed of the simulated robots and sensors.", min=0)] = 0,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print each event as a line of JSON on standard output.")
    ] = False,
) -> None:
    """Drive the robots of a fleet file to their waypoints, and record everything.

    No robot moves before all of its inputs are fresh and it has been armed. Ctrl-C stops all
    robots first. From another terminal, `agent-economy stop` stops all robots. docs/safety.md lists
    everything that stops a robot.

    Exit codes: 0 all waypoints and goals were reached; 1 some cannot be reached; 2 the fleet file
    or an argument is not valid, the recording exists, or another program drives a robot; 3 a robot
    was stopped and has to be armed again; 4 a robot could not be armed within 30 s; 130 stopped by
    Ctrl-C or a signal; 137 the warden was suspended or silent, and the loop ended it and stopped
    the robots.

    Example: agent-economy drive fleets/bender.toml --headless --arm
    """
    if headless != arm:
        missing, given = ("--arm", "--headless") if headless else ("--headless", "--arm")
        typer.echo(
            f"{given} needs {missing}: without a screen, robots are armed at the start", err=True
        )
        raise typer.Exit(End.INVALID.exit_code)
    path = record or Path(f"{fleet.stem}-{time.strftime('%Y%m%d-%H%M%S')}.mcap")
    report = print_json if as_json else print_event
    unbuilt = None if headless else missing_page()
    if unbuilt is not None:
        report({"type": "message", "message": unbuilt})
    options = Options(
        fleet, path, seed, is_headless=headless, is_numbered=record is None, every=every
    )
    raise typer.Exit(drive_fleet(options, report).exit_code)


def print_json(event: Mapping[str, Any]) -> None:
    """Print an event as a line of JSON."""
    write(sys.stdout, json.dumps(event))


def print_event(event: Mapping[str, Any]) -> None:
    """Print an event as a sentence."""
    text = sentence(event)
    if text:
        write(sys.stderr if event["type"] in ("invalid", "message", "page") else sys.stdout, text)


def write(stream: TextIO | None, line: str) -> None:
    """Write a line at once; Python has no stream if the file descriptor was closed at the start.

    The buffer of the stream is left alone: a thread that is blocked holds its lock, and Python ends
    only after it has flushed all buffers.
    """
    data = f"{line}\n".encode(errors="replace")
    while stream is not None and data:
        data = data[os.write(stream.fileno(), data) :]

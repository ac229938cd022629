"""The command `bender-emulator`."""

import asyncio
import json
import signal
from pathlib import Path
from typing import Annotated

import typer

from agent_economy.cli.errors import error_exits
from agent_economy.cli.options import once, parsed, parts
from agent_economy.live.emulator import Emulator, Settings, Setup
from agent_economy.scenario.validation import check

SETS_HELP = (
    "Change a setting, such as gps_hz=2; may be repeated. docs/bender-emulator.md lists all."
)


def bender_emulator(  # noqa: PLR0913  (typer's options are arguments)
    *,
    host: Annotated[str, typer.Option(help="Host name or address to listen on.")] = "127.0.0.1",
    ports: Annotated[
        str,
        typer.Option(
            metavar="A,B,C,D",
            help="Ports of the motors, compass, GPS and sonars of robot 0; 0 for any free port. "
            "Those of each next robot are 10 higher.",
        ),
    ] = "2000,2001,2002,2003",
    robots: Annotated[int, typer.Option(help="Number of robots, 1 to 100.")] = 1,
    scenario: Annotated[
        str, typer.Option(help="A scenario with robots of the kind bender, file or name.")
    ] = "bender",
    control: Annotated[int, typer.Option(help="The control port; 0 for any free port.")] = 0,
    log: Annotated[
        Path | None,
        typer.Option(help="Write every line received and sent to this file, as JSON lines."),
    ] = None,
    sets: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help=SETS_HELP, show_default=False),
    ] = None,
    seed: Annotated[
        int,
        typer.Option(min=0, max=2**64 - 1, help="Random seed of sensor errors and line faults."),
    ] = 0,
) -> None:
    """Emulate Bender, the robot of 2003, in a simulated world: its four TCP ports.

    When it is ready, it prints one line of JSON with all addresses. It runs until Ctrl-C.

    Exit codes: 1 it cannot continue; 2 an argument, the scenario or the log file is invalid, or
    a port is in use; 130 stopped by Ctrl-C or SIGTERM.

    Example: agent-economy bender-emulator --ports 0,0,0,0 --robots 2 --set deadman_s=1
    """
    with error_exits():
        settings = Settings().changed(settings_of(sets or []), "--set ")
        setup = Setup(host, ports_of(ports), robots, scenario, control, log, seed)
        try:
            asyncio.run(run(Emulator(settings, setup)))
        except asyncio.CancelledError:
            raise KeyboardInterrupt from None


async def run(emulator: Emulator) -> None:
    """Print the addresses, and run until Ctrl-C or SIGTERM, which cancels it as Ctrl-C does."""
    task = asyncio.current_task()
    if task is not None:
        asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, task.cancel)
    async with emulator:
        typer.echo(json.dumps(emulator.addresses()))
        await emulator.finished()


def settings_of(sets: list[str]) -> dict[str, object]:
    """Return the values of NAME=VALUE, by name."""
    pairs = [parts("--set", text, "NAME=VALUE, such as gps_hz=2") for text in once("--set", sets)]
    return {name: parsed(value) for name, value in pairs}


def ports_of(text: str) -> tuple[int, ...]:
    """Return the numbers of a list with commas."""
    words = text.split(",")
    allowed = "four port numbers with commas, such as 2000,2001,2002,2003"
    are_numbers = all(word.strip().isascii() and word.strip().isdigit() for word in words)
    check(are_numbers and len(words) == 4, "--ports", text, allowed)  # noqa: PLR2004
    return tuple(map(int, words))

"""The command `replay`."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from agent_economy.build import Build, own_build
from agent_economy.cli.errors import BAD_INPUT, FAILED, error_exits
from agent_economy.whole_file import is_being_written

if TYPE_CHECKING:
    from agent_economy.recording import Replay


def replay(
    file: Annotated[Path, typer.Argument(help="A recording of a run.", show_default=False)],
    *,
    verify: Annotated[
        bool,
        typer.Option(
            "--verify/--no-verify",
            help="Exit with code 1 if the recording is not reproduced, and with 2 if another "
            "build of this program recorded it.",
        ),
    ] = True,
    as_2002: Annotated[
        bool,
        typer.Option(
            "--as-2002",
            help="Of a drive: print what the program of 2002 sends for the recorded lines, beside "
            "what was sent, instead of verifying it.",
        ),
    ] = False,
    steering: Annotated[
        bool,
        typer.Option(
            "--steering",
            help="With --as-2002: let it turn to its waypoint. As printed, it never does.",
        ),
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the result as JSON instead of a sentence.")
    ] = False,
) -> None:
    """Replay a recorded run from its file alone, and verify that it is reproduced exactly.

    Every recorded state is compared bit by bit, and so are all percepts and commands until then. A
    truncated recording, or one that is still being written, is compared up to its end, a damaged
    one up to the damage; the output names the step.

    Exit codes: 0 reproduced, as far as the file is whole; 1 not reproduced; 2 the file is damaged
    before its first state, not a recording, or of another build of this program; 130 stopped by
    Ctrl-C.

    Example: agent-economy replay run.mcap
    """
    if steering and not as_2002:
        typer.echo("--steering needs --as-2002", err=True)
        raise typer.Exit(BAD_INPUT)
    if as_2002:
        print_2002(file, steers=steering, as_json=as_json)
        return
    # Before it is read: one that is completed meanwhile is no longer being written.
    is_unfinished = is_being_written(file)
    # Importing the reader doubles the start-up time.
    from agent_economy.live.replay import replay as live_replay  # noqa: PLC0415

    with error_exits():
        result = live_replay(file, verify=verify)
    is_unfinished &= not result.is_complete
    if as_json:
        typer.echo(json.dumps(as_dict(result, is_unfinished=is_unfinished), indent=2))
    else:
        typer.echo(as_sentence(result, is_unfinished=is_unfinished))
    if verify and not result.agrees:
        raise typer.Exit(FAILED)


def print_2002(file: Path, *, steers: bool, as_json: bool) -> None:
    """Print a recorded drive beside the program of 2002."""
    from agent_economy.cli.table_2002 import print_comparison  # noqa: PLC0415
    from agent_economy.live.as_2002 import compare_2002  # noqa: PLC0415

    with error_exits():
        is_unfinished = is_being_written(file)
        compared = compare_2002(file, steers=steers)
    if compared.damaged_tick is not None:
        typer.echo(f"The recording is damaged from step {compared.damaged_tick:,} on.", err=True)
    elif is_unfinished and not compared.is_complete:
        typer.echo("The recording is still being written.", err=True)
    elif not compared.is_complete:
        typer.echo("The recording is truncated.", err=True)
    if as_json:
        typer.echo(json.dumps([asdict(each) for each in compared.robots], indent=2))
        return
    for comparison in compared.robots:
        print_comparison(comparison)


def as_sentence(result: "Replay", *, is_unfinished: bool) -> str:
    """Return the result of a replay in words."""
    which = f"{result.scenario.name}, seed {result.seed}, run {result.run}"
    if result.agrees:
        lines = "" if result.lines is None else f", from {result.lines:,} lines of robots"
        verdict = f"reproduced up to step {result.tick:,} (hash {result.hash}){lines}"
    else:
        from_step = f"from step {result.mismatch_tick:,} on, first in its {result.mismatch}"
        verdict = f"differs from the recording {from_step}"
    return f"{which}: {verdict}{origin(result)}{ending(result, is_unfinished=is_unfinished)}"


def origin(result: "Replay") -> str:
    """Return which build recorded a run, in words; empty if it is this one, or does not matter."""
    build = Build(result.program, result.engine)
    is_older = result.readings == 0 and not result.agrees
    if build == own_build() and not is_older:
        return ""
    made = "; it has no readings of robots: they were made of its lines" if is_older else ""
    return f"{made}; recorded by {build}, replayed by {own_build()}"


def ending(result: "Replay", *, is_unfinished: bool) -> str:
    """Return where a recording is damaged or ends early, in words; empty if it is complete."""
    if is_unfinished:
        return f"; the recording is still being written: it ends at step {result.tick:,} so far"
    if result.damaged_tick is not None:
        return f"; the recording is damaged from step {result.damaged_tick:,} on"
    if not result.is_complete:
        return f"; the recording is truncated: it ends at step {result.tick:,}"
    return ""


def as_dict(result: "Replay", *, is_unfinished: bool) -> dict[str, object]:
    """Return the result of a replay for programs."""
    first = ("seed", "run", "program", "engine")
    last = ("mismatch_tick", "mismatch", "lines", "readings", "damaged_tick")
    names = (*first, "is_complete", "tick", "hash", "agrees", *last)
    return {
        "scenario": result.scenario.name,
        **{name: getattr(result, name) for name in names},
        "is_being_written": is_unfinished,
    }

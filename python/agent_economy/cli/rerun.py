"""The command `rerun`."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from agent_economy import __version__
from agent_economy.cli.told import FAILED, faults_told

if TYPE_CHECKING:
    from agent_economy.recording import Rerun


def rerun(
    file: Annotated[Path, typer.Argument(help="A recording of a run.", show_default=False)],
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Say it as JSON.")] = False,
) -> None:
    """Take a recorded run again, from its file alone, and say whether the same comes of it.

    Every recorded state is compared, in all its bits. Of a file that is cut, as by a process that
    was killed, what is there is compared.

    Exit codes: 0 the same, 1 not the same, 2 the file is damaged or no recording, 130 stopped by
    Ctrl-C.

    Example: agent-economy rerun run.mcap
    """
    # What reads recordings takes as long to load as all the rest.
    from agent_economy import recording  # noqa: PLC0415

    with faults_told():
        again = recording.rerun(file)
    typer.echo(json.dumps(as_dict(again), indent=2) if as_json else in_words(again))
    if not again.agrees:
        raise typer.Exit(FAILED)


def in_words(again: "Rerun") -> str:
    """Return what came of it, for people."""
    which = f"{again.scenario.name}, seed {again.seed}, run {again.run}"
    if again.agrees:
        said = f"the same as recorded, up to step {again.tick:,} (hash {again.hash})"
    else:
        said = f"not the same as recorded from step {again.differs_at:,} on"
        if again.program != __version__:
            said += f": it was recorded by version {again.program}, this is {__version__}"
    cut = "" if again.is_whole else "; the file is cut: nothing is known of what came after"
    return f"{which}: {said}{cut}"


def as_dict(again: "Rerun") -> dict[str, object]:
    """Return what came of it, for programs."""
    names = ("seed", "run", "program", "is_whole", "tick", "hash", "agrees", "differs_at")
    told = {name: getattr(again, name) for name in names}
    return {"scenario": again.scenario.name, **told}

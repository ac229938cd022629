"""The command `answer`."""

from pathlib import Path
from typing import Annotated

import typer

from agent_economy import study
from agent_economy.cli.table import show
from agent_economy.cli.told import faults_told


def answer(
    folder: Annotated[Path, typer.Argument(help="Folder of a finished study.", show_default=False)],
    *,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print answer.json instead of the table.")
    ] = False,
) -> None:
    """Rebuild the answer and the report of a study from its runs; nothing is run.

    Exit codes: 0 answered, 1 the folder is damaged or taken, 2 something given is not
    allowed (such as an unfinished study).

    Example: agent-economy answer studies/classic
    """
    with faults_told():
        found = study.rebuild(folder)
    show(found, folder, as_json=as_json)

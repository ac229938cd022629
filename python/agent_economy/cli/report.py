"""The command `report`."""

from pathlib import Path
from typing import Annotated

import typer

from agent_economy import study
from agent_economy.cli.answer_table import show
from agent_economy.cli.errors import error_exits
from agent_economy.study.store.folder import REPORT


def report(
    folder: Annotated[
        Path, typer.Argument(help="The folder of a finished study.", show_default=False)
    ],
    *,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print answer.json instead of a table.")
    ] = False,
) -> None:
    """Rebuild the answer and the report of a study from its stored runs; no runs are computed.

    Exit codes: 0 success; 1 the folder is damaged or in use; 2 an argument is invalid, such as an
    unfinished study.

    Example: agent-economy report studies/classic
    """
    with error_exits():
        answer = study.rebuild(folder)
    show(answer, folder / REPORT, as_json=as_json)

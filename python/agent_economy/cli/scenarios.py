"""The command `scenarios`."""

import json
from typing import Annotated

import typer

from agent_economy.cli.told import faults_told
from agent_economy.scenario import Scenario, bundled


def scenarios(
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print a list of them instead.")] = False,
) -> None:
    """List the scenarios that come with the program: name, engine, summary.

    A name stands for its file wherever a command takes a scenario. Exit codes: 0 listed.

    Example: agent-economy scenarios
    """
    with faults_told():
        rows = [
            {
                "name": name,
                "engine": scenario.engine,
                "summary": scenario.summary,
                "file": str(file),
            }
            for name, file in bundled.scenarios().items()
            for scenario in [Scenario.load(file)]
        ]
    if as_json:
        typer.echo(json.dumps(rows, indent=2))
        return
    widths = {key: max(len(row[key]) for row in rows) for key in ("name", "engine")}
    for row in rows:
        cells = [row[key].ljust(width) for key, width in widths.items()]
        typer.echo("  ".join([*cells, row["summary"]]))

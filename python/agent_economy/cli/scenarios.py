"""The command `scenarios`."""

import json
from typing import Annotated

import typer

from agent_economy.cli.errors import error_exits
from agent_economy.scenario import Scenario, bundled


def scenarios(
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print the list as JSON.")] = False,
) -> None:
    """List the bundled scenarios: name, engine, summary.

    Every command that takes a scenario file also takes one of these names.

    Exit codes: 0 success.

    Example: agent-economy scenarios
    """
    with error_exits():
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

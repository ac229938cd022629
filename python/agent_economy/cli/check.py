"""The command `check`."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.cli.errors import BAD_INPUT, error_exits
from agent_economy.cli.options import Sets, overrides
from agent_economy.scenario import Override, Scenario
from agent_economy.study import design

Error = dict[str, Any]


def check(
    scenarios: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="Scenario files (TOML), or names of bundled ones.",
            show_default=False,
        ),
    ],
    *,
    sets: Sets = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list of all errors.")
    ] = False,
) -> None:
    """Check scenario files and print all errors; nothing is run.

    Exit codes: 0 all are valid; 2 a scenario or an argument is invalid.

    Example: agent-economy check scenarios/classic.toml --set clock.time_limit_s=60
    """
    with error_exits():
        changes = overrides(sets)
    errors: list[Error] = []
    for file in scenarios:
        try:
            line = summary(file, changes)
        except InputError as error:
            errors += errors_of(file, error)
        else:
            typer.echo(line, err=as_json)
    if as_json:
        typer.echo(json.dumps(errors, indent=2))
    else:
        for each in errors:
            typer.echo(each["message"], err=True)
    if errors:
        raise typer.Exit(BAD_INPUT)


def summary(file: Path, changes: tuple[Override, ...]) -> str:
    """Return the line for a valid scenario.

    Raises:
        InputError: If it is not valid.
    """
    scenario = Scenario.load(file, changes)
    plan = study.make_plan(scenario)
    compared = design.describe(scenario.design, len(plan.configurations))
    return f"{file}: valid: engine {scenario.engine}, {compared}"


def errors_of(file: Path, error: InputError) -> list[Error]:
    """Return each error; one that is not about a value has its whole text as `allowed`."""
    whole: list[Error] = [
        {
            "origin": str(file),
            "file": str(file),
            "line": None,
            "path": "",
            "value": None,
            "allowed": sentence,
            "suggestion": None,
            "message": sentence,
        }
        for sentence in str(error).splitlines()
    ]
    return [dict(each) for each in error.errors] or whole

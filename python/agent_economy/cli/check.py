"""The command `check`."""

import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.cli.errors import BAD_INPUT, error_exits, print_warnings
from agent_economy.cli.options import Sets, overrides
from agent_economy.live.fleet import is_fleet_file
from agent_economy.live.fleet import load as load_fleet
from agent_economy.scenario import Override, Scenario, ScenarioWarning
from agent_economy.study import design

Error = dict[str, Any]
"""An error or a warning in the JSON list; `severity` distinguishes them."""


def check(
    scenarios: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="Scenario files and fleet files (TOML), or names of bundled scenarios.",
            show_default=False,
        ),
    ],
    *,
    sets: Sets = None,
    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print a JSON list of all errors and warnings, by severity."),
    ] = False,
) -> None:
    """Check scenario and fleet files and print all errors and warnings; nothing is run.

    A file that names a scenario or the drivers of robots is a fleet file: it is checked together
    with its scenario, to which --set applies. No robot is connected, and no host name is resolved.

    For each item detector, a line states what a straight pass at maximum speed detects.

    Warnings are about what is allowed and probably not meant, such as teams without room to start.

    Exit codes: 0 all are valid, perhaps with warnings; 2 a file or an argument is invalid.

    Example: agent-economy check scenarios/classic.toml fleets/bender.toml
    """
    with error_exits():
        changes = overrides(sets)
    errors: list[Error] = []
    # A dict, because a file may be given twice.
    warnings: dict[ScenarioWarning, None] = {}
    for file in scenarios:
        try:
            line, found = checked(file, changes)
        except InputError as error:
            errors += errors_of(file, error)
        else:
            typer.echo(line, err=as_json)
            warnings |= dict.fromkeys(found)
    if as_json:
        listed = errors + [{"severity": "warning"} | asdict(each) for each in warnings]
        typer.echo(json.dumps(listed, indent=2))
    else:
        print_warnings(warnings)
        for each in errors:
            typer.echo(each["message"], err=True)
    if errors:
        raise typer.Exit(BAD_INPUT)


def checked(file: Path, changes: tuple[Override, ...]) -> tuple[str, Iterable[ScenarioWarning]]:
    """Return the line for a valid file, and the warnings about it.

    Raises:
        InputError: If it is not valid.
    """
    return checked_fleet(file, changes) if is_fleet_file(file) else checked_scenario(file, changes)


def checked_fleet(
    file: Path, changes: tuple[Override, ...]
) -> tuple[str, Iterable[ScenarioWarning]]:
    """Return the line for a valid fleet, and the warnings about it and a run of its scenario.

    Raises:
        InputError: If it or its scenario is not valid.
    """
    fleet = load_fleet(file, changes)
    robots = len(fleet.plan.robots)
    counted = f"{robots} robot{'s' if robots > 1 else ''}"
    line = f"{file}: valid: fleet of {counted}, scenario {fleet.scenario.name}"
    return line, fleet.scenario.warnings + fleet.warnings


def checked_scenario(
    file: Path, changes: tuple[Override, ...]
) -> tuple[str, Iterable[ScenarioWarning]]:
    """Return the lines for a valid scenario, and the warnings about its run and its study.

    Below the first line are its derived quantities.

    Raises:
        InputError: If it is not valid.
    """
    scenario = Scenario.load(file, changes)
    plan = study.make_plan(scenario)
    compared = design.describe(scenario.design, len(plan.configurations))
    line = f"{file}: valid: engine {scenario.engine}, {compared}"
    details = (f"    {name}: {text}" for name, text in scenario.derived)
    return "\n".join([line, *details]), scenario.warnings + plan.warnings


def errors_of(file: Path, error: InputError) -> list[Error]:
    """Return each error; one that is not about a value has its whole text as `allowed`."""
    whole: list[Error] = [
        {
            "severity": "error",
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
    return [{"severity": "error"} | each for each in error.errors] or whole

"""The command `check`."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.cli.given import Sets, overrides
from agent_economy.cli.told import BAD_INPUT, faults_told
from agent_economy.scenario import Override, Scenario
from agent_economy.study import design

Fault = dict[str, Any]


def check(
    scenarios: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="Scenarios' TOML files, or names of shipped ones.",
            show_default=False,
        ),
    ],
    *,
    sets: Sets = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a list of all faults instead.")
    ] = False,
) -> None:
    """Say all that is wrong with scenarios, or that nothing is; nothing is run.

    Exit codes: 0 nothing is wrong, 2 something is, or something given is not allowed.

    Example: agent-economy check scenarios/classic.toml --set clock.time_limit_s=60
    """
    with faults_told():
        changes = overrides(sets)
    faults: list[Fault] = []
    for file in scenarios:
        try:
            words = in_words(file, changes)
        except InputError as error:
            faults += faults_of(file, error)
        else:
            typer.echo(words, err=as_json)
    if as_json:
        typer.echo(json.dumps(faults, indent=2))
    else:
        for fault in faults:
            typer.echo(fault["message"], err=True)
    if faults:
        raise typer.Exit(BAD_INPUT)


def in_words(file: Path, changes: tuple[Override, ...]) -> str:
    """Return what a scenario asks, if nothing is wrong with it.

    Raises:
        InputError: If something is.
    """
    scenario = Scenario.load(file, changes)
    plan = study.make_plan(scenario)
    asked = design.in_words(scenario.design, len(plan.configurations))
    return f"{file}: nothing is wrong: engine {scenario.engine}, {asked}"


def faults_of(file: Path, error: InputError) -> list[Fault]:
    """Return what is wrong, one by one; what is no value's fault is a whole sentence."""
    whole: list[Fault] = [
        {
            "origin": str(file),
            "file": str(file),
            "line": None,
            "path": "",
            "given": None,
            "allowed": sentence,
            "suggestion": None,
            "message": sentence,
        }
        for sentence in str(error).splitlines()
    ]
    return [dict(fault) for fault in error.errors] or whole

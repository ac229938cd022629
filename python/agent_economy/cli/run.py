"""The command `run`."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, TypeAlias

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy import api
from agent_economy._core import InputError
from agent_economy.cli.errors import FAILED, error_exits, print_warnings
from agent_economy.cli.goals_left import GoalsLeft, goals_left
from agent_economy.cli.lane_rows import lane_rows
from agent_economy.cli.options import ScenarioArgument, Seed, Sets, overrides
from agent_economy.cli.run_progress import progress_bar
from agent_economy.cli.whole_table import print_whole
from agent_economy.runs import factory
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario

Ended: TypeAlias = tuple[Outcome, GoalsLeft]
"""The outcome of a run, and what is left of its goals."""


def run(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[Path, ScenarioArgument],
    *,
    seed: Seed = 0,
    number: Annotated[
        int, typer.Option("--run", min=0, help="Number of the run: each is a different world.")
    ] = 0,
    sets: Sets = None,
    record: Annotated[
        Path | None,
        typer.Option(
            help="Write a recording to this file, NAME.mcap, for Foxglove and replay.",
            show_default=False,
        ),
    ] = None,
    every: Annotated[
        int | None,
        typer.Option(min=1, help="Number of steps between recorded states.", show_default="1"),
    ] = None,
    percepts: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ROBOT",
            help="Also record percepts, commands and scans of this robot; may be repeated.",
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the outcome as JSON instead of a table.")
    ] = False,
) -> None:
    """Run a scenario once and print the outcome.

    The run equals the one of the same seed and number in agent-economy replicate. A recording can
    be replayed from its file alone: agent-economy replay FILE.

    Exit codes: 0 the run has ended or was quarantined; 1 the recording cannot be written; 2 an
    argument or the scenario is invalid; 130 stopped by Ctrl-C.

    Example: agent-economy run search --seed 7 --set robots.rover.count=6 --record run.mcap
    """
    with error_exits():
        if record is None:
            require_record({"--every": every, "--percepts": percepts})
        given = Scenario.load(scenario, overrides(sets))
        print_warnings(given.warnings)
        if record is None:
            outcome, left = watched(given, seed, number)
        else:
            outcome, left = recorded(
                factory.create(given, seed, number), record, every or 1, percepts or []
            )
    if as_json:
        document = {"seed": seed, "status": outcome.status, **outcome.row}
        if "goals" in outcome.row:
            document |= left.document()
        typer.echo(json.dumps(document, indent=2))
    else:
        show(given, seed, outcome)
        for line in left.lines():
            typer.echo(line)


def require_record(options: Mapping[str, object]) -> None:
    """Raise an error if an option of recordings is given without --record.

    Raises:
        InputError: If it is.
    """
    if given := [name for name, value in options.items() if value]:
        message = f"{' and '.join(given)}: requires --record FILE"
        raise InputError(message)


def watched(scenario: Scenario, seed: int, number: int) -> Ended:
    """Run once, with a progress bar if it takes long."""
    if scenario.engine != "metric":
        return api.run(scenario, seed, number), GoalsLeft()
    try:
        simulation = Simulation(scenario, seed, number)
    except InputError as no_room:
        # A run without room is quarantined, as in replicate; any other error is raised again.
        outcome = api.run(scenario, seed, number)
        typer.echo(str(no_room), err=True)
        return outcome, GoalsLeft()
    return shown(simulation, simulation.step)


def recorded(simulation: Stepped, path: Path, every: int, percepts: Sequence[str]) -> Ended:
    """Run once and record it; exit with a code if the recording cannot be written."""
    # Importing the writer doubles the start-up time.
    from agent_economy.recording import Recording, RecordingError  # noqa: PLC0415

    try:
        with Recording(simulation, path, every=every, percepts=percepts) as recording:
            return shown(simulation, recording.step)
    except RecordingError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(FAILED) from None


def shown(simulation: Stepped, step: Callable[[], object]) -> Ended:
    """Step until the run is over."""
    with progress_bar(simulation.scenario.time_limit_s, "simulated seconds") as report:
        while not simulation.is_over:
            step()
            report(simulation.time_s)
    return simulation.outcome(), goals_left(simulation)


def show(scenario: Scenario, seed: int, outcome: Outcome) -> None:
    """Print an outcome as a table."""
    title = f"{scenario.name}, seed {seed}, run {outcome.run}: {outcome.status}"
    table = Table(
        title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE, show_header=False
    )
    table.add_column(no_wrap=True)
    table.add_column()
    rows = lines(scenario, outcome)
    for name, text in rows:
        table.add_row(name, Text(text))
    print_whole(table, Console(highlight=False), max(len(name) for name, _ in rows))


def lines(scenario: Scenario, outcome: Outcome) -> list[tuple[str, str]]:
    """Return the rows of an outcome: pairs of a name and a formatted value."""
    if outcome.status == "quarantined":
        return [
            ("", "No outcome: there was no room for the team or items, or a value was not finite.")
        ]
    found = {f"{kind} found": counts(outcome, kind) for kind in outcome.found}
    rows: dict[str, str | None] = {
        **dict(lane_rows(outcome.row)),
        **found,
        "goals served": served(outcome),
        "time": f"{outcome.time_s:.1f} s of {scenario.time_limit_s:g} s",
        "energy": energy(outcome),
        "distance": number(outcome.distance_m, "m"),
        "collisions": number(outcome.collisions),
        "false alarms": number(outcome.false_alarms),
        "robots": number(outcome.robots),
        "robots stopped": number(outcome.robots_stopped),
        "price": number(outcome.price),
        "merit": None if outcome.merit is None else f"{outcome.merit:.3f}",
    }
    if "goals" in outcome.row and not outcome.found:
        del rows["false alarms"]
    return [(name, text) for name, text in rows.items() if text is not None]


def served(outcome: Outcome) -> str | None:
    """Return how many goals were served, and twice; None without goals."""
    if "goals" not in outcome.row:
        return None
    row = outcome.row
    return f"{row['served']} of {row['goals']}, {row['served_twice']} of them twice"


def energy(outcome: Outcome) -> str | None:
    """Return the energy that was used; None if the engine has none."""
    if outcome.energy_j is None and "energy_j" in outcome.row:
        return "not counted: no robot has a battery"
    return number(outcome.energy_j, "J")


def counts(outcome: Outcome, kind: str) -> str:
    """Return the number of items of a kind found, and the total where it is known."""
    found, missed = outcome.found[kind] or 0, outcome.missed.get(kind)
    return f"{found}" if missed is None else f"{found} of {found + missed}"


def number(value: float | None, unit: str = "") -> str | None:
    """Return a number with a readable number of digits; None for None."""
    if value is None:
        return None
    digits = 0 if isinstance(value, int) or value >= 100 or value.is_integer() else 1  # noqa: PLR2004  (a matter of display)
    return f"{value:,.{digits}f} {unit}".strip()

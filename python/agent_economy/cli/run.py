"""The command `run`."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from agent_economy import api
from agent_economy._core import InputError
from agent_economy.cli.gauge import gauge
from agent_economy.cli.given import Seed, Sets, overrides
from agent_economy.cli.told import FAILED, faults_told
from agent_economy.runs import factory
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario


def run(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[
        Path, typer.Argument(help="A scenario's TOML file, or the name of one.", show_default=False)
    ],
    *,
    seed: Seed = 0,
    number: Annotated[
        int, typer.Option("--run", min=0, help="Which run of the seed: each is another world.")
    ] = 0,
    sets: Sets = None,
    record: Annotated[
        Path | None,
        typer.Option(
            help="File for a recording, NAME.mcap, as Foxglove shows.", show_default=False
        ),
    ] = None,
    every: Annotated[
        int | None,
        typer.Option(min=1, help="Steps from one recorded moment to the next.", show_default="1"),
    ] = None,
    percepts: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ROBOT",
            help="Record what the brain of rover/0 perceives and wants; may be repeated.",
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the outcome as JSON instead of the table.")
    ] = False,
) -> None:
    """Run a scenario once, and tell what came of it.

    It is the same run, of the same seed and number, as one of agent-economy replicate. A recording
    is enough to take it again: agent-economy rerun FILE.

    Exit codes: 0 the run is over, or quarantined, 1 the disk takes no more of the recording, 2
    something given is not allowed, 130 stopped by Ctrl-C.

    Example: agent-economy run search --seed 7 --set robots.rover.count=6 --record run.mcap
    """
    with faults_told():
        if record is None:
            of_recordings_only({"--every": every, "--percepts": percepts})
        given = Scenario.load(scenario, overrides(sets))
        if record is None:
            outcome = watched(given, seed, number)
        else:
            outcome = recorded(
                factory.create(given, seed, number), record, every or 1, percepts or []
            )
    if as_json:
        typer.echo(json.dumps({"seed": seed, "status": outcome.status, **outcome.row}, indent=2))
    else:
        show(given, seed, outcome)


def of_recordings_only(options: Mapping[str, object]) -> None:
    """See to it that nothing is given that would change nothing.

    Raises:
        InputError: If an option has a value.
    """
    if given := [name for name, value in options.items() if value]:
        message = f"{' and '.join(given)}: must come with --record: nothing is recorded without it"
        raise InputError(message)


def watched(scenario: Scenario, seed: int, number: int) -> Outcome:
    """Run once, and show how far it is if that takes long."""
    if scenario.engine != "metric":
        return api.run(scenario, seed, number)
    try:
        simulation = Simulation(scenario, seed, number)
    except InputError as no_room:
        # A run that cannot begin is quarantined, as in a table of runs; what is not allowed is not.
        outcome = api.run(scenario, seed, number)
        typer.echo(str(no_room), err=True)
        return outcome
    return shown(simulation, simulation.step)


def recorded(simulation: Stepped, path: Path, every: int, percepts: Sequence[str]) -> Outcome:
    """The same, into a file; end with an exit code if the disk takes no more."""
    # What writes recordings takes as long to load as all the rest.
    from agent_economy.recording import Recording, RecordingError  # noqa: PLC0415

    try:
        with Recording(simulation, path, every=every, percepts=percepts) as recording:
            return shown(simulation, recording.step)
    except RecordingError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(FAILED) from None


def shown(simulation: Stepped, step: Callable[[], object]) -> Outcome:
    """Step until the run is over."""
    with gauge(simulation.scenario.time_limit_s, "simulated seconds") as tell:
        while not simulation.is_over:
            step()
            tell(simulation.time_s)
    return simulation.outcome()


def show(scenario: Scenario, seed: int, outcome: Outcome) -> None:
    """Print an outcome for people."""
    title = f"{scenario.name}, seed {seed}, run {outcome.run}: {outcome.status}"
    table = Table(
        title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE, show_header=False
    )
    table.add_column(no_wrap=True)
    table.add_column()
    for name, words in lines(scenario, outcome):
        table.add_row(name, Text(words))
    Console(highlight=False).print(table)


def lines(scenario: Scenario, outcome: Outcome) -> list[tuple[str, str]]:
    """Return what an outcome tells, as names and words."""
    if outcome.status == "quarantined":
        return [("", "The run gave nothing: it had no room to begin in, or was not finite.")]
    found = {f"{kind} found": counts(outcome, kind) for kind in outcome.found}
    told: dict[str, str | None] = {
        **found,
        "time": f"{outcome.time_s:.1f} s of {scenario.time_limit_s:g} s",
        "energy": number(outcome.energy_j, "J"),
        "distance": number(outcome.distance_m, "m"),
        "collisions": number(outcome.collisions),
        "false alarms": number(outcome.false_alarms),
        "robots": number(outcome.robots),
        "robots stopped": number(outcome.robots_stopped),
        "price": number(outcome.price),
        "merit": None if outcome.merit is None else f"{outcome.merit:.3f}",
    }
    return [(name, words) for name, words in told.items() if words is not None]


def counts(outcome: Outcome, kind: str) -> str:
    """Return how many items of a kind were found, and of how many if that is known."""
    found, missed = outcome.found[kind] or 0, outcome.missed.get(kind)
    return f"{found}" if missed is None else f"{found} of {found + missed}"


def number(value: float | None, unit: str = "") -> str | None:
    """Return a number as people read it; None where there is none."""
    if value is None:
        return None
    digits = 0 if isinstance(value, int) or value >= 100 or value.is_integer() else 1  # noqa: PLR2004  (a look)
    return f"{value:,.{digits}f} {unit}".strip()

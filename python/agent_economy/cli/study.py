"""The command `study`."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated, Literal

import typer

from agent_economy import study as studies
from agent_economy._core import InputError
from agent_economy.cli.given import Sets, overrides
from agent_economy.cli.progress import Teller
from agent_economy.cli.table import show
from agent_economy.cli.told import INTERRUPTED, faults_told
from agent_economy.scenario import Scenario
from agent_economy.study.answer.labels import label
from agent_economy.study.engine import Engine
from agent_economy.study.plan import Plan, tightened
from agent_economy.study.question import Question, usual_folder
from agent_economy.study.rectangle import Compute

Text = str | None


def study(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[
        Path | None,
        typer.Argument(help="A scenario's TOML file, or the name of one.", show_default=False),
    ] = None,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(help="What to compare, as robots.wanderer.count=1..40; may be repeated."),
    ] = None,
    sets: Sets = None,
    design: Annotated[
        Text, typer.Option(help="Of what is varied: factorial, lhs:200 or sobol:256.")
    ] = None,
    delta: Annotated[
        float | None,
        typer.Option(
            help="Difference of merit worth finding.",
            show_default="the scenario's, or 2% of the merit's range",
        ),
    ] = None,
    confidence: Annotated[
        float | None, typer.Option(help="Of the guarantee.", show_default="0.95")
    ] = None,
    guarantee: Annotated[
        Literal["indifference", "pgs"] | None,
        typer.Option(
            help="indifference: finds the best if it leads by delta. pgs: within delta of the "
            "best, whatever the truth.",
            show_default="indifference",
        ),
    ] = None,
    runs: Annotated[
        int | None,
        typer.Option(
            help="Runs of each configuration, with no guarantee.", show_default="as few as it takes"
        ),
    ] = None,
    merit: Annotated[
        Text,
        typer.Option(
            help="How runs are scored: a name, as equation-5.2, or weights, as "
            "time=-0.03,robots=-0.2,failed=-5."
        ),
    ] = None,
    max_runs: Annotated[
        int | None,
        typer.Option(
            help="Stop before more runs than this in all; nothing is guaranteed then.",
            show_default="no end",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0,
            max=2**64 - 1,
            help="Of all chance: same seed, same bytes.",
            show_default="0",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the study.", show_default="studies/NAME, or NAME-DIGEST"),
    ] = None,
    resume: Annotated[
        Path | None, typer.Option(help="Go on with the study in this folder.", show_default=False)
    ] = None,
    more: Annotated[
        float | None,
        typer.Option(
            help="With --resume: tighten to this confidence, with all runs so far.",
            show_default=False,
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=1, max=1024, help="Processes to run in.", show_default="threads of this one"
        ),
    ] = None,
    dask: Annotated[
        Text, typer.Option(help="Address of a Dask scheduler to run on.", show_default=False)
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print answer.json instead of the table.")
    ] = False,
) -> None:
    """Say how many of which robots to send, in as few runs as that takes.

    The folder keeps every run: stopped or killed, the study goes on when the same is asked again,
    or with --resume. It ends with answer.json and report.html in it. An option wins over what the
    scenario says.

    Exit codes: 0 answered, 1 the study cannot go on (the disk is full, the folder is damaged or
    another process has it, workers fail), 2 something given is not allowed, 130 stopped by Ctrl-C.

    Example: agent-economy study classic --vary robots.wanderer.count=1..12
    """
    with faults_told():
        changes = overrides(sets, vary, merit=merit, design=design)
        one_executor(workers, dask)
        if resume is not None:
            others = [scenario, changes or None, delta, confidence, guarantee, runs, max_runs]
            is_alone = all(each is None for each in [*others, seed, out])
            folder, asked = resume, resumed(resume, more, alone=is_alone)
        else:
            given = Scenario.load(required(scenario, more), changes)
            asked = studies.make_plan(
                given,
                seed=seed or 0,
                delta=delta,
                confidence=confidence,
                guarantee=guarantee or "indifference",
                runs=runs,
                max_runs=max_runs,
            )
            folder = out or usual_folder(asked)
        typer.echo(str(Question.of(asked)), err=True)
        found = watched(asked, folder, workers, dask)
    show(found, folder, as_json=as_json)


def watched(asked: Plan, folder: Path, workers: int | None, dask: str | None) -> studies.Answer:
    """Run a study and show how it goes on; say what is kept when Ctrl-C stops it."""
    teller = Teller([label(values) for values in asked.configurations])
    try:
        with computing(asked.engine, workers, dask) as compute, teller.shown() as on_progress:
            return studies.pursue(asked, folder, compute=compute, on_progress=on_progress)
    except KeyboardInterrupt:
        begun = (folder / "study.toml").exists()
        kept = f"; all are kept. Go on with: agent-economy study --resume {folder}"
        typer.echo(f"\nStopped after {teller.runs:,} runs{kept if begun else '.'}", err=True)
        raise typer.Exit(INTERRUPTED) from None


@contextmanager
def computing(engine: Engine, workers: int | None, dask: str | None) -> Iterator[Compute | None]:
    """Start what computes, other than threads of this process, and end it."""
    with ExitStack() as stack:
        if workers is not None:
            yield stack.enter_context(engine.in_processes(workers)).columns
        elif dask is not None:
            yield stack.enter_context(engine.on_dask(dask)).columns
        else:
            yield None


def one_executor(workers: int | None, dask: str | None) -> None:
    """Refuse two places to run in."""
    if workers is not None and dask is not None:
        message = "--workers, --dask: must be one of them: processes of this machine, or a cluster"
        raise InputError(message)


def required(scenario: Path | None, more: float | None) -> Path:
    """Return the scenario, which is needed without --resume."""
    if scenario is None:
        message = (
            "SCENARIO is missing: expected a TOML file or a name from `agent-economy scenarios`"
        )
        raise InputError(message)
    if more is not None:
        message = f"--more = {more:g}: must come with --resume FOLDER; else use --confidence"
        raise InputError(message)
    return scenario


def resumed(folder: Path, more: float | None, *, alone: bool) -> Plan:
    """Return the plan of a study to go on with."""
    if not alone:
        message = (
            "--resume: must be alone, or with --more, --workers, --dask and --json: what is asked "
            "stands in the folder"
        )
        raise InputError(message)
    asked = studies.plan_of(folder)
    return asked if more is None else tightened(asked, more)

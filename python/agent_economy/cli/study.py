"""The command `study`."""

import signal
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, redirect_stdout, suppress
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn

import typer

from agent_economy import study as studies
from agent_economy._core import InputError
from agent_economy.cli.answer_table import show
from agent_economy.cli.errors import INTERRUPTED, error_exits, print_warnings
from agent_economy.cli.options import ScenarioArgument, Sets, overrides
from agent_economy.cli.study_progress import ProgressDisplay
from agent_economy.scenario import Override, Scenario, TomlValue
from agent_economy.shell_word import shell_word
from agent_economy.study.answer.labels import label
from agent_economy.study.api import answer_so_far, resumed_plan
from agent_economy.study.description import Description, usual_folder
from agent_economy.study.engine import Engine
from agent_economy.study.plan import Plan, decided
from agent_economy.study.run_block import Compute
from agent_economy.study.store.folder import REPORT

QUESTION, PRECISION, COMPUTING = "Question", "Precision", "Computing"
"""Panels of options in the help."""


def study(  # noqa: PLR0913  (typer's options are arguments)
    scenario: Annotated[Path | None, ScenarioArgument] = None,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATH=VALUES",
            help="Values to compare, such as robots.wanderer.count=1..40; may be repeated.",
            show_default="the scenario's",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    only_vary: Annotated[
        bool,
        typer.Option(
            "--only-vary",
            help="Vary only the factors of --vary, not those of the scenario.",
            rich_help_panel=QUESTION,
        ),
    ] = False,
    sets: Sets = None,
    design: Annotated[
        str | None,
        typer.Option(
            help="Which combinations of values to compare: factorial, lhs:N or sobol:N (N points).",
            show_default="the scenario's",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    merit: Annotated[
        str | None,
        typer.Option(
            help="Figure of merit: a name such as equation-5.2, or weights such as "
            "time=-0.03,robots=-0.2,failed=-5.",
            show_default="the scenario's",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    require: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CONDITION",
            help="What a mission must meet, such as 'time_s <= 1200'; may be repeated. The study "
            "then selects the cheapest team that meets all.",
            show_default="the scenario's",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    minimize: Annotated[
        str | None,
        typer.Option(
            help="With a requirement, what is minimised: robots, price, or an expression of team "
            "sizes, such as rover_a + 2 * rover_b.",
            show_default="the scenario's, or robots",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    brains: Annotated[
        str | None,
        typer.Option(
            metavar="MODULE:NAME",
            help="Brains in Python: a dict by kind of robots, such as my_brains:BRAINS, of a "
            "module in the working folder or on PYTHONPATH. The study runs on all processors.",
            show_default="those of the scenario",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    controllers: Annotated[
        str | None,
        typer.Option(
            metavar="MODULE:NAME",
            help="Controllers in Python: a dict by kind of controllers, as --brains.",
            show_default="those of the scenario",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0,
            max=2**64 - 1,
            help="Random seed: the same seed gives the same bytes.",
            show_default="0",
            rich_help_panel=QUESTION,
        ),
    ] = None,
    delta: Annotated[
        float | None,
        typer.Option(
            help="Indifference zone: the smallest difference in mean merit that matters.",
            show_default="the scenario's, or 2% of the merit's range",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    confidence: Annotated[
        float | None,
        typer.Option(
            help="Probability that the guarantee holds. With --resume, a higher value raises the "
            "confidence and reuses all runs.",
            show_default="the scenario's, or 0.95",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    probability: Annotated[
        float | None,
        typer.Option(
            help="With a requirement, the share of missions that must meet it.",
            show_default="the scenario's, or 0.95",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(
            help="With a requirement, the share above --probability that need not be found.",
            show_default="the scenario's, or 40% of 1 - probability",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    decide: Annotated[
        bool,
        typer.Option(
            "--decide",
            help="With a requirement, continue until cheaper teams that may meet it are decided at "
            "a quarter of the tolerance, or --max-runs is reached; also with --resume.",
            rich_help_panel=PRECISION,
        ),
    ] = False,
    guarantee: Annotated[
        Literal["indifference", "pgs"] | None,
        typer.Option(
            help="indifference: selects the best configuration if it leads by delta. pgs: selects "
            "a configuration within delta of the best.",
            show_default="indifference",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    runs: Annotated[
        int | None,
        typer.Option(
            help="Fixed number of runs per configuration, without a guarantee.",
            show_default="the fewest that the guarantee allows",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    max_runs: Annotated[
        int | None,
        typer.Option(
            help="Run budget. If it is reached first, the answer carries no guarantee.",
            show_default="unlimited",
            rich_help_panel=PRECISION,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the study.", show_default="studies/NAME, or NAME-DIGEST"),
    ] = None,
    resume: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Resume the study in this folder.", show_default=False),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=1024,
            help="Number of worker processes.",
            show_default="threads of this process; with --brains or --controllers, one process "
            "per processor",
            rich_help_panel=COMPUTING,
        ),
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option(
            help="Address of a Dask scheduler.", show_default=False, rich_help_panel=COMPUTING
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print answer.json instead of a table.")
    ] = False,
) -> None:
    """Find the best team, or the cheapest that meets a requirement, with the fewest runs.

    The study's folder stores every run. A study that was stopped or killed continues when the
    command is repeated, or with --resume. The folder receives answer.json and report.html at the
    end. Options take precedence over the scenario.

    Exit codes: 0 answered; 1 the study cannot continue (the disk is full, the folder is damaged or
    in use, workers fail); 2 an argument or the scenario is invalid; 130 stopped by Ctrl-C: about a
    requirement, what the runs prove already is printed.

    Example: agent-economy study classic --vary robots.wanderer.count=1..12

    Example: agent-economy study search --require 'time_s <= 100' --probability 0.9

    Example: agent-economy study --resume studies/warehouse --decide --max-runs 20000
    """
    with error_exits():
        options: dict[str, TomlValue | None] = {
            "merit": merit,
            "study.design": design,
            "study.minimize": minimize,
            "require.all": require or None,
            "require.probability": probability,
            "require.tolerance": tolerance,
        }
        changes = overrides(sets, vary, only_vary=only_vary, options=options)
        precision: dict[str, Any] = {
            "seed": seed,
            "delta": delta,
            "guarantee": guarantee,
            "runs": runs,
            "max_runs": max_runs,
            "brains": brains,
            "controllers": controllers,
        }
        settings = {name: value for name, value in precision.items() if value is not None}
        refuse_two_executors(workers, dask)
        if require:
            refuse_with_requirement({"--merit": merit, **merit_options(settings)})
        if resume is None:
            if confidence is not None:
                settings["confidence"] = confidence
            if brains is not None or controllers is not None:
                import_from(Path.cwd())
            # What a user's module prints must not mix with --json.
            with redirect_stdout(sys.stderr):
                plan = studies.make_plan(Scenario.load(required(scenario), changes), **settings)
            if decide:
                plan = decided(plan, max_runs=max_runs)
            folder = out or usual_folder(plan)
        else:
            budget = settings.pop("max_runs", None) if decide else None
            others = {"SCENARIO": scenario, "--out": out} | settings
            refuse_with_resume(others, changes)
            folder = resume
            plan = resumed_plan(folder, confidence=confidence, decide=decide, max_runs=budget)
        if minimize is not None and plan.question.requirement is None:
            message = "--minimize: needs a requirement: --require, or [require] of the scenario"
            raise InputError(message)
        print_warnings(plan.warnings)
        typer.echo(str(Description.of(plan)), err=True)
        if vary and (also := others_varied(plan, vary)):
            typer.echo(f"also over {also}, of the scenario", err=True)
        for agents in plan.engine.agents:
            import_from(Path.cwd())
            typer.echo(f"with the {agents.parameter} {agents}", err=True)
        try:
            answer = compute_answer(plan, folder, workers, dask)
        except KeyboardInterrupt:
            conclude_stopped(folder, as_json=as_json)
    show(answer, folder / REPORT, as_json=as_json)


def import_from(folder: Path) -> None:
    """Let this process and its workers import agents from a folder, after all other modules."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))


def others_varied(plan: Plan, vary: list[str]) -> str:
    """Return the factors that the scenario varies besides those of --vary."""
    given = {text.partition("=")[0].strip() for text in vary}
    others = [factor for factor in plan.scenario.factors if factor.path not in given]
    return "; ".join(f"{factor.path} = {factor}" for factor in others)


def compute_answer(
    plan: Plan, folder: Path, workers: int | None, dask: str | None
) -> studies.AnyAnswer:
    """Run a study with a progress display."""
    display = ProgressDisplay([label(values) for values in plan.configurations])
    with executor(plan.engine, workers, dask) as compute, display.shown() as on_progress:
        return studies.run_plan(plan, folder, compute=compute, on_progress=on_progress)


def conclude_stopped(folder: Path, *, as_json: bool) -> NoReturn:
    """Print how to resume a stopped study, and what its runs prove already; then exit."""
    # A second Ctrl-C must not cut off how to resume.
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        typer.echo(f"\n{stopped(folder)}", err=True)
    finally:
        signal.signal(signal.SIGINT, before)
    with suppress(InputError):  # such as a folder without a study yet
        if answer := answer_so_far(folder):
            show(answer, None, as_json=as_json)
    raise typer.Exit(INTERRUPTED)


def stopped(folder: Path) -> str:
    """Return how many runs of a stopped study are stored, and how to resume it."""
    if not (folder / "study.toml").exists():
        return "Stopped after 0 runs."
    command = f"agent-economy study --resume {shell_word(folder)}"
    count = studies.open(folder).count()
    return f"Stopped after {count:,} runs; all are stored. Resume with: {command}"


@contextmanager
def executor(engine: Engine, workers: int | None, dask: str | None) -> Iterator[Compute | None]:
    """Start the executor of runs and stop it at the end; None for threads of this process."""
    with ExitStack() as stack:
        if workers is not None:
            yield stack.enter_context(engine.in_processes(workers)).columns
        elif dask is not None:
            yield stack.enter_context(engine.on_dask(dask, print_wait)).columns
        else:
            yield None


def print_wait(sentence: str) -> None:
    """Print that runs wait for workers."""
    typer.echo(sentence, err=True)


def merit_options(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that select the best by merit, of those that were given."""
    return {f"--{name}": settings.get(name) for name in ("delta", "guarantee", "runs")}


def refuse_with_requirement(options: Mapping[str, Any]) -> None:
    """Raise an error if options of a study of merit were given together with --require.

    Raises:
        InputError: If one was.
    """
    given = [name for name, value in options.items() if value is not None]
    if given:
        message = (
            f"--require, {', '.join(given)}: expected one question: the cheapest team that meets a "
            "requirement, or the best by merit"
        )
        raise InputError(message)


def refuse_two_executors(workers: int | None, dask: str | None) -> None:
    """Raise an error if runs are to be computed in two places.

    Raises:
        InputError: If both options are given.
    """
    if workers is not None and dask is not None:
        message = "--workers, --dask: expected one of them: local processes, or a cluster"
        raise InputError(message)


def required(scenario: Path | None) -> Path:
    """Return the scenario of a new study.

    Raises:
        InputError: If it is missing.
    """
    if scenario is None:
        message = (
            "SCENARIO is missing: expected a TOML file, or a name from agent-economy scenarios; "
            "or --resume FOLDER"
        )
        raise InputError(message)
    return scenario


def refuse_with_resume(others: dict[str, Any], changes: tuple[Override, ...]) -> None:
    """Raise an error for options that the folder of a study already defines.

    Raises:
        InputError: If an option is set.
    """
    given = [
        name if name.startswith("--") or name.isupper() else f"--{name.replace('_', '-')}"
        for name, value in others.items()
        if value is not None
    ]
    given += [change.origin for change in changes]
    if given:
        message = (
            f"--resume: cannot be combined with {', '.join(given)}: the folder already has the "
            "question; only --confidence, --decide (with --max-runs), --workers, --dask and --json "
            "are allowed"
        )
        raise InputError(message)

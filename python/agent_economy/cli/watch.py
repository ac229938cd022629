"""The command `watch`."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from agent_economy import study
from agent_economy.cli.progress import Teller
from agent_economy.cli.told import FAILED, INTERRUPTED, faults_told
from agent_economy.study.answer.labels import label
from agent_economy.study.progress import Progress

PAUSE_S = 0.5
"""Between two looks at the ledger."""


def watch(
    folder: Annotated[Path, typer.Argument(help="Folder of a study.", show_default=False)],
) -> None:
    """Show how far a study is that another process runs, until it is over; it is not disturbed.

    Exit codes: 0 the study is over, 1 it is not, but nobody works on it, 2 something given is not
    allowed, 130 stopped by Ctrl-C.

    Example: agent-economy watch studies/classic
    """
    with faults_told():
        names = [label(values) for values in study.plan_of(folder).configurations]
        try:
            with Teller(names).shown() as on_progress:
                is_over = False
                for progress in rounds(folder):
                    on_progress(progress)
                    is_over = progress.is_over
        except KeyboardInterrupt:
            raise typer.Exit(INTERRUPTED) from None
    if not is_over:
        message = f"Nobody works on it, and it is not over: agent-economy study --resume {folder}"
        typer.echo(message, err=True)
        raise typer.Exit(FAILED)
    typer.echo("The study is over.")


def rounds(folder: Path) -> Iterator[Progress]:
    """Yield a study's rounds, those over first and then each as it comes, while somebody works."""
    store = study.open(folder)
    done, begin, first_runs = 0, time.monotonic(), 0
    is_worked_on = True
    while is_worked_on:
        # Looked at before the rounds: what comes after the last look is seen in the next.
        is_worked_on = study.is_worked_on(folder)
        decisions = store.decisions()
        first_runs = first_runs or (decisions[-1].facts["runs"] if decisions else 0)
        # Another question of the same study begins its rounds anew.
        done = min(done, len(decisions))
        for decision in decisions[done:]:
            computed = max(0, decision.facts["runs"] - first_runs)
            seconds = time.monotonic() - begin
            yield Progress.of_facts(decision.round, decision.facts, computed, seconds)
        done = len(decisions)
        time.sleep(PAUSE_S if is_worked_on else 0)

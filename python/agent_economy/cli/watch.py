"""The command `watch`."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from agent_economy import study
from agent_economy.cli.errors import FAILED, INTERRUPTED, error_exits
from agent_economy.cli.study_progress import ProgressDisplay
from agent_economy.shell_word import shell_word
from agent_economy.study.answer.labels import label
from agent_economy.study.progress import Progress

PAUSE_S = 0.5
"""Time between two reads of the ledger."""


def watch(
    folder: Annotated[Path, typer.Argument(help="The folder of a study.", show_default=False)],
) -> None:
    """Show the progress of a study in another process until it is finished.

    Exit codes: 0 the study is finished; 1 it is unfinished and no process is working on it; 2 an
    argument is invalid; 130 stopped by Ctrl-C.

    Example: agent-economy watch studies/classic
    """
    with error_exits():
        names = [label(values) for values in study.load_plan(folder).configurations]
        try:
            with ProgressDisplay(names).shown() as on_progress:
                is_over = False
                for progress in rounds(folder):
                    on_progress(progress)
                    is_over = progress.is_over
        except KeyboardInterrupt:
            raise typer.Exit(INTERRUPTED) from None
    if not is_over:
        message = (
            "The study is unfinished and no process is working on it. "
            f"Resume with: agent-economy study --resume {shell_word(folder)}"
        )
        typer.echo(message, err=True)
        raise typer.Exit(FAILED)
    typer.echo("The study is finished.")


def rounds(folder: Path) -> Iterator[Progress]:
    """Yield the past rounds of a study, and then each new one while a process works on it."""
    store = study.open(folder)
    done, begin, first_runs = 0, time.monotonic(), 0
    is_locked = True
    while is_locked:
        # Read before the rounds: a round that ends in between is printed in the next pass.
        is_locked = study.is_locked(folder)
        decisions = store.decisions()
        first_runs = first_runs or (decisions[-1].facts["runs"] if decisions else 0)
        # Another question of the same study starts its rounds from zero.
        done = min(done, len(decisions))
        for decision in decisions[done:]:
            computed = max(0, decision.facts["runs"] - first_runs)
            seconds = time.monotonic() - begin
            yield Progress.of_facts(decision.round, decision.facts, computed, seconds)
        done = len(decisions)
        time.sleep(PAUSE_S if is_locked else 0)

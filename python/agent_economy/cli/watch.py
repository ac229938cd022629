"""The command `watch`."""

import math
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from agent_economy import study
from agent_economy.cli.progress import Teller
from agent_economy.cli.told import INTERRUPTED, faults_told
from agent_economy.study.answer.labels import label
from agent_economy.study.race import Progress

SILENCE_S = 30.0
"""After which somebody who watches is told that nothing happens."""

PAUSE_S = 0.5
"""Between two looks at the ledger."""


def watch(
    folder: Annotated[Path, typer.Argument(help="Folder of a study.", show_default=False)],
) -> None:
    """Show how far a study is that another process runs, until it is over; it is not disturbed.

    Exit codes: 0 the study is over, 2 something given is not allowed, 130 stopped by Ctrl-C.

    Example: agent-economy watch studies/classic
    """
    with faults_told():
        names = [label(values) for values in study.plan_of(folder).configurations]
        try:
            with Teller(names).shown() as on_progress:
                for progress in rounds(folder):
                    on_progress(progress)
        except KeyboardInterrupt:
            raise typer.Exit(INTERRUPTED) from None
    typer.echo("The study is over.")


def rounds(folder: Path) -> Iterator[Progress]:
    """Yield a study's rounds, those over first and then each as it comes, until the last."""
    store = study.open(folder)
    done, begin, first_runs = 0, time.monotonic(), 0
    said_at = time.monotonic()
    while True:
        decisions = store.decisions()
        if decisions[done:]:
            said_at = time.monotonic()
        elif time.monotonic() - said_at > SILENCE_S:
            said_at = math.inf
            typer.echo(f"{folder}: no round for {SILENCE_S:.0f} s; does it still run?", err=True)
        for decision in decisions[done:]:
            if done == 0:
                first_runs = decisions[-1].facts["runs"]
            done += 1
            computed = max(0, decision.facts["runs"] - first_runs)
            yield Progress.of_facts(
                decision.round, decision.facts, computed, time.monotonic() - begin
            )
            if decision.facts["is_over"]:
                return
        time.sleep(PAUSE_S)

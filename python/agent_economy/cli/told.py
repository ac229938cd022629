"""What goes wrong, as words on standard error and an exit code."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer

from agent_economy._core import InputError
from agent_economy.study.errors import StudyError

FAILED = 1
"""Exit code when a study cannot go on."""

BAD_INPUT = 2
"""Exit code when something given is not allowed."""

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


@contextmanager
def faults_told() -> Iterator[None]:
    """Say what is not allowed, why a study cannot go on, or that Ctrl-C came; end with its code."""
    try:
        yield
    # First, since what is wrong with a store is both.
    except StudyError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(FAILED) from None
    except InputError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from None
    except KeyboardInterrupt:
        typer.echo("\nStopped.", err=True)
        raise typer.Exit(INTERRUPTED) from None

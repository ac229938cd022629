"""Exceptions and warnings as messages on standard error, and exit codes."""

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import typer

import agent_economy as ae

FAILED = 1
"""Exit code when a command cannot be completed."""

BAD_INPUT = 2
"""Exit code when an argument, a scenario or a file is not allowed."""

INTERRUPTED = 130
"""Exit code after Ctrl-C, as in shells."""


def print_warnings(warnings: Iterable[object]) -> None:
    """Print warnings about a scenario, a line each; they do not change the exit code."""
    for warning in warnings:
        typer.echo(f"warning: {warning}", err=True)


def print_stopped() -> None:
    """Print that Ctrl-C has ended the command; a terminal has printed ^C in the same line."""
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    typer.echo("\nStopped." if is_terminal else "Stopped.", err=True)


@contextmanager
def error_exits() -> Iterator[None]:
    """Print an expected exception and exit with its code."""
    try:
        yield
    except KeyboardInterrupt:
        print_stopped()
        raise typer.Exit(INTERRUPTED) from None
    # Before InputError: the error of a damaged store is both.
    except ae.StudyError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(FAILED) from None
    except ae.InputError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from None

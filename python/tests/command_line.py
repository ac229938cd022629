"""Runs the command, in this process or in one of its own."""

import contextlib
import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from agent_economy.cli import app

COMMAND = [sys.executable, "-m", "agent_economy"]


def run(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command in this process, which saves loading all modules again."""
    words = list(map(str, arguments))
    with contextlib.chdir(cwd or Path.cwd()):
        result = CliRunner().invoke(app, words, catch_exceptions=False)
    return subprocess.CompletedProcess(words, result.exit_code, result.stdout, result.stderr)


def run_process(
    *arguments: str | Path, cwd: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run the command as a user does, and wait for it."""
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False
    )


def succeed(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command in this process, and require that it succeeds."""
    given = run(*arguments, cwd=cwd)
    assert given.returncode == 0, given.stderr
    return given


def refuse(*arguments: str | Path, cwd: Path | None = None, code: int = 2) -> str:
    """Run the command in this process, require that it fails, and return its errors."""
    given = run(*arguments, cwd=cwd)
    assert given.returncode == code, given.stderr
    assert "Traceback" not in given.stderr
    return given.stderr


def run_python(
    code: str, *arguments: str | Path, cwd: Path | None = None, check: bool = False
) -> subprocess.CompletedProcess[str]:
    """Run a program in a process of its own."""
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=60, check=check)

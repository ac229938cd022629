"""What a study leaves on disk: report.html, runs.parquet, answer.json."""

import errno
import json
import os
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from agent_economy._core import InputError
from agent_economy.study.answer import Answer
from agent_economy.study.runs import Runs
from agent_economy.study.versions import versions

NAMES = ("runs.parquet", "report.html", "answer.json")
"""What `write_all` writes."""


def check_writable(folder: Path) -> None:
    """Make a study's folder, if it is not there, and see that files can be written in it.

    Raises:
        InputError: If they cannot, before any time is spent on runs.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        for name in NAMES:
            if (folder / name).is_dir():
                raise IsADirectoryError(errno.EISDIR, f"{name} in it is a folder")
    except OSError as error:
        message = f"{folder}: cannot be written in ({error.strerror}): must be a folder to write in"
        raise InputError(message) from None


def write_all(folder: Path, runs: Runs, answer: Answer, page: str) -> None:
    """Write a study's files; each appears whole or not at all.

    All are written under temporary names first, so that a study that is stopped or finds the disk
    full leaves the files of the one before; then they are renamed, one after the other.

    Raises:
        InputError: If they cannot be written.
    """
    text = json.dumps(answer_dict(answer), indent=2, allow_nan=False) + "\n"
    writers: tuple[Callable[[Path], object], ...] = (
        lambda path: pq.write_table(runs.table(), path, compression="zstd"),
        lambda path: path.write_text(page, encoding="utf-8"),
        lambda path: path.write_text(text, encoding="utf-8"),
    )
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".unfinished-") as unfinished:
            for name, write in zip(NAMES, writers, strict=True):
                write(Path(unfinished) / name)
                sync(Path(unfinished) / name)
            for name in NAMES:
                (Path(unfinished) / name).replace(folder / name)
    except OSError as error:
        message = f"{folder}: cannot be written in ({error.strerror or error})"
        raise InputError(message) from None


def sync(path: Path) -> None:
    """Wait until a file is on the disk."""
    with path.open("r+b") as file:
        os.fsync(file.fileno())


def answer_dict(answer: Answer) -> dict[str, Any]:
    """Return an answer as JSON has it."""
    teams = [{**asdict(team), "is_tied": team.is_tied} for team in answer.teams]
    return {
        "sentence": answer.sentence,
        "best": answer.best,
        "tied": list(answer.tied),
        "teams": teams,
        "published": [asdict(team) for team in answer.published],
        "scenario": {
            name: value for name, value in asdict(answer.scenario).items() if name != "source"
        },
        "seed": answer.seed,
        "versions": versions(),
    }

"""A study that is killed repeatedly, at any time, gives the same answer."""

import os
import random
import signal
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import small_study
from forks import started

from agent_economy import study

KILLS = 200
KILLS_A_FOLDER = 10
SEED = 11


def undisturbed(folder: Path) -> float:
    """Run the small study to its end, and return its duration in seconds."""
    begin = time.monotonic()
    process = started(small_study.run_plan, folder)
    process.join()
    assert process.exitcode == 0
    return time.monotonic() - begin


def rows(folder: Path) -> list[tuple[object, ...]]:
    """Return all runs of a study, in order."""
    return study.open(folder).runs().order("configuration, run").fetchall()


@pytest.fixture
def quick_path(tmp_path: Path) -> Iterator[Path]:
    """Return a folder in memory if possible: unlike a power failure, a kill loses no pages."""
    memory = Path("/dev/shm")  # noqa: S108
    if not os.access(memory, os.W_OK):
        yield tmp_path
        return
    with tempfile.TemporaryDirectory(dir=memory) as folder:
        yield Path(folder)


def test_200_kills_lose_and_duplicate_nothing_and_change_no_byte(quick_path: Path) -> None:
    tmp_path = quick_path
    undisturbed(tmp_path / "warm-up")
    seconds = undisturbed(tmp_path / "whole")
    answer = (tmp_path / "whole/answer.json").read_bytes()
    expected = rows(tmp_path / "whole")
    assert len({row[:2] for row in expected}) == len(expected)

    chance = random.Random(SEED)  # noqa: S311
    kills = folders = 0
    while kills < KILLS:
        folder = tmp_path / f"killed-{folders}"
        folders += 1
        killed_here = 0
        while True:
            process = started(small_study.run_plan, folder)
            # From before the first write to after the end; finally, it may finish.
            process.join(chance.uniform(0, 1.1 * seconds) if killed_here < KILLS_A_FOLDER else None)
            process.kill()
            process.join()
            if process.exitcode == 0:
                break
            assert process.exitcode == -signal.SIGKILL
            killed_here += 1
        kills += killed_here
        assert (folder / "answer.json").read_bytes() == answer
        assert rows(folder) == expected
    assert folders > 10

"""Synthetic outcomes, which depend only on the configuration and the run."""

import itertools
import os
import resource
import signal
import time
from collections.abc import Callable, Generator
from multiprocessing.queues import Queue
from pathlib import Path

import numpy as np

from agent_economy import InputError
from agent_economy.study.run_block import Columns, Part, Partwise, RunBlock
from agent_economy.study.store import Column, Store, staging
from agent_economy.study.store.ledger import Ledger

COLUMNS = (Column("time_s", "real"), Column("failed", "flag"), Column("paints", "whole"))


def outcomes(area: RunBlock) -> Columns:
    """Return outcomes, with some times infinite and some runs quarantined."""
    configuration = np.array(area.configurations, dtype=np.float64)[:, None]
    run = np.arange(area.first_run, area.end, dtype=np.float64)[None, :]
    mixed = np.floor(np.modf(np.sin(configuration * 12.9898 + run * 78.233) * 43758.5453)[0] * 1000)
    paints = np.where(mixed > 990, np.inf, mixed)
    paints[mixed < -990] = np.nan
    time_s = np.where(mixed < -980, np.nan, mixed / 7)
    return {"time_s": time_s, "failed": (mixed > 990).astype(np.float64), "paints": paints}


def slow_outcomes(area: RunBlock) -> Columns:
    """Return outcomes after a tenth of a millisecond per run."""
    time.sleep(area.rows * 1e-4)
    return outcomes(area)


def killed_once(place: Path, area: RunBlock) -> Columns:
    """Kill the worker at run 30 of configuration 3, the first time in a folder."""
    if 3 in area.configurations and area.first_run <= 30 < area.end:
        try:
            (place / "killed").touch(exist_ok=False)
        except FileExistsError:
            pass
        else:
            os.kill(os.getpid(), signal.SIGKILL)
    return slow_outcomes(area)


def killed_always(area: RunBlock) -> Columns:
    """Kill the worker at run 30 of configuration 3."""
    if 3 in area.configurations and area.first_run <= 30 < area.end:
        os.kill(os.getpid(), signal.SIGKILL)
    return slow_outcomes(area)


def failing(area: RunBlock) -> Columns:
    """Fail at run 30 of configuration 3."""
    if 3 in area.configurations and area.first_run <= 30 < area.end:
        message = "the brain has no goal"
        raise ValueError(message)
    return outcomes(area)


def logged(place: Path, area: RunBlock) -> Columns:
    """Return outcomes, and create a file named after the block and the process."""
    name = f"{area.configurations[0]}-{len(area.configurations)}-{area.first_run}-{area.runs}"
    (place / f"{name}-{os.getpid()}-{time.monotonic_ns()}").touch()
    return slow_outcomes(area)


def same(left: Columns, right: Columns) -> bool:
    """Return whether outcomes are equal, including NaN and infinity."""
    return left.keys() == right.keys() and all(
        np.array_equal(left[name], right[name], equal_nan=True) for name in left
    )


def requested(boundaries: int) -> list[RunBlock]:
    """Return the blocks that a race of eight configurations requests while it eliminates them."""
    first, blocks = 0, []
    for number in range(boundaries):
        runs = max(10, first // 10)
        blocks.append(RunBlock(tuple(range(7 - number * 7 // boundaries, -1, -1)), first, runs))
        first += runs
    return blocks


def write_study(folder: Path, boundaries: int = 8) -> None:
    """Compute a whole study into a folder, or what is not there of it."""
    with Store.open(folder, "seed = 1\n", COLUMNS) as store:
        for number, block in enumerate(requested(boundaries)):
            data = store.block(block, outcomes)
            assert same(data, outcomes(block))
            store.note(number, {"survivors": list(block.configurations)})


def write_in_parts(folder: Path) -> None:
    """Compute a study of three blocks, each in parts."""

    def parts(block: RunBlock) -> Generator[Part]:
        for run in range(block.first_run, block.end, 4):
            part = RunBlock(block.configurations, run, min(4, block.end - run))
            yield part, outcomes(part)

    with Store.open(folder, "seed = 1\n", COLUMNS) as store:
        for block in requested(3):
            assert same(store.block(block, Partwise(parts)), outcomes(block))


def write_in_parts_and_die(folder: Path, calls: int) -> None:
    """Compute a study in parts, staged at once, killed at the nth call that touches the disk."""
    staging.STAGE_S = 0.0
    die_at_call(calls)
    write_in_parts(folder)


def write_and_die(folder: Path, calls: int) -> None:
    """Compute a study, killed at the nth call that touches the disk."""
    die_at_call(calls)
    write_study(folder, 3)


def die_at_call(calls: int) -> None:
    """Kill this process at the nth call that touches the disk."""
    left = itertools.count(calls, -1)

    def before(work: Callable[..., object]) -> Callable[..., object]:
        def deadly(*args: object, **options: object) -> object:
            if next(left) == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            return work(*args, **options)

        return deadly

    for name in ("open", "write", "fsync", "replace", "mkdir", "close"):
        setattr(os, name, before(getattr(os, name)))
    Ledger.enter = before(Ledger.enter)  # type: ignore[method-assign, assignment]
    for name in ("replace", "unlink"):
        setattr(Path, name, before(getattr(Path, name)))


def write_on_a_small_disk(folder: Path, max_bytes: int, answer: "Queue[str]") -> None:
    """Compute a study where no file may be larger than some bytes."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (max_bytes, max_bytes))
    try:
        write_study(folder)
    except InputError as error:
        answer.put(str(error))
    else:
        answer.put("")

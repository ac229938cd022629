"""Runs of an incomplete block: stored as they finish, and merged into the block's file."""

import os
import signal
from collections.abc import Generator
from pathlib import Path

import pytest
import synthetic_runs
from forks import started
from hypothesis import given
from hypothesis import strategies as st
from synthetic_runs import COLUMNS, outcomes, same

from agent_economy.study.run_block import Columns, Compute, Gathered, Part, Partwise, RunBlock
from agent_economy.study.store import Store, read, staging
from agent_economy.study.store import folder as files
from agent_economy.study.store.folder import STAGING

AREA = RunBlock((7, 3, 0, 4), 10, 30)
QUESTION = "seed = 1\n"


@pytest.fixture(autouse=True)
def _immediately(monkeypatch: pytest.MonkeyPatch) -> None:
    """Write every part as soon as it is finished."""
    monkeypatch.setattr(staging, "STAGE_S", 0.0)


def opened(folder: Path) -> Store:
    """Return a store with synthetic columns."""
    return Store.open(folder, QUESTION, COLUMNS)


def in_parts(seen: list[RunBlock], stop_after: int = 1000) -> Partwise:
    """Return a task that yields a few runs at a time, and is interrupted after some parts."""

    def parts(block: RunBlock) -> Generator[Part]:
        for first in range(block.first_run, block.end, 7):
            for each in block.configurations:
                part = RunBlock((each,), first, min(7, block.end - first))
                if len(seen) == stop_after:
                    raise KeyboardInterrupt
                seen.append(part)
                yield part, outcomes(part)

    return Partwise(parts)


def runs_of(blocks: list[RunBlock]) -> list[tuple[int, int]]:
    """Return the runs of blocks in order."""
    return sorted(
        (each, run)
        for block in blocks
        for each in block.configurations
        for run in range(block.first_run, block.end)
    )


def stored(folder: Path) -> list[tuple[int, int]]:
    """Return the runs that readers find, in order."""
    runs = read(folder).runs().project("configuration, run")
    return sorted(runs.fetchall())


def interrupted(folder: Path, stop_after: int, compute: Compute | None = None) -> list[RunBlock]:
    """Interrupt a block after some parts, and return these."""
    seen: list[RunBlock] = []
    with opened(folder) as store, pytest.raises(KeyboardInterrupt):
        store.block(AREA, compute or in_parts(seen, stop_after))
    return seen


@pytest.mark.parametrize("stop_after", [1, 3, 4, 6, 15])
def test_the_finished_runs_of_an_interrupted_block_are_not_lost(
    stop_after: int, tmp_path: Path
) -> None:
    done = interrupted(tmp_path, stop_after)
    assert stored(tmp_path) == runs_of(done)
    assert read(tmp_path).count() == len(runs_of(done))
    again: list[RunBlock] = []
    with opened(tmp_path) as store:
        assert same(store.block(AREA, in_parts(again)), outcomes(AREA))
        assert store.computed == AREA.rows - len(runs_of(done))
    assert runs_of([*done, *again]) == runs_of([AREA])
    assert stored(tmp_path) == runs_of([AREA])


def test_a_folder_that_was_interrupted_ends_with_the_same_bytes(tmp_path: Path) -> None:
    for stop_after in (2, 5, 3):
        interrupted(tmp_path / "parts", stop_after)
    for name in ("parts", "whole"):
        with opened(tmp_path / name) as store:
            store.block(AREA, outcomes)
    files = [
        {path.name: path.read_bytes() for path in (tmp_path / name / "blocks").iterdir()}
        for name in ("parts", "whole")
    ]
    assert files[0] == files[1]
    assert not (tmp_path / "parts" / STAGING).exists()


def test_staged_values_are_read_exactly(tmp_path: Path) -> None:
    interrupted(tmp_path, 12)
    relation = read(tmp_path).runs().order("configuration, run")
    staged = relation.fetchall()
    with opened(tmp_path) as store:
        store.block(AREA, outcomes)
    merged = [row for row in relation_rows(tmp_path) if row[:2] in {row[:2] for row in staged}]
    assert repr(staged) == repr(merged)
    assert relation.columns == ["configuration", "run", *outcomes(AREA), "quarantined"]


def relation_rows(folder: Path) -> list[tuple[object, ...]]:
    """Return all rows of a study in order."""
    return read(folder).runs().order("configuration, run").fetchall()


def test_a_block_of_other_configurations_uses_staged_runs(tmp_path: Path) -> None:
    done = interrupted(tmp_path, 15)
    fewer = RunBlock((0, 3), 10, 30)
    again: list[RunBlock] = []
    with opened(tmp_path) as store:
        assert same(store.block(fewer, in_parts(again)), outcomes(fewer))
    assert not {*runs_of(done)} & {*runs_of(again)}
    assert stored(tmp_path) == sorted({*runs_of(done), *runs_of([fewer])})


@pytest.mark.parametrize("lost", [1, 10, 39, 41, 200])
def test_an_incomplete_record_costs_only_its_runs(lost: int, tmp_path: Path) -> None:
    done = interrupted(tmp_path, 8)
    path = tmp_path / STAGING
    path.write_bytes(path.read_bytes()[:-lost])
    assert stored(tmp_path) == runs_of(done[:-1])
    with opened(tmp_path) as store:
        assert same(store.block(AREA, in_parts([])), outcomes(AREA))
    assert stored(tmp_path) == runs_of([AREA])


def test_a_damaged_record_and_those_after_it_are_computed_again(tmp_path: Path) -> None:
    interrupted(tmp_path, 8)
    path = tmp_path / STAGING
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    with opened(tmp_path) as store:
        assert same(store.block(AREA, in_parts([])), outcomes(AREA))


def test_a_failing_task_keeps_the_runs_that_it_finished(tmp_path: Path) -> None:
    def parts(block: RunBlock) -> Generator[Part]:
        yield from in_parts([], 1).parts(block)

    done = RunBlock((7,), 10, 7)
    with opened(tmp_path) as store, pytest.raises(KeyboardInterrupt):
        store.block(AREA, Partwise(parts))
    assert len(stored(tmp_path)) == done.rows


def test_an_interrupt_while_a_block_is_written_loses_none_of_its_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(staging, "STAGE_S", 60.0)
    with opened(tmp_path) as store, monkeypatch.context() as patched:
        patched.setattr(files, "write_whole", interrupt)
        with pytest.raises(KeyboardInterrupt):
            store.block(AREA, outcomes)
    assert stored(tmp_path) == runs_of([AREA])
    with opened(tmp_path) as store:
        assert same(store.block(AREA, refuse), outcomes(AREA))
    assert not (tmp_path / STAGING).exists()


@pytest.mark.parametrize("call", ["fsync", "close"])
def test_an_interrupt_while_runs_are_staged_stores_none_twice(
    call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = interrupted(tmp_path, 6)
    seen: list[RunBlock] = []
    real, left = getattr(os, call), [True]

    def interrupt_once(descriptor: int) -> None:
        real(descriptor)
        if len(seen) >= 4 and left and left.pop():
            raise KeyboardInterrupt

    with opened(tmp_path) as store, monkeypatch.context() as patched:
        patched.setattr(os, call, interrupt_once)
        with pytest.raises(KeyboardInterrupt):
            store.block(AREA, in_parts(seen))
    assert not left
    assert stored(tmp_path) == runs_of([*done, *seen])
    assert read(tmp_path).count() == len(stored(tmp_path))
    with opened(tmp_path) as store:
        assert same(store.block(AREA, in_parts([])), outcomes(AREA))


def test_a_record_that_is_stored_twice_counts_once(tmp_path: Path) -> None:
    done = interrupted(tmp_path, 6)
    path = tmp_path / STAGING
    path.write_bytes(path.read_bytes() * 2)
    assert stored(tmp_path) == runs_of(done)
    assert read(tmp_path).count() == len(runs_of(done))


def refuse(_: RunBlock) -> Columns:
    """Fail, because all requested runs should be stored already."""
    pytest.fail("runs are computed again")


def test_runs_are_written_together_and_quick_blocks_are_not_staged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(staging, "STAGE_S", 60.0)
    seen: list[RunBlock] = []
    done = interrupted(tmp_path, 9)
    assert stored(tmp_path) == runs_of(done)
    with opened(tmp_path) as store:
        store.block(RunBlock((1,), 0, 9), in_parts(seen))
        assert (tmp_path / STAGING).stat().st_size > 0  # of the interrupted block


def test_a_study_killed_at_every_disk_access_loses_at_most_one_part(tmp_path: Path) -> None:
    whole = tmp_path / "whole"
    synthetic_runs.write_in_parts(whole)
    expected = {path.name: path.read_bytes() for path in (whole / "blocks").iterdir()}
    for calls in range(300):
        folder = tmp_path / str(calls)
        process = started(synthetic_runs.write_in_parts_and_die, folder, calls)
        process.join()
        if process.exitcode == 0:
            break
        assert process.exitcode == -signal.SIGKILL
        before = stored(folder) if (folder / "study.toml").exists() else []
        assert len(before) == len({*before})
        synthetic_runs.write_in_parts(folder)
        found = {path.name: path.read_bytes() for path in (folder / "blocks").iterdir()}
        assert found == expected
        assert not (folder / STAGING).exists()
    else:
        pytest.fail("a study touches the disk less often")


@given(st.sets(st.tuples(st.integers(0, 4), st.integers(0, 6))))
def test_missing_runs_are_the_ones_that_were_not_put(known: set[tuple[int, int]]) -> None:
    block = RunBlock((2, 0, 4, 1, 3), 20, 7)
    gathered = Gathered(block)
    for each, run in known:
        part = RunBlock((each,), 20 + run, 1)
        gathered.put(part, outcomes(part))
    missing = list(gathered.missing())
    assert runs_of(missing) == sorted(
        {*runs_of([block])} - {(each, 20 + run) for each, run in known}
    )
    for part in missing:
        gathered.put(part, outcomes(part))
    assert same(gathered.columns, outcomes(block))
    assert gathered.rows == block.rows

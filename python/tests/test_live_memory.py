"""The memory that a drive of hours takes: in the server of its page, and in the warden."""

import gc
import itertools
import os
import random
import threading
import time
import tracemalloc
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

import agent_economy as ae
from agent_economy.live.channel import encode
from agent_economy.live.warden.history import History
from agent_economy.server.recordings import input_log
from agent_economy.server.recordings.input_log import InputLog, InputReader
from agent_economy.server.runs import outcome_series
from agent_economy.server.runs.live_run import LiveRun
from agent_economy.spool import Spool

ROBOTS = tuple(f"bender/{number}" for number in range(5))
STEPS = 1500
"""2.5 minutes of a drive: the inputs of this number of steps take 5 MB in memory."""

MAX_GROWTH_BYTES = 1_000_000
"""Less than a third of the inputs as objects; threads and caches of the process take some, too."""


def inputs(tick: int) -> Mapping[str, Any]:
    """Return percepts of real robots, as long as those of a drive."""
    chance = random.Random(tick)  # noqa: S311  (of a test)
    percept = {
        "time_s": 0.1 * tick + chance.random(),
        "scans": [{"age_s": chance.random(), "ranges_m": [chance.random()]} for _ in range(6)],
        "position": {"value": [10 + chance.random(), 15.0], "age_s": chance.random()},
        "heading_rad": {"value": chance.random(), "age_s": chance.random()},
    }
    return {
        name: percept | {"random_words": [chance.getrandbits(32) for _ in range(4)]}
        for name in ROBOTS
    }


def growth(work: Callable[[int], object], after: int, until: int) -> int:
    """Return by how much the memory grows while steps are done, after the first ones."""
    tracemalloc.start()
    try:
        for tick in range(after):
            work(tick)
        gc.collect()
        before = tracemalloc.get_traced_memory()[0]
        for tick in range(after, until):
            work(tick)
        gc.collect()
        return tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()


def test_the_memory_of_a_live_run_stays_flat(monkeypatch: pytest.MonkeyPatch) -> None:
    # The series is full after an hour of a drive; here, after the first steps.
    monkeypatch.setattr(outcome_series, "MAX_ROWS", 20)
    monkeypatch.setattr(input_log, "BLOCK_BYTES", 2**14)
    live = LiveRun(ae.Scenario.load("bender-team"), 7, ROBOTS)

    def work(tick: int) -> None:
        live.append(tick, {"percepts": inputs(tick)})
        assert live.seek(tick + 1, 60)

    assert growth(work, STEPS // 3, STEPS) < MAX_GROWTH_BYTES


def test_the_memory_of_a_live_run_stays_flat_while_it_lags_behind() -> None:
    live = LiveRun(ae.Scenario.load("bender-team"), 7, ROBOTS)

    def work(tick: int) -> None:
        live.append(tick, {"percepts": inputs(tick)})

    assert growth(work, STEPS // 3, STEPS) < MAX_GROWTH_BYTES
    assert live.seek(STEPS, 60)


def message(tick: int) -> bytes:
    return encode({"type": "input", "tick": tick, "inputs": inputs(tick)})


def blocks_of(history: History, loaded: threading.Event) -> Iterator[bytes]:
    """Yield all blocks of a history."""
    for number in itertools.count():
        while (block := history.block(number)) is None:
            assert loaded.wait(10)
            loaded.clear()
        yield block[0]
        if not block[1]:
            return


def test_the_memory_of_the_warden_stays_flat_and_nothing_is_missing() -> None:
    loaded = threading.Event()
    history = History(loaded.set)

    def work(tick: int) -> None:
        history.add(message(tick))
        while history._unwritten:  # on a busy machine, blocks wait for the thread
            time.sleep(0.001)

    assert growth(work, STEPS, 3 * STEPS) < MAX_GROWTH_BYTES
    for _ in range(2):  # a second server takes the run from its start, too
        content = b"".join(blocks_of(history, loaded))
        assert content == b"".join(map(message, range(3 * STEPS)))
    history.close()


def test_readers_of_an_input_log_get_what_was_added_each_from_its_beginning(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(input_log, "BLOCK_BYTES", 1000)
    log = InputLog()
    present = InputReader(log)
    assert present.get(0, {}) == {}
    ticks = [tick for tick in range(500) if tick % 7]
    for tick in ticks:
        log.append(tick, {"percepts": inputs(tick)})
        assert present.get(tick, {}) == {"percepts": inputs(tick)}
        assert present.get(tick + 1, {}) == {}
    late = InputReader(log)
    read = [late.get(tick, {}) for tick in range(510)]
    assert read == [{"percepts": inputs(tick)} if tick in ticks else {} for tick in range(510)]


def test_blocks_that_the_disk_refuses_are_kept_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = [os.urandom(1000) for _ in range(6)]
    spool, written = Spool(), os.pwrite

    def limited(file: int, data: bytes, at: int) -> int:
        if at >= 3000:
            message = "No space left on device"
            raise OSError(message)
        return written(file, data[:400], at)  # a disk may take a part of the data

    monkeypatch.setattr(os, "pwrite", limited)
    for block in blocks:
        spool.append(block)
    assert [spool[number] for number in range(len(spool))] == blocks


def test_without_a_folder_for_temporary_files_blocks_are_kept_in_memory(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "none"))
    spool = Spool()
    spool.append(b"block")
    assert spool[0] == b"block"

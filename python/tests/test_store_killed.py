"""A study that is killed at any time continues to the same bytes."""

import hashlib
import random
import signal
from pathlib import Path

import pytest
import synthetic_runs
from forks import FORKS, started

from agent_economy.study.store import read

KILLS = 40
SEED = 7
ROUNDS = 40


def blocks(folder: Path) -> dict[str, str]:
    """Return the hash of each block's file."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in (folder / "blocks").iterdir()
    }


def entered(folder: Path) -> dict[str, str]:
    """Return the ledger's hash of each block, after checking that each row exists exactly once."""
    if not (folder / "study.toml").exists():
        return {}
    there = read(folder).block_files()
    runs = read(folder).runs()
    rows = read(folder).count()  # also finished runs of a block that is not entered
    assert rows >= sum(block.block.rows for block in there)
    assert runs.count("*").fetchall() == [(rows,)]
    assert runs.project("configuration, run").distinct().count("*").fetchall() == [(rows,)]
    files = blocks(folder)
    hashes = {block.name: block.sha256 for block in there}
    assert {name: files[name] for name in hashes} == hashes
    return hashes


def whole(folder: Path, *boundaries: int) -> dict[str, str]:
    """Return the blocks of a study that was not killed."""
    synthetic_runs.write_study(folder, *boundaries)
    return blocks(folder)


def test_a_study_killed_at_random_ends_with_the_same_bytes(tmp_path: Path) -> None:
    chance = random.Random(SEED)  # noqa: S311
    kills, before = 0, dict[str, str]()
    while True:
        process = started(synthetic_runs.write_study, tmp_path / "study", ROUNDS)
        process.join(chance.uniform(0.01, 0.08) if kills < KILLS else None)
        process.kill()
        process.join()
        there = entered(tmp_path / "study")
        assert before.items() <= there.items()
        before = there
        if process.exitcode == 0:
            break
        assert process.exitcode == -signal.SIGKILL
        kills += 1
    assert kills >= 5
    assert blocks(tmp_path / "study") == whole(tmp_path / "whole", ROUNDS) == before


def test_a_study_killed_at_every_disk_access_continues(tmp_path: Path) -> None:
    blocks_of_whole = whole(tmp_path / "whole", 3)
    for calls in range(200):
        folder = tmp_path / str(calls)
        process = started(synthetic_runs.write_and_die, folder, calls)
        process.join()
        if process.exitcode == 0:
            break
        assert process.exitcode == -signal.SIGKILL
        there = entered(folder)
        synthetic_runs.write_study(folder, 3)
        assert there.items() <= blocks(folder).items()
        assert blocks(folder) == blocks_of_whole
    else:
        pytest.fail("a study touches the disk less often")


@pytest.mark.parametrize("max_bytes", [0, 6, 1000, 3000, 4096, 20_000, 50_000])
def test_a_study_on_a_full_disk_reports_it_and_continues_with_more_space(
    tmp_path: Path, max_bytes: int
) -> None:
    answer = FORKS.Queue()
    process = started(synthetic_runs.write_on_a_small_disk, tmp_path / "study", max_bytes, answer)
    message = answer.get(timeout=60)
    process.join()
    assert str(tmp_path) in message
    assert "cannot be" in message
    there = entered(tmp_path / "study")
    synthetic_runs.write_study(tmp_path / "study")
    assert there.items() <= blocks(tmp_path / "study").items()
    assert blocks(tmp_path / "study") == whole(tmp_path / "whole")

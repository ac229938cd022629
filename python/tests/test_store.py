"""The store of a study: its contents, what it rejects, and what readers see."""

import errno
import os
import resource
import sqlite3
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import run_python
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_runs import COLUMNS, outcomes, same, write_study

from agent_economy import InputError
from agent_economy.study.run_block import Columns, RunBlock, numbers, spans
from agent_economy.study.store import Column, Store, coverage, read
from agent_economy.study.store import folder as files
from agent_economy.study.store.ledger import BlockFile, Ledger

AREA = RunBlock((3, 0, 7), 10, 40)
QUESTION = 'scenario = "classic"\nseed = 1\n'


def refuse(area: RunBlock) -> Columns:
    """Fail, because all requested runs should be stored already."""
    pytest.fail(f"{area} is computed again")


def opened(folder: Path) -> Store:
    """Return a store with synthetic columns."""
    return Store.open(folder, QUESTION, COLUMNS)


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Return the folder of a study with one block."""
    with opened(tmp_path / "study") as store:
        store.block(AREA, outcomes)
    return tmp_path / "study"


def only_block(folder: Path) -> Path:
    """Return the file of the only block of a study."""
    (path,) = (folder / "blocks").iterdir()
    return path


def test_computed_runs_are_read_back_exactly(study: Path) -> None:
    there = outcomes(AREA)
    for values in (there["time_s"], there["paints"]):
        assert np.isnan(values).any()
    assert np.isinf(there["paints"]).any()
    with opened(study) as store:
        assert same(store.block(AREA, refuse), there)
        assert (store.rows, store.computed) == (120, 0)


def test_rows_are_in_the_requested_order(study: Path) -> None:
    turned = RunBlock((7, 3), 10, 40)
    with opened(study) as store:
        assert same(store.block(turned, refuse), outcomes(turned))


def test_only_missing_runs_are_computed(study: Path) -> None:
    requested = RunBlock((5, 7, 1, 0), 10, 40)
    seen = []

    def compute(area: RunBlock) -> Columns:
        seen.append(area)
        return outcomes(area)

    with opened(study) as store:
        assert same(store.block(requested, compute), outcomes(requested))
        assert store.computed == 80
    assert seen == [RunBlock((1, 5), 10, 40)]


def test_a_computed_block_is_returned_as_it_is_read_later(tmp_path: Path) -> None:
    area = RunBlock((0,), 0, 4)
    data = {
        "time_s": np.array([[-0.0, np.inf, np.nan, 1e-300]]),
        "failed": np.array([[-0.0, 1.0, np.nan, np.inf]]),
        "paints": np.array([[-0.0, -(2.0**52), np.nan, np.inf]]),
    }
    with opened(tmp_path) as store:
        first = store.block(area, lambda _: data)
        again = store.block(area, refuse)
    assert [first[name].tobytes() for name in data] == [again[name].tobytes() for name in data]
    assert same(first, data)


@pytest.mark.parametrize(
    ("name", "value"), [("failed", 2.0), ("paints", 0.5), ("paints", -np.inf), ("paints", 2.0**53)]
)
def test_a_value_that_cannot_be_stored_is_rejected(tmp_path: Path, name: str, value: float) -> None:
    data = outcomes(AREA)
    data[name][1, 2] = value
    with opened(tmp_path) as store, pytest.raises(ValueError, match=rf"column {name} \("):
        store.block(AREA, lambda _: data)


def test_other_columns_of_a_task_are_rejected(tmp_path: Path) -> None:
    with opened(tmp_path) as store:
        with pytest.raises(
            ValueError, match="compute returned lack failed, lack paints: must be time_s, "
        ):
            store.block(AREA, lambda _: {"time_s": np.zeros((3, 40))})
        with pytest.raises(ValueError, match="numbers of shape"):
            store.block(AREA, lambda area: {each: v[:2] for each, v in outcomes(area).items()})
        assert same(store.block(AREA, outcomes), outcomes(AREA))


def test_the_same_outcomes_give_the_same_bytes(tmp_path: Path) -> None:
    files_of = []
    for name, configurations in (("one", (0, 1, 2)), ("two", (2, 0, 1))):
        with opened(tmp_path / name) as store:
            store.block(RunBlock(configurations, 0, 50), outcomes)
        files_of.append({p.name: p.read_bytes() for p in (tmp_path / name / "blocks").iterdir()})
    assert files_of[0] == files_of[1]


def test_large_blocks_are_split_by_the_request_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(coverage, "MAX_ROWS", 100)
    area = RunBlock((4, 2, 0, 1, 3), 1000, 30)
    tall = RunBlock((0, 1), 2000, 250)
    with opened(tmp_path) as store:
        assert same(store.block(area, outcomes), outcomes(area))
        assert same(store.block(tall, outcomes), outcomes(tall))
        assert same(store.block(tall, refuse), outcomes(tall))
    shapes = [block.block for block in read(tmp_path).block_files()]
    assert shapes[:2] == [RunBlock((0, 1, 2), 1000, 30), RunBlock((3, 4), 1000, 30)]
    assert {each.first_run for each in shapes[2:]} == {2000, 2100, 2200}


FIRST_RUNS = (0, 10, 20, 33, 50)
areas = st.builds(
    lambda configurations, place: RunBlock(
        tuple(configurations), FIRST_RUNS[place], FIRST_RUNS[place + 1] - FIRST_RUNS[place]
    ),
    st.lists(st.integers(0, 9), min_size=1, unique=True),
    st.integers(0, len(FIRST_RUNS) - 2),
)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(areas, st.booleans()), max_size=12))
def test_any_blocks_in_any_order_are_computed_once(requests: list[tuple[RunBlock, bool]]) -> None:
    times: Counter[tuple[int, int]] = Counter()

    def compute(area: RunBlock) -> Columns:
        times.update(
            (each, run) for each in area.configurations for run in range(area.first_run, area.end)
        )
        return outcomes(area)

    with tempfile.TemporaryDirectory() as place, pytest.MonkeyPatch.context() as patch:
        patch.setattr(coverage, "MAX_ROWS", 64)
        patch.setattr(os, "fsync", lambda _: None)
        store = opened(Path(place))
        for area, again in requests:
            if again:
                store.close()
                store = opened(Path(place))
            assert same(store.block(area, compute), outcomes(area))
        rows = store.rows
        store.close()
        assert set(times.values()) <= {1}
        assert rows == len(times)
        found = read(Path(place)).runs().project("configuration, run").fetchall()
        assert sorted(found) == sorted(times)


def test_runs_that_overlap_stored_ones_are_rejected(study: Path) -> None:
    with opened(study) as store:
        for first_run, runs in ((10, 41), (0, 11), (49, 5), (11, 2), (0, 100)):
            with pytest.raises(InputError, match="stores runs 10-49 as one block"):
                store.block(RunBlock((0,), first_run, runs), refuse)
        assert store.block(RunBlock((0,), 50, 5), outcomes)
        assert store.block(RunBlock((0,), 0, 10), outcomes)


def test_another_study_is_rejected_with_the_differences(study: Path) -> None:
    with pytest.raises(InputError) as caught:
        Store.open(study, QUESTION.replace("seed = 1", "seed = 2"), COLUMNS)
    message = str(caught.value)
    assert "another study: use another folder (--out)" in message
    assert "existing: seed = 1" in message
    assert "requested: seed = 2" in message
    assert "classic" not in message


def test_a_study_without_its_question_is_rejected(study: Path) -> None:
    (study / "study.toml").unlink()
    with pytest.raises(InputError, match="study.toml: is missing, but there are results"):
        opened(study)
    with pytest.raises(InputError, match="contains no study"):
        read(study)


def test_other_columns_are_rejected(study: Path) -> None:
    with pytest.raises(InputError, match=r"other columns \(time_s \(real\)"):
        Store.open(study, QUESTION, [*COLUMNS[:2], Column("paints", "real")])


def test_a_reserved_column_name_is_rejected(tmp_path: Path) -> None:
    for names in ((), ("run",), ("a", "a")):
        with pytest.raises(ValueError, match="columns of different names"):
            Store.open(tmp_path, QUESTION, [Column(name, "real") for name in names])


def test_any_number_of_columns_is_stored(tmp_path: Path) -> None:
    columns = [Column(f"c{place}", "real") for place in range(200)]
    values = np.array([[0.5, np.inf, np.nan, np.nan]])
    data = {column.name: values for column in columns}
    data["c0"] = np.array([[0.5, 1.0, 2.0, np.nan]])
    block = RunBlock((0,), 0, 4)
    with Store.open(tmp_path, QUESTION, columns) as store:
        assert same(store.block(block, lambda _: data), data)
    with Store.open(tmp_path, QUESTION, columns) as store:
        assert same(store.block(block, refuse), data)
    assert read(tmp_path).runs().filter("NOT quarantined").count("*").fetchall() == [(2,)]
    data["c199"] = np.array([[0.5, np.inf, 1.0, np.nan]])
    with (
        Store.open(tmp_path, QUESTION, columns) as store,
        pytest.raises(ValueError, match="column c199 must be NaN in the same runs as c198"),
    ):
        store.block(RunBlock((1,), 0, 4), lambda _: data)


def test_a_newer_ledger_is_rejected(study: Path) -> None:
    with sqlite3.connect(study / "ledger.sqlite") as connection:
        connection.execute("PRAGMA user_version = 2")
    connection.close()
    for attempt in (opened, lambda folder: read(folder).block_files()):
        with pytest.raises(InputError, match=r"newer version of this program \(ledger format 2"):
            attempt(study)


def test_a_ledger_of_another_program_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(QUESTION)
    with sqlite3.connect(tmp_path / "ledger.sqlite") as connection:
        connection.execute("CREATE TABLE block (name)")
    connection.close()
    with pytest.raises(InputError, match="ledger.sqlite: is not a ledger of a study"):
        opened(tmp_path)


def test_a_ledger_must_be_a_database(study: Path) -> None:
    (study / "ledger.sqlite").write_text("These are not the rows you are looking for. " * 100)
    for attempt in (opened, lambda folder: read(folder).runs()):
        with pytest.raises(InputError, match="ledger.sqlite: cannot be .*not a database"):
            attempt(study)


def test_a_changed_block_is_rejected(study: Path) -> None:
    data = bytearray(only_block(study).read_bytes())
    data[100] ^= 1
    only_block(study).write_bytes(data)
    with opened(study) as store, pytest.raises(InputError, match="parquet: is damaged"):
        store.block(AREA, refuse)


def test_missing_and_shortened_blocks_are_all_named(study: Path) -> None:
    with opened(study) as store:
        store.block(RunBlock((0,), 100, 40), outcomes)
        store.block(RunBlock((0,), 200, 40), outcomes)
        first, second, _ = sorted((study / "blocks").iterdir())
        first.unlink()
        second.write_bytes(second.read_bytes()[:-1])
        with pytest.raises(InputError, match="is missing"):
            store.block(AREA, refuse)
    for attempt in (opened, lambda folder: read(folder).runs()):
        with pytest.raises(InputError) as caught:
            attempt(study)
        assert f"{first}: is missing" in str(caught.value)
        assert f"{second}: is damaged" in str(caught.value)


def test_other_outcomes_of_the_same_runs_are_rejected(study: Path) -> None:
    entered = read(study).block_files()[0]
    with opened(study) as store:
        store._ledger.enter(entered)
        with pytest.raises(InputError, match="the same runs had other outcomes"):
            store._ledger.enter(BlockFile(entered.block, entered.bytes, "0" * 64))
    assert read(study).block_files() == [entered]


def test_a_block_without_a_ledger_entry_is_overwritten(study: Path) -> None:
    there = only_block(study).read_bytes()
    with sqlite3.connect(study / "ledger.sqlite") as connection:
        connection.execute("DELETE FROM block")
    connection.close()
    only_block(study).write_bytes(b"half")
    (study / "blocks" / ".unfinished-000000000010-0000000.parquet").write_bytes(b"less")
    (study / ".unfinished-study.toml").write_bytes(b"s")
    with opened(study) as store:
        assert not list(study.rglob(".unfinished-*"))
        assert store.rows == 0
        store.block(AREA, outcomes)
    assert only_block(study).read_bytes() == there


def test_an_interrupted_computation_leaves_the_store_usable(study: Path) -> None:
    def interrupted(_: RunBlock) -> Columns:
        raise KeyboardInterrupt

    other = RunBlock((0, 1), 50, 10)
    with opened(study) as store:
        with pytest.raises(KeyboardInterrupt):
            store.block(other, interrupted)
        assert same(store.block(other, outcomes), outcomes(other))


def test_only_one_process_writes(study: Path) -> None:
    hold = (
        "import sys, time; from pathlib import Path; sys.path[:0] = sys.argv[1:2];"
        "from synthetic_runs import COLUMNS; from agent_economy.study.store import Store;"
        "Store.open(Path(sys.argv[2]), sys.argv[3], COLUMNS); print('held', flush=True);"
        "time.sleep(60)"
    )
    command = [sys.executable, "-c", hold, str(Path(__file__).parent), str(study), QUESTION]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(InputError, match="study: another process is using it"):
            opened(study)
        assert len(read(study).block_files()) == 1
        holder.kill()
    with opened(study) as store:
        assert store.rows == 120


def test_a_full_disk_is_an_error_and_the_study_can_continue(study: Path) -> None:
    other = RunBlock((0, 1), 50, 10)
    with opened(study) as store:
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, limits[1]))
        try:
            with pytest.raises(InputError, match=r"blocks/.* \(File too large\)"):
                store.block(other, outcomes)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert [path.name[0] for path in (study / "blocks").iterdir()] == ["0"]
        assert store.rows == 120
        assert same(store.block(other, outcomes), outcomes(other))


def test_a_ledger_on_a_full_disk_keeps_its_entries(study: Path) -> None:
    with opened(study) as store:
        pages = store._ledger._connection.execute("PRAGMA page_count").fetchone()[0]
        store._ledger._connection.execute(f"PRAGMA max_page_count = {pages}")
        with pytest.raises(InputError, match="ledger.sqlite: .*database or disk is full"):
            store.note(0, {"survivors": list(range(100_000))})
        store._ledger._connection.execute("PRAGMA max_page_count = 1000000")
        store.note(1, {})
    assert read(study).decisions()[-1].round == 1
    with opened(study) as store:
        assert same(store.block(AREA, refuse), outcomes(AREA))


def test_a_read_only_folder_is_named(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def read_only(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    with monkeypatch.context() as patch:
        patch.setattr(os, "open", read_only)
        with pytest.raises(InputError, match=r"study: cannot be .* \(Read-only file system\)"):
            opened(study)
    (study.parent / "file").touch()
    with pytest.raises(InputError, match=r"file/study: cannot be created \(Not a directory\)"):
        opened(study.parent / "file" / "study")
    assert opened(study).rows == 120


def test_a_read_only_folder_can_be_read(study: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("the superuser can write anywhere")
    study.chmod(0o555)
    try:
        assert read(study).runs().count("*").fetchall() == [(120,)]
    finally:
        study.chmod(0o755)


def test_a_study_can_be_read_while_it_is_written(tmp_path: Path) -> None:
    with opened(tmp_path) as store:
        watcher = read(tmp_path)
        assert watcher.question == QUESTION
        assert watcher.columns() == COLUMNS
        assert watcher.runs().fetchall() == []
        assert watcher.runs().columns == ["configuration", "run", *outcomes(AREA), "quarantined"]
        for number in range(5):
            store.block(RunBlock((0, 1), number * 10, 10), outcomes)
            store.note(number, {"survivors": [0, 1]})
            relation = watcher.runs()
            assert relation.count("*").fetchall() == [(20 * number + 20,)]
            assert len(watcher.decisions()) == number + 1


def test_runs_can_be_queried_in_sql(study: Path) -> None:
    runs = read(study).runs()
    assert runs.types == ["INTEGER", "BIGINT", "DOUBLE", "BOOLEAN", "BIGINT", "BOOLEAN"]
    there = outcomes(AREA)
    ok = ~(np.isnan(there["time_s"]) | np.isnan(there["paints"]))
    never = runs.filter("NOT quarantined AND paints IS NULL").count("*").fetchall()
    assert never == [(np.isinf(there["paints"]).sum(),)]
    assert runs.filter("NOT quarantined").count("*").fetchall() == [(ok.sum(),)]
    ((mean,),) = runs.filter("configuration = 7 AND NOT quarantined").mean("time_s").fetchall()
    assert mean == pytest.approx(there["time_s"][2][ok[2]].mean())


def test_decisions_replayed_change_nothing(tmp_path: Path) -> None:
    rounds: list[dict[str, Any]] = [
        {"survivors": [0, 1, 2]},
        {"survivors": [0, 2]},
        {"survivors": [2], "runs": 30},
    ]
    with opened(tmp_path) as store:
        for number, facts in enumerate(rounds):
            store.note(number, facts)
        store.note(0, rounds[0])
        assert [decision.facts for decision in read(tmp_path).decisions()] == rounds
        store.note(1, {"survivors": [0, 1]})
    noted = read(tmp_path).decisions()
    assert [(each.round, each.facts) for each in noted] == [
        (0, rounds[0]),
        (1, {"survivors": [0, 1]}),
    ]


def test_a_study_creates_its_own_files_only(tmp_path: Path) -> None:
    write_study(tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {".lock", "blocks", "ledger.sqlite", "study.toml"}


def test_a_study_is_written_and_read_without_pandas(tmp_path: Path) -> None:
    code = "import synthetic_runs, pathlib, sys; folder = pathlib.Path(sys.argv[1]);"
    code += "synthetic_runs.write_study(folder); synthetic_runs.write_study(folder);"
    code += "sys.exit('pandas' in sys.modules)"
    run_python(code, tmp_path, cwd=Path(__file__).parent, check=True)


def test_the_query_engine_is_imported_at_the_first_query() -> None:
    code = "import agent_economy.study.store, agent_economy.study.executors, sys;"
    code += "sys.exit('duckdb' in sys.modules or 'distributed' in sys.modules)"
    run_python(code, check=True)


@given(st.sets(st.integers(0, 2**31 - 1), min_size=1))
def test_numbers_can_be_converted_to_spans_and_back(given_numbers: set[int]) -> None:
    assert numbers(spans(given_numbers)) == tuple(sorted(given_numbers))


def test_spans_are_short() -> None:
    assert spans([5, 1, 2, 3, 9, 8]) == "1-3,5,8-9"


@pytest.mark.parametrize("area", [((), 0, 1), ((1, 1), 0, 1), ((0,), 0, 0), ((-1,), 0, 1)])
def test_a_block_is_not_empty_and_has_no_duplicates(area: tuple[tuple[int, ...], int, int]) -> None:
    with pytest.raises(ValueError, match="a block has"):
        RunBlock(*area)


def test_a_study_that_has_not_started_has_no_runs(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(QUESTION)
    assert read(tmp_path).block_files() == []
    sqlite3.connect(tmp_path / "ledger.sqlite").execute("PRAGMA journal_mode = WAL").close()
    assert read(tmp_path).decisions() == []
    assert read(tmp_path).runs().columns == ["configuration", "run", "quarantined"]


def test_a_partly_created_ledger_is_created_again(tmp_path: Path) -> None:
    files.make(tmp_path)
    (tmp_path / "ledger.sqlite").touch()
    (tmp_path / "study.toml").write_text(QUESTION)
    sqlite3.connect(tmp_path / "ledger.sqlite").execute("PRAGMA journal_mode = WAL").close()
    with opened(tmp_path) as store:
        assert same(store.block(AREA, outcomes), outcomes(AREA))
    ledger = Ledger.read(tmp_path / "ledger.sqlite")
    assert len(ledger.block_files()) == 1
    ledger.close()


ODD_NAMES = [
    "night[1]",
    "star*",
    "q?",
    "~",
    "[!a]",
    "k=v",
    "it's",
    'a"b',
    "back\\slash",
    "%20",
    "é",
    "file:t",
    "file:/t",
    "file:t?mode=memory",
    ":memory:",
    "s3:",
    "{a,b}",
    "-x",
    "#",
    "a&immutable=1",
    "a\nb",
    "a\x01b",
    "...",
    " ",
]


@pytest.mark.parametrize("name", [*ODD_NAMES, os.fsdecode(b"caf\xe9")])
def test_a_folder_of_any_name_has_its_own_runs_only(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for sibling in ("night1", "starX", "qA", "b", "v", "t"):
        with opened(Path(sibling)) as store:
            store.block(RunBlock((1,), 0, 7), outcomes)
    with opened(Path(name)) as store:
        store.block(AREA, outcomes)
    for folder in (Path(name), tmp_path / name):
        runs = read(folder).runs()
        assert runs.columns == ["configuration", "run", *outcomes(AREA), "quarantined"]
        found = runs.project("configuration, run").order("configuration, run").fetchall()
        assert found == [(each, run) for each in (0, 3, 7) for run in range(10, 50)]

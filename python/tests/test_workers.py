"""Workers: results do not depend on chunks, and a killed worker loses none."""

import os
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pytest
import synthetic_runs
from dask_cluster import Cluster, free_port
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_runs import outcomes, same

from agent_economy import InputError, StudyError
from agent_economy.study.executors import LocalExecutor, dask_executor
from agent_economy.study.run_block import Columns, RunBlock
from agent_economy.study.workers import CHUNK_S, Throughput, Workers, next_part

AREA = RunBlock((4, 3, 2, 1, 0, 9, 8), 20, 1000)


def two_processes() -> Executor:
    """Return two workers."""
    return LocalExecutor(2)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(0, 30), min_size=1, max_size=12, unique=True),
    st.integers(1, 300),
    st.integers(1, 5),
)
def test_results_do_not_depend_on_the_chunks(names: list[int], runs: int, count: int) -> None:
    areas = [RunBlock(tuple(names), 70, runs), RunBlock(tuple(names[:1]), 0, runs)]
    with Workers(lambda: ThreadPoolExecutor(count), count, outcomes) as workers:
        for area in areas:
            assert same(workers.columns(area), outcomes(area))


@settings(deadline=None)
@given(
    st.integers(1, 3000),
    st.integers(1, 100_000),
    st.integers(1, 256),
    st.floats(1e-3, 1e9),
)
def test_chunks_cover_a_block_once_and_take_at_most_a_second(
    configurations: int, runs: int, workers: int, duration_s: float
) -> None:
    area = RunBlock(tuple(range(configurations)), 0, runs)
    rate = area.rows / duration_s
    throughput = Throughput()
    throughput.add(1000, 1000 / rate)
    row, run, given_out, chunks = 0, 0, 0, 0
    while given_out < area.rows and chunks < 2000:
        rows = throughput.chunk_rows(area.rows, area.rows - given_out, workers)
        assert rows == 1 or rows <= rate * CHUNK_S + 1
        chunk = next_part(area, given_out, rows)
        assert (chunk.runs.configurations[0], chunk.runs.first_run) == (row, run)
        given_out += chunk.runs.rows
        row, run = divmod(given_out, runs)
        chunks += 1
    assert given_out <= area.rows
    if given_out == area.rows:
        assert min(workers, area.rows) <= chunks


def test_chunks_take_about_a_second_at_a_known_rate() -> None:
    throughput = Throughput()
    assert throughput.chunk_rows(100_000, 100_000, 2) == 1  # no rate is known
    throughput.add(500, 2.0)
    assert throughput.chunk_rows(100_000, 100_000, 2) == 250
    assert throughput.chunk_rows(100_000, 400, 2) == 100  # all workers finish together
    assert throughput.chunk_rows(1000, 100, 2) == 25
    assert throughput.chunk_rows(1000, 4, 2) == 12  # a twentieth of a second


def test_every_run_is_computed_once(tmp_path: Path) -> None:
    with Workers(two_processes, 2, partial(synthetic_runs.logged, tmp_path)) as workers:
        assert same(workers.columns(AREA), outcomes(AREA))
    rows = Counter[int]()
    for path in tmp_path.iterdir():
        first, count, first_run, runs, pid, _ = map(int, path.name.split("-"))
        assert 0 <= first <= 9
        assert first_run >= 20
        rows[pid] += count * runs
    assert sum(rows.values()) == AREA.rows
    assert len(rows) == 2


def test_a_killed_worker_changes_no_result(tmp_path: Path) -> None:
    with Workers(two_processes, 2, partial(synthetic_runs.killed_once, tmp_path)) as workers:
        assert same(workers.columns(AREA), outcomes(AREA))
        assert (tmp_path / "killed").exists()
        assert same(workers.columns(AREA), outcomes(AREA))


def test_runs_that_always_fail_stop_the_study_and_are_named() -> None:
    with (
        Workers(two_processes, 2, synthetic_runs.failing) as workers,
        pytest.raises(StudyError) as caught,
    ):
        workers.columns(AREA)
    expected = (
        r"configurations [0-9,-]+, runs \d+-\d+ failed 3 times, "
        r"the last time with ValueError: the brain"
    )
    assert re.match(expected, str(caught.value))


def test_runs_that_always_kill_their_worker_stop_the_study_and_are_named() -> None:
    area = RunBlock(tuple(range(8)), 0, 400)
    with (
        Workers(two_processes, 2, synthetic_runs.killed_always) as workers,
        pytest.raises(StudyError, match="3 times, the last time with BrokenProcessPool") as caught,
    ):
        workers.columns(area)
    assert "configurations 3, runs" in str(caught.value)


class Unwilling(Executor):
    """An executor that accepts no work."""

    def submit(self, *_: object, **__: object) -> Future[object]:  # type: ignore[override]
        """Raise an error."""
        message = "cannot schedule new futures after shutdown"
        raise RuntimeError(message)


def test_an_executor_that_accepts_no_work_stops_the_study() -> None:
    with (
        Workers(Unwilling, 2, outcomes) as workers,
        pytest.raises(
            StudyError, match="failed 3 times, the last time with RuntimeError: cannot sched"
        ),
    ):
        workers.columns(AREA)


@pytest.mark.parametrize(
    ("task", "reason"),
    [
        (lambda _: {}, "compute returned no columns for configurations"),
        (lambda area: {"time_s": outcomes(area)["time_s"][:, 1:]}, "numbers of shape"),
        (lambda area: [outcomes(area)], "compute returned list for configurations"),
    ],
)
def test_an_incomplete_result_of_a_task_stops_the_study(
    task: partial[Columns], reason: str
) -> None:
    with (
        Workers(lambda: ThreadPoolExecutor(2), 2, task) as workers,
        pytest.raises(InputError, match=reason),
    ):
        workers.columns(AREA)


INTERRUPTED = """
import os, time
from synthetic_runs import RunBlock
from agent_economy.study.executors import LocalExecutor
from agent_economy.study.workers import Workers

def task(area):
    os.write(1, b"begun\\n")
    time.sleep(60)

if __name__ == "__main__":
    with Workers(lambda: LocalExecutor(2), 2, task) as workers:
        workers.columns(RunBlock((0, 1), 0, 10))
"""


def interrupted(tmp_path: Path) -> tuple[subprocess.Popen[str], str]:
    """Return a program whose two workers have started a minute of work."""
    (tmp_path / "program.py").write_text(INTERRUPTED)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    process = subprocess.Popen(
        [sys.executable, tmp_path / "program.py"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        start_new_session=True,
    )
    assert process.stdout
    begun = process.stdout.readline()
    begun += process.stdout.readline()
    return process, begun


def test_ctrl_c_stops_the_workers_immediately(tmp_path: Path) -> None:
    process, begun = interrupted(tmp_path)
    assert begun == "begun\nbegun\n"
    begin = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)  # to the workers too, as a terminal does
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - begin < 5
    assert errors.count("Traceback") == 1
    assert errors.endswith("KeyboardInterrupt\n")
    assert ends(process.pid)


def test_workers_stop_with_a_killed_study(tmp_path: Path) -> None:
    process, begun = interrupted(tmp_path)
    assert begun == "begun\nbegun\n"
    process.kill()
    process.communicate(timeout=30)
    assert ends(process.pid)


def ends(group: int) -> bool:
    """Return whether a process group ends within some seconds."""
    for _ in range(100):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


def test_a_killed_dask_worker_changes_no_result(cluster: Cluster, tmp_path: Path) -> None:
    address, _ = cluster
    task = partial(synthetic_runs.killed_once, tmp_path)
    with Workers(partial(dask_executor, address), 2, task) as workers:
        assert same(workers.columns(AREA), outcomes(AREA))
        assert (tmp_path / "killed").exists()
        assert same(workers.columns(AREA), outcomes(AREA))


def test_runs_that_always_fail_on_dask_stop_the_study_and_are_named(cluster: Cluster) -> None:
    address, _ = cluster
    with (
        Workers(partial(dask_executor, address), 2, synthetic_runs.failing) as workers,
        pytest.raises(StudyError, match="the last time with ValueError: the brain has no goal"),
    ):
        workers.columns(AREA)


def test_a_killed_scheduler_stops_the_study(
    cluster: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    address, processes = cluster
    monkeypatch.setattr("agent_economy.study.executors.CONNECT_S", 2)
    with Workers(partial(dask_executor, address), 2, synthetic_runs.slow_outcomes) as workers:
        assert same(workers.columns(AREA), outcomes(AREA))
        processes[0].kill()
        with pytest.raises(StudyError, match=f"{address}: the Dask scheduler is lost"):
            workers.columns(AREA)


def test_a_missing_scheduler_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="Dask is an extra")
    monkeypatch.setattr("agent_economy.study.executors.CONNECT_S", 1)
    address = f"tcp://127.0.0.1:{free_port()}"
    with pytest.raises(InputError, match=f"{address}: no Dask scheduler answers"):
        dask_executor(address)
    with pytest.raises(InputError, match="no Dask scheduler answers"):
        dask_executor("nowhere://")


def test_without_dask_the_error_names_the_extra(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'agent-economy\[dask\]'"):
        dask_executor("tcp://127.0.0.1:8786")


SCRIPT = """
import sys
import agent_economy as ae

plan = ae.study.make_plan(ae.Scenario.load("classic"), delta=0.3)
with plan.engine.in_processes(2) as workers:
    ae.study.run_plan(plan, sys.argv[1], compute=workers.columns)
"""


@pytest.mark.parametrize("is_file", [True, False])
def test_a_script_without_a_guard_is_named_as_the_cause(tmp_path: Path, *, is_file: bool) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    script = str(tmp_path / "script.py") if is_file else "-"
    given = subprocess.run(
        [sys.executable, script, str(tmp_path / "study")],
        input=None if is_file else SCRIPT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert given.returncode == 1
    assert given.stderr.count("Traceback") == 1
    assert given.stderr.splitlines()[-1].endswith(
        "StudyError: the worker processes could not import the script: guard its code with "
        "if __name__ == '__main__':, and run it from a file"
    )

"""Compute a block of runs on several workers; the result does not depend on its division.

A block is divided row by row into chunks of about a second each, by the rate measured so far. Two
chunks per worker are pending, so that no worker waits; the last ones are smaller, so that all
workers finish together. A chunk whose worker dies is given to another.
"""

import time
from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from dataclasses import dataclass, field, replace
from typing import Self, TypeAlias

from agent_economy._core import InputError
from agent_economy.build import own_build
from agent_economy.study.errors import StudyError
from agent_economy.study.run_block import Columns, Compute, Part, Partwise, RunBlock, outcomes

CHUNK_S = 1.0
"""Intended duration of a chunk."""

MIN_CHUNK_S = 0.05
"""Minimum duration of a chunk at the end of a block."""

ATTEMPTS = 3
"""Maximum number of attempts at a chunk."""

BROKEN_S = 30
"""Time limit for a broken executor to report all of its chunks as failed."""

Result: TypeAlias = tuple[Columns, float]
"""Outcomes of a chunk, and its duration in seconds."""


@dataclass(frozen=True, eq=False)
class Chunk:
    """A part of a block that one worker computes.

    Attributes:
        runs: The runs of the part.
        failures: How often it failed or lost its worker, even if another chunk was the cause.
    """

    runs: RunBlock
    failures: int = 0


@dataclass
class Throughput:
    """Rows per second and worker, averaged with more weight on recent chunks.

    Attributes:
        rows: Weighted number of computed rows.
        seconds: Weighted time that they took.
    """

    rows: float = 0.0
    seconds: float = 0.0

    def add(self, rows: int, seconds: float) -> None:
        """Add a chunk; its weight is halved after ten more."""
        self.rows = 0.93 * self.rows + rows
        self.seconds = 0.93 * self.seconds + seconds

    def chunk_rows(self, all_rows: int, unassigned: int, workers: int) -> int:
        """Return the number of rows of the next chunk; one while the rate is unknown."""
        rate = self.rows / self.seconds if self.seconds else 0.0
        rows = min(rate * CHUNK_S, unassigned / (2 * workers))
        max_rows = max(1, all_rows // workers)
        return min(max_rows, max(1, round(rows), round(rate * MIN_CHUNK_S)))


class Workers:
    """Workers that compute blocks of runs, on any `concurrent.futures.Executor`.

    Use it as a context manager, and `columns` as the `compute` of a study.
    """

    def __init__(self, make_executor: Callable[[], Executor], count: int, task: Compute) -> None:
        """Prepare workers; they start with the first block.

        Args:
            make_executor: Called for the first block, and after an executor broke.
            count: Number of chunks that it computes at a time, 1 or more; of an executor with an
                attribute `count`, that is the number.
            task: Computes the outcomes of a block; pickled with every chunk.
        """
        self._make = make_executor
        self._count = count
        self._task = task
        self._executor: Executor | None = None
        self._throughput = Throughput()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Stop the workers immediately; a later block starts new ones."""
        executor, self._executor = self._executor, None
        if executor:
            executor.shutdown(wait=False, cancel_futures=True)

    @property
    def columns(self) -> Partwise:
        """Returns the outcomes of a block, the same as from a single call of the task.

        It raises a StudyError if a chunk failed three times, or the executor is lost; and an
        InputError if the executor cannot be created, or what the task returns is not its columns.
        """
        return Partwise(self._parts)

    def _parts(self, block: RunBlock) -> Generator[Part]:
        job = Job(block)
        try:
            while not job.is_done:
                self._submit(job)
                self._collect(job)
                while job.finished:
                    yield job.finished.popleft()
        except BaseException:
            self.stop()
            raise

    def _submit(self, job: "Job") -> None:
        """Submit chunks until every worker has one more pending."""
        if self._executor is None:
            self._executor = self._make()
        while len(job.pending) < job.max_pending(self._workers):
            chunk = job.next_chunk(self._throughput, self._workers)
            if chunk is None:
                return
            if self._executor is None:
                self._executor = self._make()
            try:
                future = self._executor.submit(run, self._task, chunk.runs, str(own_build()))
            except StudyError:
                raise
            except (BrokenExecutor, RuntimeError, OSError) as error:
                self._check_start(error)
                job.failed(chunk, error)
                self._replace_executor(job)
            else:
                job.pending[future] = chunk

    @property
    def _workers(self) -> int:
        """Number of workers now: those of a cluster come and go."""
        return max(1, getattr(self._executor, "count", self._count))

    def _collect(self, job: "Job") -> None:
        """Wait for at least one chunk and store the results."""
        done, _ = wait(job.pending, return_when=FIRST_COMPLETED)
        are_usable = [self._take(job, future) for future in done]
        if not all(are_usable):
            self._replace_executor(job)

    def _take(self, job: "Job", future: "Future[Result]") -> bool:
        """Store the result of a chunk, or record that it failed.

        Returns:
            Whether the executor is still usable.
        """
        chunk = job.pending.pop(future)
        try:
            columns, seconds = future.result()
            job.put(chunk, columns)
        except (StudyError, InputError):
            raise
        except CancelledError:
            job.retries.append(chunk)  # Not started, or lost with a scheduler that may return.
            return True
        except Exception as error:  # noqa: BLE001  (a task may fail in any way; the last is reported)
            self._check_start(error)
            job.failed(chunk, error)
            return not isinstance(error, BrokenExecutor)
        self._throughput.add(chunk.runs.rows, seconds)
        return True

    def _check_start(self, error: Exception) -> None:
        """Raise the error of an executor that broke because none of its workers has started."""
        start_error = getattr(self._executor, "start_error", None)
        why = start_error() if start_error and isinstance(error, BrokenExecutor) else None
        if why:
            raise why from None

    def _replace_executor(self, job: "Job") -> None:
        """Stop a broken executor, and retry its pending chunks on the next one."""
        self.stop()
        done, lost = wait(job.pending, timeout=BROKEN_S)
        for future in done:
            self._take(job, future)
        for future in lost:
            job.failed(job.pending.pop(future), TimeoutError("lost with its worker"))


@dataclass
class Job:
    """A block that is being computed.

    Attributes:
        block: The requested runs.
        finished: The outcomes of completed chunks that were not passed on yet.
        pending: Submitted chunks.
        retries: Chunks that failed.
        assigned: Number of rows submitted at least once.
        computed: Number of rows computed.
        names: The columns of the first completed chunk.
    """

    block: RunBlock
    finished: deque[Part] = field(default_factory=deque)
    pending: dict["Future[Result]", Chunk] = field(default_factory=dict)
    retries: deque[Chunk] = field(default_factory=deque)
    assigned: int = 0
    computed: int = 0
    names: tuple[str, ...] = ()

    @property
    def is_done(self) -> bool:
        """Whether all is computed."""
        return self.computed == self.block.rows

    def max_pending(self, workers: int) -> int:
        """Return how many chunks may be pending.

        A chunk with one attempt left runs alone, so that it does not fail because another chunk
        killed its worker.
        """
        chunks = [*self.pending.values(), *self.retries]
        return 1 if any(chunk.failures == ATTEMPTS - 1 for chunk in chunks) else 2 * workers

    def next_chunk(self, throughput: Throughput, workers: int) -> Chunk | None:
        """Return the next chunk to submit; None if none is left."""
        if self.retries:
            self.retries = deque(sorted(self.retries, key=lambda chunk: -chunk.failures))
            return self.retries.popleft()
        all_rows = self.block.rows
        if self.assigned == all_rows:
            return None
        rows = throughput.chunk_rows(all_rows, all_rows - self.assigned, workers)
        chunk = next_part(self.block, self.assigned, rows)
        self.assigned += chunk.runs.rows
        return chunk

    def put(self, chunk: Chunk, columns: Columns) -> None:
        """Take the outcomes of a chunk.

        Raises:
            InputError: If they have other columns than the first chunk.
        """
        self.names = self.names or tuple(columns)
        if {*columns} != {*self.names}:
            given, allowed = ", ".join(columns), ", ".join(self.names)
            message = f"compute returned the columns {given} for {chunk.runs}: must be {allowed}"
            raise InputError(message)
        self.finished.append((chunk.runs, columns))
        self.computed += chunk.runs.rows

    def failed(self, chunk: Chunk, error: Exception) -> None:
        """Retry a failed chunk.

        Raises:
            StudyError: If it has no attempt left.
        """
        chunk = replace(chunk, failures=chunk.failures + 1)
        if chunk.failures == ATTEMPTS:
            reason = f"{type(error).__name__}: {error}"
            message = f"{chunk.runs} failed {ATTEMPTS} times, the last time with {reason}"
            raise StudyError(message) from error
        self.retries.append(chunk)


def next_part(block: RunBlock, assigned: int, rows: int) -> Chunk:
    """Return the chunk after the assigned rows: whole configurations, or some runs of one."""
    row, skipped = divmod(assigned, block.runs)
    if skipped or rows < block.runs:
        runs = min(rows, block.runs - skipped)
        configurations = block.configurations[row : row + 1]
        return Chunk(RunBlock(configurations, block.first_run + skipped, runs))
    end = row + rows // block.runs
    configurations = block.configurations[row:end]
    return Chunk(RunBlock(configurations, block.first_run, block.runs))


def run(task: Compute, runs: RunBlock, study_build: str) -> Result:
    """Compute a chunk in a worker.

    Returns:
        Its outcomes, and its duration in seconds.

    Raises:
        RuntimeError: If the worker has another build of this program.
    """
    if (own := str(own_build())) != study_build:
        message = (
            f"a worker has another build of this program ({own}) than the study ({study_build}): "
            "install the same build on both"
        )
        raise RuntimeError(message)
    start = time.perf_counter()
    columns = outcomes(task, runs)
    return columns, time.perf_counter() - start

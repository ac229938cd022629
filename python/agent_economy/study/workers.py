"""Compute a rectangle on several workers; how it was cut shows in no result.

A rectangle is cut row by row into pieces, each as large as the rate so far says a second's work is.
Two pieces a worker are under way, so that none waits; the last ones are smaller, so that all end
together. A piece whose worker dies is given to another.
"""

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.metadata import version
from math import ceil
from typing import Self, TypeAlias

import numpy as np

from agent_economy.study.errors import StudyError
from agent_economy.study.rectangle import Columns, Compute, Rectangle, check_shape

MOST_PIECES = 512
"""Of a rectangle, about: what each costs besides its runs must not matter."""

PIECE_S = 1.0
"""What a piece should take."""

LEAST_PIECE_S = 0.05
"""What a piece should take at least, at the end of a rectangle."""

ATTEMPTS = 3
"""How often a piece may fail."""

BROKEN_S = 30
"""How long a broken executor may take to say so of all that it had."""

Result: TypeAlias = tuple[Columns, float]
"""Outcomes of a piece, and the seconds that they took."""

UNKNOWN_PIECES = 16
"""Pieces a worker while the rate is not known."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A part of a rectangle that one worker computes.

    Attributes:
        area: Which part.
        row: Where its first configuration stands in the rectangle.
        failures: How often it failed, or its worker died, if only by another's fault.
    """

    area: Rectangle
    row: int
    failures: int = 0


@dataclass
class Pace:
    """Rows that a worker computes a second.

    Attributes:
        rows: Computed, the older the fewer.
        seconds: That they took.
    """

    rows: float = 0.0
    seconds: float = 0.0

    def add(self, rows: int, seconds: float) -> None:
        """Learn from a piece; one of a second counts half after ten more of its kind."""
        self.rows = 0.93 * self.rows + rows
        self.seconds = 0.93 * self.seconds + seconds

    def piece_rows(self, all_rows: int, left: int, workers: int) -> int:
        """Return how many rows the next piece has, when some of all are left to give out."""
        fewest = ceil(all_rows / MOST_PIECES)
        if not self.seconds:
            return ceil(all_rows / (UNKNOWN_PIECES * workers))
        rate = self.rows / self.seconds
        rows = min(rate * PIECE_S, left / (2 * workers))
        most = max(1, all_rows // workers)
        return min(most, max(1, fewest, round(rows), round(rate * LEAST_PIECE_S)))


class Workers:
    """Workers that compute rectangles, on any `concurrent.futures.Executor`.

    Use it in a `with`, and `columns` as the `compute` of a store.
    """

    def __init__(self, make_executor: Callable[[], Executor], count: int, task: Compute) -> None:
        """Start none yet.

        Args:
            make_executor: Called for the first rectangle, and after an executor broke.
            count: Pieces that it computes at a time, 1 or more.
            task: Gives the outcomes of a rectangle. Workers get it pickled, with every piece.
        """
        self._make = make_executor
        self._count = count
        self._task = task
        self._executor: Executor | None = None
        self._pace = Pace()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Let the workers go, at once; a later rectangle starts others."""
        executor, self._executor = self._executor, None
        if executor:
            executor.shutdown(wait=False, cancel_futures=True)

    def columns(self, rectangle: Rectangle) -> Columns:
        """Return the outcomes of a rectangle, the same as the task's for all of it at once.

        Raises:
            StudyError: If a piece failed three times, or the executor is lost for good.
            InputError: If the executor cannot be made.
        """
        job = Job(rectangle)
        try:
            while not job.is_done:
                self._give_out(job)
                self._collect(job)
        except BaseException:
            self.stop()
            raise
        return job.columns

    def _give_out(self, job: "Job") -> None:
        """Submit pieces until every worker has its next one too."""
        while len(job.under_way) < job.most_under_way(self._count):
            piece = job.next_piece(self._pace, self._count)
            if piece is None:
                return
            if self._executor is None:
                self._executor = self._make()
            try:
                future = self._executor.submit(run, self._task, piece.area, own_version())
            except StudyError:
                raise
            except (BrokenExecutor, RuntimeError, OSError) as error:
                job.failed(piece, error)
                self._replace_executor(job)
            else:
                job.under_way[future] = piece

    def _collect(self, job: "Job") -> None:
        """Wait for a piece or more and put them in place."""
        done, _ = wait(job.under_way, return_when=FIRST_COMPLETED)
        can_go_on = [self._take(job, future) for future in done]
        if not all(can_go_on):
            self._replace_executor(job)

    def _take(self, job: "Job", future: "Future[Result]") -> bool:
        """Put what a worker computed in place, or note that it failed.

        Returns:
            Whether the executor can go on.
        """
        piece = job.under_way.pop(future)
        try:
            columns, seconds = future.result()
            job.put(piece, columns)
        except StudyError:
            raise
        except CancelledError:
            job.again.append(piece)  # Not begun, or lost with a scheduler that may come back.
            return True
        except Exception as error:  # noqa: BLE001  (a task may fail in any way; the last is told)
            job.failed(piece, error)
            return not isinstance(error, BrokenExecutor)
        self._pace.add(piece.area.rows, seconds)
        return True

    def _replace_executor(self, job: "Job") -> None:
        """Let a broken executor go, and note what it leaves undone to be given to the next."""
        self.stop()
        done, lost = wait(job.under_way, timeout=BROKEN_S)
        for future in done:
            self._take(job, future)
        for future in lost:
            job.failed(job.under_way.pop(future), TimeoutError("lost with its worker"))


@dataclass
class Job:
    """A rectangle that is being computed.

    Attributes:
        rectangle: What is asked for.
        columns: What there is of it.
        under_way: Pieces that workers have.
        again: Pieces that failed.
        given: Rows given out at least once.
        there: Rows computed.
    """

    rectangle: Rectangle
    columns: Columns = field(default_factory=dict)
    under_way: dict["Future[Result]", Piece] = field(default_factory=dict)
    again: deque[Piece] = field(default_factory=deque)
    given: int = 0
    there: int = 0

    @property
    def is_done(self) -> bool:
        """Whether all is computed."""
        return self.there == self.rectangle.rows

    def most_under_way(self, workers: int) -> int:
        """Return how many pieces may be under way.

        A piece that has one attempt left goes alone, so that no other's worker dying is held
        against it.
        """
        pieces = [*self.under_way.values(), *self.again]
        return 1 if any(piece.failures == ATTEMPTS - 1 for piece in pieces) else 2 * workers

    def next_piece(self, pace: Pace, workers: int) -> Piece | None:
        """Return what to give out next, None if nothing is left."""
        if self.again:
            self.again = deque(sorted(self.again, key=lambda piece: -piece.failures))
            return self.again.popleft()
        all_rows = self.rectangle.rows
        if self.given == all_rows:
            return None
        rows = pace.piece_rows(all_rows, all_rows - self.given, workers)
        piece = cut(self.rectangle, self.given, rows)
        self.given += piece.area.rows
        return piece

    def put(self, piece: Piece, columns: Columns) -> None:
        """Put what a worker computed in place.

        Raises:
            ValueError: If it is not of the piece's shape, or has other columns than the first.
        """
        check_shape(piece.area, columns)
        if not self.columns:
            self.columns = {name: np.empty(self.rectangle.shape) for name in columns}
        if not columns or columns.keys() != self.columns.keys():
            message = f"columns {', '.join(columns)} differ from those of other pieces"
            raise ValueError(message)
        configurations, runs = piece.area.shape
        first = piece.area.first_run - self.rectangle.first_run
        for name, values in columns.items():
            rows = slice(piece.row, piece.row + configurations)
            self.columns[name][rows, first : first + runs] = values
        self.there += piece.area.rows

    def failed(self, piece: Piece, error: Exception) -> None:
        """Note a piece to be tried again.

        Raises:
            StudyError: If it was tried often enough.
        """
        piece = replace(piece, failures=piece.failures + 1)
        if piece.failures == ATTEMPTS:
            reason = f"{type(error).__name__}: {error}"
            message = f"{piece.area} failed {ATTEMPTS} times, at last with {reason}"
            raise StudyError(message) from error
        self.again.append(piece)


def cut(rectangle: Rectangle, given: int, rows: int) -> Piece:
    """Return the next piece after some rows: whole configurations, or some runs of one."""
    row, skipped = divmod(given, rectangle.runs)
    if skipped or rows < rectangle.runs:
        runs = min(rows, rectangle.runs - skipped)
        configurations = rectangle.configurations[row : row + 1]
        return Piece(Rectangle(configurations, rectangle.first_run + skipped, runs), row)
    end = row + rows // rectangle.runs
    configurations = rectangle.configurations[row:end]
    return Piece(Rectangle(configurations, rectangle.first_run, rectangle.runs), row)


def run(task: Compute, area: Rectangle, asked_version: str) -> Result:
    """Compute a piece; this is what a worker does.

    Returns:
        Its outcomes, and the seconds that they took.

    Raises:
        RuntimeError: If the worker has another version of this program.
    """
    if own_version() != asked_version:
        message = f"a worker has version {own_version()} of this program, the study {asked_version}"
        raise RuntimeError(message)
    begin = time.perf_counter()
    columns = task(area)
    return columns, time.perf_counter() - begin


@cache
def own_version() -> str:
    """Return the version of this program."""
    return version("agent-economy")

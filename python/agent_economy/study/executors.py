"""Executors for chunks of a study: processes of this machine, or a Dask cluster."""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable
from concurrent.futures import (
    Executor,
    Future,
    InvalidStateError,
    ProcessPoolExecutor,
)
from multiprocessing.synchronize import Semaphore
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from agent_economy.study.dask_connection import Cluster, connected
from agent_economy.study.errors import StudyError

CONNECT_S = 10
"""Time limit for a scheduler to answer."""

CHECK_S = 0.5
"""Interval of checks whether the scheduler is lost, and how many workers there are."""

WITHOUT_WORKERS = (
    "the cluster has no workers: the study waits for one; start one with `dask worker ADDRESS`, or "
    "stop the study with Ctrl-C"
)

UNGUARDED = (
    "the worker processes could not import the script: guard its code with "
    "if __name__ == '__main__':, and run it from a file"
)

P = ParamSpec("P")
T = TypeVar("T")


class LocalExecutor(ProcessPoolExecutor):
    """Processes of this machine.

    They end with the process that started them, however it ends. A script that starts them must
    guard its code with `if __name__ == "__main__":`, because each process imports it.
    """

    def __init__(self, count: int) -> None:
        """Prepare up to `count` processes; they start with the first chunks.

        Raises:
            StudyError: If this program has been read from standard input.
        """
        main = sys.modules["__main__"]
        file = getattr(main, "__file__", None)
        if getattr(main, "__spec__", None) is None and file and not Path(file).exists():
            raise StudyError(UNGUARDED)
        context = multiprocessing.get_context("spawn")
        # Each process releases it once; a process that is killed meanwhile blocks no other.
        self._started, self._has_started = context.Semaphore(0), False
        super().__init__(
            count, mp_context=context, initializer=prepare_worker, initargs=(self._started,)
        )

    def start_error(self) -> StudyError | None:
        """Return why no process has started; None if one has."""
        self._has_started = self._has_started or self._started.acquire(block=False)
        return None if self._has_started else StudyError(UNGUARDED)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002  (as inherited)
        """Stop; without waiting, running chunks are terminated."""
        processes = [] if wait else list((self._processes or {}).values())
        super().shutdown(wait, cancel_futures=cancel_futures)
        for process in processes:
            process.terminate()


def end_unguarded_worker() -> None:
    """End this process, without a message, if it is a worker that imports an unguarded script.

    Raises:
        SystemExit: If it is.
    """
    # The script would start processes again, which Python refuses with pages of tracebacks.
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(1)


def prepare_worker(started: Semaphore) -> None:
    """Prepare a process: it ignores Ctrl-C, which its parent handles, and ends with its parent."""
    started.release()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=end_with_parent, daemon=True).start()


def end_with_parent() -> None:
    """End this process when its parent has ended."""
    parent = multiprocessing.parent_process()
    if parent:
        parent.join()
        os._exit(1)


class DaskExecutor(Executor):
    """A Dask cluster as an executor that raises an error when its scheduler is lost."""

    def __init__(self, cluster: Cluster, on_wait: Callable[[str], None]) -> None:
        """Take over a connection; `on_wait` is called while chunks wait without workers."""
        self._cluster = cluster
        self._on_wait = on_wait
        self._executor = cluster.client.get_executor(pure=False)
        self._waiting: set[Future[Any]] = set()
        self._count = 0
        self._ask()
        self._ended = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    @property
    def count(self) -> int:
        """Number of threads of the cluster's workers, of a moment ago."""
        return self._count

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Submit a call.

        Raises:
            StudyError: If the scheduler is lost.
        """
        if self._cluster.is_lost:
            raise self._lost()
        future: Future[T] = self._executor.submit(fn, *args, **kwargs)
        self._waiting.add(future)
        future.add_done_callback(self._waiting.discard)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002  (as inherited)
        """Disconnect from the cluster, which drops what was submitted; its workers keep running."""
        self._ended.set()
        if wait and not cancel_futures and not self._cluster.is_lost:
            self._executor.shutdown(wait=True)
        self._cluster.close()

    def _watch(self) -> None:
        """Fail all pending calls when the scheduler is lost, as Dask itself does not."""
        is_reported = False
        while not self._ended.wait(CHECK_S):
            if self._cluster.is_lost:
                for future in list(self._waiting):
                    with contextlib.suppress(InvalidStateError):
                        future.set_exception(self._lost())
                continue
            self._ask()
            is_waiting = self._count == 0 and bool(self._waiting)
            if is_waiting and not is_reported:
                self._on_wait(f"{self._cluster.address}: {WITHOUT_WORKERS}")
            is_reported = is_waiting

    def _ask(self) -> None:
        """Ask how many workers there are."""
        with contextlib.suppress(Exception):  # The scheduler is lost, or answers next time.
            self._count = self._cluster.threads()

    def _lost(self) -> StudyError:
        """Return the error for a lost scheduler."""
        address = self._cluster.address
        message = f"{address}: the Dask scheduler is lost: restart it, then resume the study"
        return StudyError(message)


def warn(message: str) -> None:
    """Issue a warning."""
    warnings.warn(message, stacklevel=2)


def dask_executor(address: str, on_wait: Callable[[str], None] = warn) -> DaskExecutor:
    """Return a Dask cluster as an executor.

    Args:
        address: Address of its scheduler, such as tcp://HOST:8786. The same build of this program
            must be installed on its workers.
        on_wait: Called with a sentence, in another thread, when runs wait for the first worker, or
            all are gone; a warning by default.

    Raises:
        InputError: If Dask is not installed, no scheduler answers at the address within
            `CONNECT_S`, or a worker has another build of this program or none.
    """
    return DaskExecutor(connected(address, CONNECT_S), on_wait)

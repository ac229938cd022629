"""Executors for chunks of a study: processes of this machine, or a Dask cluster."""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
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

from agent_economy._core import InputError
from agent_economy.study.errors import StudyError

CONNECT_S = 10
"""Time limit for a scheduler to answer."""

CHECK_S = 0.5
"""Interval of checks whether the scheduler is lost."""

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

    def __init__(self, address: str, client: Any) -> None:
        """Take over a `distributed.Client`."""
        self._address = address
        self._client = client
        self._executor = client.get_executor(pure=False)
        self._waiting: set[Future[Any]] = set()
        self._ended = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    @property
    def count(self) -> int:
        """Current number of threads of the cluster's workers."""
        return sum(self._client.nthreads().values())

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Submit a call.

        Raises:
            StudyError: If the scheduler is lost.
        """
        if self._is_lost:
            raise self._lost()
        future: Future[T] = self._executor.submit(fn, *args, **kwargs)
        self._waiting.add(future)
        future.add_done_callback(self._waiting.discard)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002  (as inherited)
        """Disconnect from the cluster; its workers keep running."""
        self._ended.set()
        if not self._is_lost:
            self._executor.shutdown(wait=wait and not cancel_futures)
        self._client.close()

    @property
    def _is_lost(self) -> bool:
        """Whether the client has lost its scheduler."""
        return self._client.status in {"closing", "closed"}

    def _watch(self) -> None:
        """Fail all pending calls when the scheduler is lost, as Dask itself does not."""
        while not self._ended.wait(CHECK_S):
            if self._is_lost:
                for future in list(self._waiting):
                    with contextlib.suppress(InvalidStateError):
                        future.set_exception(self._lost())

    def _lost(self) -> StudyError:
        """Return the error for a lost scheduler."""
        message = f"{self._address}: the Dask scheduler is lost: restart it, then resume the study"
        return StudyError(message)


def dask_executor(address: str) -> DaskExecutor:
    """Return a Dask cluster as an executor.

    Args:
        address: Address of its scheduler, such as tcp://HOST:8786. The same build of this program
            must be installed on its workers.

    Raises:
        InputError: If Dask is not installed, or no scheduler responds at the address.
    """
    try:
        from distributed import Client  # noqa: PLC0415  (an extra, and slow to load)
    except ImportError:
        message = f"{address}: Dask is not installed: pip install 'agent-economy[dask]'"
        raise InputError(message) from None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        message = f"{address}: no Dask scheduler answers at this address ({error})"
        raise InputError(message) from None
    return DaskExecutor(address, client)

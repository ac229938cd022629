"""Where pieces of a study run: processes of this machine, or a Dask cluster."""

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import (
    Executor,
    Future,
    InvalidStateError,
    ProcessPoolExecutor,
)
from typing import Any, ParamSpec, TypeVar

from agent_economy._core import InputError
from agent_economy.study.errors import StudyError

CONNECT_S = 10
"""How long a scheduler may take to answer, or to come back."""

WATCH_S = 0.5
"""Seconds between two looks at whether a scheduler is lost."""

P = ParamSpec("P")
T = TypeVar("T")


class LocalExecutor(ProcessPoolExecutor):
    """Processes of this machine.

    They end with the process that started them, however that ends. A script that starts them keeps
    what it does under `if __name__ == "__main__":`, since each imports it.
    """

    def __init__(self, count: int) -> None:
        """Start processes as pieces come, up to a count."""
        context = multiprocessing.get_context("spawn")
        super().__init__(count, mp_context=context, initializer=begin_worker)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002  (as inherited)
        """End; without waiting, what runs is ended at once."""
        processes = [] if wait else list((self._processes or {}).values())
        super().shutdown(wait, cancel_futures=cancel_futures)
        for process in processes:
            process.terminate()


def begin_worker() -> None:
    """Prepare a process: Ctrl-C is its parent's to handle, and without a parent it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=end_with_parent, daemon=True).start()


def end_with_parent() -> None:
    """End this process when the one that started it has ended."""
    parent = multiprocessing.parent_process()
    if parent:
        parent.join()
        os._exit(1)


class DaskExecutor(Executor):
    """A Dask cluster, as an executor that says so when its scheduler is lost."""

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
        """Threads that the cluster's workers have now."""
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
        """Let the cluster go; its workers stay."""
        self._ended.set()
        if not self._is_lost:
            self._executor.shutdown(wait=wait and not cancel_futures)
        self._client.close()

    @property
    def _is_lost(self) -> bool:
        """Whether the client has given up its scheduler."""
        return self._client.status in {"closing", "closed"}

    def _watch(self) -> None:
        """Say of every call that it is lost when the scheduler is.

        Dask would say nothing, and whoever waits would wait for ever.
        """
        while not self._ended.wait(WATCH_S):
            if self._is_lost:
                for future in list(self._waiting):
                    with contextlib.suppress(InvalidStateError):
                        future.set_exception(self._lost())

    def _lost(self) -> StudyError:
        """Return what to say."""
        message = f"{self._address}: the Dask scheduler is lost: start it, then ask again to go on"
        return StudyError(message)


def dask_executor(address: str) -> DaskExecutor:
    """Return a Dask cluster as an executor.

    Args:
        address: Of its scheduler, as tcp://HOST:8786. Its workers need this version of this
            program installed.

    Raises:
        InputError: If Dask is not installed, or nothing answers at the address.
    """
    try:
        from distributed import Client  # noqa: PLC0415  (an extra, and slow to load)
    except ImportError:
        message = f"{address}: needs Dask: pip install 'agent-economy[dask]'"
        raise InputError(message) from None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        message = f"{address}: no Dask scheduler answers there ({error})"
        raise InputError(message) from None
    return DaskExecutor(address, client)

"""A Dask cluster on this machine, reachable on loopback only."""

import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path

from agent_economy.study.executors import dask_executor

HANG_S = 120
"""A cluster that has not started by then never will."""


def free_port() -> int:
    """Return a free port of loopback."""
    with closing(socket.socket()) as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


def started(stack: ExitStack, *arguments: str) -> subprocess.Popen[bytes]:
    """Start a process of a Dask cluster, which ends with the stack."""
    folders = [str(Path(__file__).parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folders)}
    process = subprocess.Popen(
        [sys.executable, "-m", *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    stack.callback(process.wait)
    stack.callback(process.kill)
    return process


def is_listening(port: int) -> bool:
    """Return whether a process listens on a port of loopback."""
    with closing(socket.socket()) as client:
        return client.connect_ex(("127.0.0.1", port)) == 0


def wait_until(is_so: Callable[[], bool]) -> None:
    """Wait for a state; a busy machine takes long to start Python processes."""
    begin = time.monotonic()
    while not is_so():
        assert time.monotonic() - begin < HANG_S
        time.sleep(0.05)


Cluster = tuple[str, list[subprocess.Popen[bytes]]]


@contextmanager
def running() -> Iterator[Cluster]:
    """Start a Dask scheduler and two workers; return its address and the three processes."""
    with ExitStack() as stack:
        port = free_port()
        address = f"tcp://127.0.0.1:{port}"
        scheduler = ("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(port))
        processes = [started(stack, *scheduler, "--no-dashboard", "--no-show")]
        worker = ("distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny")
        processes += [started(stack, *worker, "--no-dashboard") for _ in range(2)]
        wait_until(lambda: is_listening(port))
        executor = dask_executor(address)
        wait_until(lambda: executor.count == len(("one", "other")))
        executor.shutdown()
        yield address, processes

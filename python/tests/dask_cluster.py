"""A Dask cluster on this machine, reachable on loopback only."""

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path

from agent_economy.study.executors import dask_executor


def free_port() -> int:
    """Return a free port of loopback."""
    with closing(socket.socket()) as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


def started(stack: ExitStack, *arguments: str) -> subprocess.Popen[bytes]:
    """Start a process of a Dask cluster, which ends with the stack."""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    process = subprocess.Popen(
        [sys.executable, "-m", *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    stack.callback(process.wait)
    stack.callback(process.kill)
    return process


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
        executor = dask_executor(address)
        begin = time.monotonic()
        while executor.count < 2:
            assert time.monotonic() - begin < 30
            time.sleep(0.05)
        executor.shutdown()
        yield address, processes

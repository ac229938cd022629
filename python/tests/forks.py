"""Processes that tests start and kill by the hundred; a server process preloads their modules."""

import multiprocessing
import os
from collections.abc import Callable
from multiprocessing import forkserver
from multiprocessing.process import BaseProcess
from pathlib import Path
from unittest import mock

FORKS = multiprocessing.get_context("forkserver")
# Each process imports the main module, which is pytest; the server has already done so.
FORKS.set_forkserver_preload(["synthetic_runs", "pytest", "scipy.special", "small_study"])


def started(work: Callable[..., None], *args: object) -> BaseProcess:
    """Start a function in a new process."""
    # The server does not inherit sys.path, and silently skips modules that it cannot import.
    with mock.patch.dict(os.environ, {"PYTHONPATH": str(Path(__file__).parent)}):
        forkserver.ensure_running()
    process = FORKS.Process(target=work, args=args)
    process.start()
    return process

"""Processes that tests start and kill by the hundred, from one that has loaded all they need."""

import multiprocessing
import os
from collections.abc import Callable
from multiprocessing import forkserver
from multiprocessing.process import BaseProcess
from pathlib import Path
from unittest import mock

FORKS = multiprocessing.get_context("forkserver")
# Each process loads the main module, which is pytest's, again; here it is loaded already.
FORKS.set_forkserver_preload(["synthetic_runs", "pytest", "scipy.special", "small_study"])


def started(work: Callable[..., None], *args: object) -> BaseProcess:
    """Start work in a process of its own."""
    # The server does not take over sys.path, and passes in silence over what it cannot load.
    with mock.patch.dict(os.environ, {"PYTHONPATH": str(Path(__file__).parent)}):
        forkserver.ensure_running()
    process = FORKS.Process(target=work, args=args)
    process.start()
    return process

"""The priority of what is measured, over the starts of other drives and other work."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

STARTING, MEASURED = -8, -15
"""Nice values of a drive while it starts, and while it is measured."""


def raise_priority(process: int, nice: int = MEASURED) -> None:
    """Raise the priority of a process; only root may.

    All of its threads: one that holds the interpreter's lock would delay the others.
    """
    with suppress(PermissionError, ProcessLookupError, FileNotFoundError):
        for thread in Path(f"/proc/{process}/task").iterdir():
            os.setpriority(os.PRIO_PROCESS, int(thread.name), nice)


@contextmanager
def raised_priority() -> Iterator[None]:
    """Raise the priority of the calling thread for a time; threads that it starts keep it."""
    before = os.getpriority(os.PRIO_PROCESS, 0)
    with suppress(PermissionError):
        os.setpriority(os.PRIO_PROCESS, 0, MEASURED)
    try:
        yield
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, before)

"""The priority of what is measured, over the starts of other drives and other work."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress

STARTING, MEASURED = -8, -15
"""Nice values of a drive while it starts, and while it is measured."""


def raise_priority(thread: int = 0, nice: int = MEASURED) -> None:
    """Raise the priority of a thread, by default the calling one; only root may."""
    with suppress(PermissionError, ProcessLookupError):
        os.setpriority(os.PRIO_PROCESS, thread, nice)


@contextmanager
def raised_priority() -> Iterator[None]:
    """Raise the priority of the calling thread for a time; threads that it starts keep it."""
    before = os.getpriority(os.PRIO_PROCESS, 0)
    raise_priority()
    try:
        yield
    finally:
        os.setpriority(os.PRIO_PROCESS, 0, before)

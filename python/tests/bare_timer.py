"""Measures how late the machine is, and repeats tests that it was too late for."""

import functools
import threading
import time
from collections.abc import Callable
from subprocess import TimeoutExpired
from typing import ParamSpec, TypeVar

from agent_economy.live.clock import now_s

TIMER_S = 0.01
MAX_LATE_S = 0.1
ATTEMPTS = 3

P = ParamSpec("P")
T = TypeVar("T")


class BareTimer:
    """A thread that only sleeps, and notes how late it wakes."""

    def __init__(self) -> None:
        """Start it."""
        self._late: list[tuple[float, float]] = []
        self._closed = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not self._closed.is_set():
            due_s = now_s() + TIMER_S
            time.sleep(TIMER_S)
            self._late.append((due_s, now_s() - due_s))

    def late_s(self, begin_s: float, end_s: float) -> float:
        """Return the maximum lateness in a time."""
        times = [late_s for due_s, late_s in self._late if begin_s - TIMER_S <= due_s <= end_s]
        return max(times, default=0.0)

    def close(self) -> None:
        """End the thread."""
        self._closed.set()


def repeated_if_late(trial: Callable[P, T]) -> Callable[P, T]:
    """Repeat a trial that fails while the machine is late by more than 0.1 s, twice at most.

    The safety rules then stop the robots, as they have to, and hide what the trial is about.
    """

    def run(*arguments: P.args, **options: P.kwargs) -> T:
        for attempt in range(1, ATTEMPTS + 1):
            timer, began_s = BareTimer(), now_s()
            try:
                return trial(*arguments, **options)
            except (AssertionError, TimeoutExpired):
                if attempt == ATTEMPTS or timer.late_s(began_s, now_s()) <= MAX_LATE_S:
                    raise
            finally:
                timer.close()
        raise AssertionError

    functools.update_wrapper(run, trial)
    return run

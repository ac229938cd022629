"""A signal that comes while something runs, as Ctrl-C does."""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class AlarmError(Exception):
    """What the signal raises."""


@contextmanager
def ringing(after_s: float) -> Iterator[None]:
    """Let a signal come after so long, and see that what runs ends within a second of it."""

    def ring(_number: int, _frame: FrameType | None) -> None:
        raise AlarmError

    before = signal.signal(signal.SIGALRM, ring)
    begin = time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, after_s)
        yield
        message = "it ended before the signal came"
        raise AssertionError(message)
    except AlarmError:
        # The promise is one second; the bound allows for a busy machine.
        assert time.monotonic() - begin < after_s + 3
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)

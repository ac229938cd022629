"""A signal that arrives during a call, as Ctrl-C does."""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class AlarmError(Exception):
    """Raised by the signal."""


@contextmanager
def ringing(after_s: float) -> Iterator[None]:
    """Send a signal after `after_s`, and check that the code ends within a second of it."""

    def ring(_number: int, _frame: FrameType | None) -> None:
        raise AlarmError

    before = signal.signal(signal.SIGALRM, ring)
    begin = time.monotonic()
    try:
        signal.setitimer(signal.ITIMER_REAL, after_s)
        yield
        message = "the code ended before the signal arrived"
        raise AssertionError(message)
    except AlarmError:
        # The documented limit is one second; this one allows for a busy machine.
        assert time.monotonic() - begin < after_s + 3
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)

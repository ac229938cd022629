"""The clock of the warden, the loop and the emulator."""

import time

_CLOCK = getattr(time, "CLOCK_BOOTTIME", None)


def now_s() -> float:
    """Return the time since the machine was started, in seconds.

    Where there is one, it is the clock that also counts while the machine sleeps: on Linux, the
    monotonic clock is stopped, and every line would look fresh after a sleep.
    """
    return time.monotonic() if _CLOCK is None else time.clock_gettime(_CLOCK)

"""The progress of runs: redrawn in place on a terminal, else plain lines."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

from rich.console import Console
from rich.live import Live
from rich.text import Text

REDRAW_S = 1 / 8

PAUSE_S = 2.0
"""Time between plain lines, if there is nothing special to print."""

ESTIMATE_AFTER_S = 1.0
"""The remaining time is estimated after this time."""


@contextmanager
def progress_bar(total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """Print progress on standard error, unless the work ends soon.

    Args:
        total: The amount of work.
        unit: Its unit, such as "runs".

    Returns:
        A function that takes the amount done; it may be called at any rate.
    """
    console = Console(stderr=True)
    live = Live(console=console, transient=True, auto_refresh=False)
    begin = time.monotonic()
    printed_at = begin

    def report(done: float) -> None:
        nonlocal printed_at
        now = time.monotonic()
        if now - printed_at < (REDRAW_S if console.is_terminal else PAUSE_S):
            return
        printed_at = now
        text = f"{done:,.0f} of {total:,.0f} {unit}{time_left(done / total, now - begin)}"
        if console.is_terminal:
            live.update(Text(text), refresh=True)
        else:
            console.print(text, highlight=False, soft_wrap=True, markup=False, emoji=False)

    with live if console.is_terminal else nullcontext():
        yield report


def time_left(share: float, seconds: float) -> str:
    """Return the estimated time left, as the end of a line."""
    if seconds < ESTIMATE_AFTER_S or not 0 < share < 1:
        return ""
    return f", about {duration(seconds * (1 - share) / share)} left"


def duration(seconds: float) -> str:
    """Return a duration in a readable unit."""
    return " ".join(in_unit(seconds))


def durations(low_s: float, high_s: float) -> str:
    """Return a range of durations, such as "2 to 6 min"; one if both ends are the same."""
    low, high = in_unit(low_s), in_unit(high_s)
    if low == high:
        return " ".join(high)
    return f"{low[0] if low[1] == high[1] else ' '.join(low)} to {' '.join(high)}"


def in_unit(seconds: float) -> tuple[str, str]:
    """Return a duration as a number and a readable unit."""
    for unit, length in (("h", 3600), ("min", 60)):
        if seconds >= 2 * length:
            return f"{seconds / length:.0f}", unit
    return f"{seconds:.0f}", "s"

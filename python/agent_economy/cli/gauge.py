"""How far runs are, told to people: in place on a terminal, else plain lines."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

from rich.console import Console
from rich.live import Live
from rich.text import Text

from agent_economy.cli.progress import PAUSE_S, duration

REDRAW_S = 1 / 8

FORETELL_S = 1.0
"""What lies this long behind says how long the rest takes."""


@contextmanager
def gauge(total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """Tell on standard error how far something is, unless it is done soon.

    Args:
        total: How much there is.
        unit: What is counted, such as "runs".

    Returns:
        What is to be told how much is done; it may be told as often as one likes.
    """
    console = Console(stderr=True)
    live = Live(console=console, transient=True, auto_refresh=False)
    begin = time.monotonic()
    told_at = begin

    def tell(done: float) -> None:
        nonlocal told_at
        now = time.monotonic()
        if now - told_at < (REDRAW_S if console.is_terminal else PAUSE_S):
            return
        told_at = now
        words = f"{done:,.0f} of {total:,.0f} {unit}{time_left(done / total, now - begin)}"
        if console.is_terminal:
            live.update(Text(words), refresh=True)
        else:
            console.print(words, highlight=False, soft_wrap=True, markup=False, emoji=False)

    with live if console.is_terminal else nullcontext():
        yield tell


def time_left(share: float, seconds: float) -> str:
    """Return about how long it takes yet."""
    if seconds < FORETELL_S or not 0 < share < 1:
        return ""
    return f", about {duration(seconds * (1 - share) / share)} left"

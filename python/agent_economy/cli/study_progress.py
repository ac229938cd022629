"""The progress of a study: a live table on a terminal, else plain lines."""

import math
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from rich import box
from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from agent_economy.cli.run_progress import PAUSE_S, durations
from agent_economy.shares import percent
from agent_economy.study.progress import Leader, OnProgress, Progress, Range
from agent_economy.study.selection import Elimination

ESTIMATE_PERIOD_S = 1.0
"""Time between estimates of the time left."""

MAX_NAMED = 3
"""Maximum number of eliminated configurations that a line names."""


class ProgressDisplay:
    """Prints progress on standard error."""

    def __init__(self, names: Sequence[str]) -> None:
        """Start; `names` are the labels of the configurations."""
        self.names = names
        self._left: Range | None = None
        self._estimated_at = -math.inf

    @contextmanager
    def shown(self) -> Iterator[OnProgress]:
        """Show progress while a study runs."""
        console = Console(stderr=True)
        show = self._table if console.is_terminal else self._lines
        with show(console) as on_progress:
            yield on_progress

    @contextmanager
    def _table(self, console: Console) -> Iterator[OnProgress]:
        """Show the leading configurations, redrawn in place."""
        with Live(console=console, transient=True, refresh_per_second=8) as live:

            def redraw(progress: Progress) -> None:
                if time.monotonic() - redraw_at[0] > 1 / 8:
                    live.update(Group(self._header(progress), self._leaders(progress)))
                    redraw_at[0] = time.monotonic()

            redraw_at = [0.0]
            yield redraw

    @contextmanager
    def _lines(self, console: Console) -> Iterator[OnProgress]:
        """Print a line at each elimination, and every few seconds."""
        printed_at = [0.0]

        def line(progress: Progress) -> None:
            if (
                progress.eliminated
                or progress.is_over
                or time.monotonic() - printed_at[0] > PAUSE_S
            ):
                printed_at[0] = time.monotonic()
                text = self._header(progress).plain + self._eliminated(progress)
                console.print(text, highlight=False, soft_wrap=True, markup=False, emoji=False)

        yield line

    def _header(self, progress: Progress) -> Text:
        rate = progress.computed / progress.seconds if progress.seconds > 0 else 0.0
        text = (
            f"round {progress.round}: {progress.runs:,} runs, {progress.survivors} of "
            f"{len(self.names)} remaining" + (f", {rate:,.0f} runs/s" if rate else "")
        )
        return Text(text + self._time_left(progress))

    def _time_left(self, progress: Progress) -> str:
        """Return the range of the time left, updated each second: the estimate takes a moment."""
        if progress.is_over:
            return ", 0 s left"
        if time.monotonic() - self._estimated_at > ESTIMATE_PERIOD_S:
            self._estimated_at = time.monotonic()
            self._left = progress.estimate_remaining()
        left_s = progress.time_left_s(self._left)
        return "" if left_s is None else f", about {durations(*left_s)} left"

    def _leaders(self, progress: Progress) -> Table:
        table = Table("leading", box=box.SIMPLE_HEAD)
        for head in ("runs", "current merit" if progress.certified is None else "share"):
            table.add_column(head, justify="right")
        if progress.certified is not None:
            table.add_column("status")
        for leader in progress.leaders:
            name = Text(self.names[leader.configuration])
            table.add_row(name, f"{leader.runs:,}", *known_of(leader))
        return table

    def _by(self, elimination: Elimination) -> str:
        """Return which configuration eliminated one, if one did."""
        by = elimination.by
        return "" if by is None else f"by {self.names[by]}, "

    def _eliminated(self, progress: Progress) -> str:
        """Return the configurations eliminated in a round."""
        words = [
            f"{self.names[each.configuration]} ({self._by(each)}{each.runs:,} runs)"
            for each in progress.eliminated[:MAX_NAMED]
        ]
        more = len(progress.eliminated) - MAX_NAMED
        if more > 0:
            words.append(f"{more} more")
        return f"; eliminated: {', '.join(words)}" if words else ""


def known_of(leader: Leader) -> tuple[str, ...]:
    """Return the cells of what is known of a leading configuration."""
    if leader.status is None:
        return (f"{leader.merit:.3f}",)
    return percent(leader.merit), leader.status

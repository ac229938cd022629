"""The results of the campaign: trials, and the row of the table that they give."""

import os
import statistics
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from bare_timer import BareTimer
from campaign_table import State
from priority import raised_priority

from agent_economy.live.clock import now_s

MAX_LATE_S = 0.05
"""A delay in whose time the timer was late by more than this measures the machine."""

MAX_LATE_TRIAL_S = 0.15
"""So does a trial in whose time it was late by more than this: the rules then stop robots."""

COLUMNS = (
    "fault",
    "port",
    "robots",
    "state",
    "has to happen",
    "trials",
    "left out",
    "median, ms",
    "maximum, ms",
    "limit, ms",
    "timer, ms",
    "load",
    "verdict",
)


GROUPED = (*COLUMNS[:2], "states", *COLUMNS[4:])
"""The columns of the short table."""


class Machine:
    """Measures the machine: the lateness of a bare timer, and the share of its cores in use."""

    def __init__(self) -> None:
        """Start to measure."""
        self._busy = [busy_ticks()]
        with raised_priority():
            self.timer = BareTimer()
        threading.Thread(target=self._run, daemon=True).start()

    def load(self, begin_s: float, end_s: float) -> float:
        """Return the busy share of all cores in a time, or in the two seconds before its end."""
        begin_s = min(begin_s, end_s - 2.0)
        before = [each for each in self._busy if each[0] <= begin_s][-1:] or self._busy[:1]
        after = [each for each in self._busy if each[0] >= end_s][:1] or self._busy[-1:]
        (_, busy, total), (_, busy_after, total_after) = before[0], after[0]
        return (busy_after - busy) / max(total_after - total, 1.0)

    def _run(self) -> None:
        while True:
            time.sleep(0.5)
            self._busy.append(busy_ticks())


def busy_ticks() -> tuple[float, float, float]:
    """Return the time, and the ticks of all cores: those that were busy, and all."""
    times = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:]
    ticks = [float(each) for each in times]
    return now_s(), sum(ticks) - sum(ticks[3:5]), sum(ticks)


@dataclass(frozen=True)
class Key:
    """What a row of the table is about.

    Attributes:
        fault: The fault.
        port: The port that has it; empty for those of processes, and for requests.
        robots: The number of robots of the drive.
        state: What they did.
    """

    fault: str
    port: str
    robots: int
    state: str

    def __str__(self) -> str:
        """Return it in words."""
        robots = f"{self.robots} robot{'s' if self.robots > 1 else ''}"
        return f"{f'{self.port} {self.fault}'.strip()}, {robots}, {self.state}"


@dataclass(frozen=True)
class Trial:
    """One trial of a row.

    Attributes:
        begin_s: When the delay begins.
        delay_s: The delay; None if there is none to measure.
        problems: What happened that must not, in words.
        end_s: When the trial ended: problems until then may be those of a late machine.
        behind_s: By how much the emulator was late in the trial.
        note: Details, for a delay that is too long.
    """

    begin_s: float
    delay_s: float | None
    problems: tuple[str, ...]
    end_s: float
    behind_s: float = 0.0
    note: str = ""


@dataclass
class Row:
    """The trials of one row.

    Attributes:
        key: What it is about.
        expected: What has to happen.
        limit_s: The longest delay; None if there is none to measure.
    """

    key: Key
    expected: str
    limit_s: float | None
    count: int = 0
    left_out: int = 0
    delays_s: list[float] = field(default_factory=list)
    late_s: list[float] = field(default_factory=list)
    loads: list[float] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    is_too_late: bool = False

    def add(self, trial: Trial, machine: Machine) -> None:
        """Add a trial, or leave it out because the machine was late."""
        end_s = trial.begin_s + max(trial.delay_s or 0.0, 0.0)
        late_s = machine.timer.late_s(trial.begin_s, end_s)
        late_trial_s = machine.timer.late_s(trial.begin_s, trial.end_s)
        beyond_s = (trial.delay_s or 0.0) - (self.limit_s or 0.0)
        is_late = late_s > MAX_LATE_S and self.limit_s is not None and self.limit_s < 1.0
        is_doubtful = late_trial_s > MAX_LATE_TRIAL_S or trial.behind_s > 0.0
        if beyond_s > late_s:
            sys.stderr.write(f"{self.key}: {1000 * (trial.delay_s or 0.0):.0f} ms{trial.note}\n")
        if is_late or (is_doubtful and (trial.problems or beyond_s > late_s)):
            self.left_out += 1
            return
        # What the timer was late by is not the drive's.
        self.is_too_late |= beyond_s > late_s
        self.count += 1
        self.late_s.append(late_s)
        self.loads.append(machine.load(trial.begin_s, trial.end_s))
        self.problems += trial.problems
        if trial.delay_s is not None:
            self.delays_s.append(trial.delay_s)

    @property
    def verdict(self) -> str:
        """What the trials show: `ok`, `too late`, `wrong` or `no result`."""
        if self.problems:
            return "wrong"
        if self.count == 0:
            return "no result"
        return "too late" if self.is_too_late else "ok"

    def __str__(self) -> str:
        """Return the row of the table, with times in milliseconds."""
        key = self.key
        names = (key.fault, key.port, key.robots, key.state, self.expected)
        return line((*names, self.count, self.left_out, *self.figures(), self.verdict))

    def figures(self) -> tuple[str, ...]:
        """Return median, maximum, limit and timer in milliseconds, and the load."""
        median = statistics.median(self.delays_s) if self.delays_s else None
        longest = max(self.delays_s) if self.delays_s else None
        numbers = (median, longest, self.limit_s, max(self.late_s, default=None))
        load = f"{statistics.median(self.loads):.0%}" if self.loads else ""
        return (*("" if number is None else f"{1000 * number:.0f}" for number in numbers), load)


def line(cells: Iterable[object]) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(map(str, cells))} |"


def head(columns: Sequence[str]) -> str:
    """Return the head of a table."""
    return f"{line(columns)}\n|{'---|' * len(columns)}"


def counted(rows: Sequence[Row]) -> str:
    """Return a sentence about all rows."""
    failed = sum(row.verdict != "ok" for row in rows)
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg())
    return f"{len(rows)} rows, {failed} failed; load average {load}"


def grouped(rows: Iterable[Row]) -> str:
    """Return a short table: faults of a port after which the same has to happen are one row."""
    groups: dict[tuple[str, str, float], list[Row]] = defaultdict(list)
    for row in rows:
        groups[row.key.port, row.expected, row.limit_s or 0.0].append(row)
    return "\n".join([head(GROUPED), *(_group(groups[each]) for each in sorted(groups))])


def _group(rows: Sequence[Row]) -> str:
    key, expected = rows[0].key, rows[0].expected
    merged = Row(key, expected, rows[0].limit_s)
    for row in rows:
        merged.delays_s += row.delays_s
        merged.late_s += row.late_s
        merged.loads += row.loads
    names = (
        ", ".join(sorted({row.key.fault for row in rows})),
        key.port,
        ", ".join(each for each in State if each in {row.key.state for row in rows}),
        expected,
    )
    counts = (sum(row.count for row in rows), sum(row.left_out for row in rows))
    verdicts = ", ".join(sorted({row.verdict for row in rows}))
    return line((*names, *counts, *merged.figures(), verdicts))

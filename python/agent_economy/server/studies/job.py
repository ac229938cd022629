"""A study that runs in a process of its own, which reports its progress and can be stopped.

The process has a low priority, and ends with the server. It is stopped by an interrupt, like
Ctrl-C: the store keeps all runs.
"""

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.study import Plan, Progress
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.errors import StudyError
from agent_economy.study.progress import NOTHING, Leader, LeaderInterval, Range
from agent_economy.study.store.folder import QUESTION

NICENESS = 10
"""Added to the niceness of the process: runs that a page follows have priority."""

REPORT_S = 0.25
"""Minimum time between two reports."""

ESTIMATE_S = 1.0
ESTIMATE_SHARE = 0.05
"""Minimum time between two estimates of intervals and remaining runs; their share of all time."""

POLL_S = 0.02
"""Time between two checks for the folder of a new study."""

KILL_AFTER_S = 10.0
"""A process that does not end within this time after an interrupt is killed."""

COUNTS = {
    "rounds": "round",
    "runs": "runs",
    "computed": "computed",
    "seconds": "seconds",
    "remaining": "survivors",
}
"""Entries of the progress that are reported unchanged, by their names in messages."""

NO_PROGRESS: dict[str, Any] = {
    "rounds": 0,
    "runs": 0,
    "computed": 0,
    "seconds": 0.0,
    "remaining": 0,
    "remaining_s": None,
    "standings": [],
    "eliminated": [],
    "certified": None,
}
"""The progress of a study that has just begun."""


class StudyJob:
    """A running study.

    Attributes:
        plan: The plan of the study.
        progress: The progress, as `ProgressReporter` reports it.
        message: Why it failed; None if it was completed or stopped.
    """

    def __init__(self, plan: Plan, folder: Path) -> None:
        """Start the process."""
        self.plan, self._folder = plan, folder
        self.progress = {**NO_PROGRESS, "remaining": len(plan.configurations)}
        self.message: str | None = None
        self._is_stopped = False
        self._has_reported = threading.Event()
        self._ended = threading.Event()
        context = multiprocessing.get_context("spawn")
        self._line, line = context.Pipe(duplex=False)
        self._process = context.Process(target=run, args=(plan, folder, line), daemon=True)
        self._process.start()
        line.close()
        threading.Thread(target=self._listen, daemon=True).start()

    @property
    def is_alive(self) -> bool:
        """Whether it is running."""
        return not self._ended.is_set()

    def wait_until_begun(self) -> None:
        """Wait until its folder exists, or it has ended."""
        while not ((self._folder / QUESTION).exists() or self._ended.wait(POLL_S)):
            pass

    def stop(self) -> None:
        """Interrupt it, and wait until it has ended."""
        self._is_stopped = True
        # Before the first report, Python is starting: an interrupt would be lost or printed.
        self._has_reported.wait(KILL_AFTER_S)
        if self.is_alive and self._process.pid is not None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._process.pid, signal.SIGINT)
        if not self._ended.wait(KILL_AFTER_S):
            self._process.kill()
            self._ended.wait()

    def _listen(self) -> None:
        with contextlib.suppress(EOFError, OSError), self._line:
            while True:
                self._receive(self._line.recv())
        self._has_reported.set()
        self._process.join()
        if self.message is None and not self._is_stopped:
            self.message = failure(self._process.exitcode or 0)
        self._ended.set()

    def _receive(self, report: dict[str, Any]) -> None:
        self._has_reported.set()
        self.message = report.pop("message", None)
        eliminated = self.progress["eliminated"] + report.pop("eliminated", [])
        self.progress = {**self.progress, **report, "eliminated": eliminated}


def failure(code: int) -> str | None:
    """Return why a process failed; None if it did not."""
    if code == 0:
        return None
    how = f"was killed by signal {-code}" if code < 0 else f"ended with code {code}"
    return f"The process of this study {how}. Its stored runs are kept: resume it."


def run(plan: Plan, folder: Path, line: Connection) -> None:
    """Run or resume a study; the main function of the process."""
    with contextlib.suppress(KeyboardInterrupt, ConnectionError):
        os.nice(NICENESS)
        threading.Thread(target=end_with_server, daemon=True).start()
        # SIGINT is ignored if a shell has started the server in the background.
        signal.signal(signal.SIGINT, interrupted)
        line.send({})
        try:
            study.run_plan(plan, folder, on_progress=ProgressReporter(line))
        except (StudyError, InputError) as error:
            line.send({"message": str(error)})


def interrupted(*_: object) -> None:
    """Interrupt this process once: Ctrl-C in a terminal reaches it, and then the server's signal.

    Raises:
        KeyboardInterrupt: Always.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt


def end_with_server() -> None:
    """Interrupt this process when the one that started it has ended."""
    server = multiprocessing.parent_process()
    if server:
        server.join()
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(KILL_AFTER_S)
        os._exit(1)


class ProgressReporter:
    """Reports the progress of a study to the server, at most once every `REPORT_S`."""

    def __init__(self, line: Connection) -> None:
        """Begin with nothing reported."""
        self._line = line
        self._new: list[list[int | None]] = []
        self._eliminated: set[int] = set()
        self._estimates: tuple[tuple[LeaderInterval, ...], Range | None] = ((), None)
        self._report_at_s = self._estimate_at_s = 0.0

    def __call__(self, now: Progress) -> None:
        """Report the progress if it is due."""
        self._new += [[each.configuration, each.by, each.runs] for each in now.eliminated]
        self._eliminated |= {each.configuration for each in now.eliminated}
        now_s = time.monotonic()
        if now_s < self._report_at_s and not now.is_over:
            return
        if now_s >= self._estimate_at_s:
            self._estimates = now.intervals(), now.estimate_remaining()
            took_s = time.monotonic() - now_s
            self._estimate_at_s = now_s + max(ESTIMATE_S, took_s / ESTIMATE_SHARE)
        self._line.send(self._message(now))
        self._new = []
        self._report_at_s = time.monotonic() + REPORT_S

    def _message(self, now: Progress) -> dict[str, Any]:
        shown, remaining_runs = self._estimates
        return {
            **{name: getattr(now, source) for name, source in COUNTS.items()},
            "remaining_s": now.time_left_s(NOTHING if now.is_over else remaining_runs),
            "standings": [row for each in shown if (row := self._standing(now, *each))],
            "eliminated": self._new,
            "certified": None if now.certified is None else len(now.certified),
        }

    def _standing(self, now: Progress, leader: Leader, merit: Interval) -> list[Any] | None:
        """Return a row of the standings; None if it was eliminated since the estimate."""
        status = leader.status
        if leader.configuration in self._eliminated:
            if status is None:
                return None
            status = "may meet" if leader.configuration in now.may_meet else "refuted"
        elif leader.configuration in (now.certified or ()):
            status = "certified"
        return [leader.configuration, leader.runs, leader.merit, merit.low, merit.high, status]

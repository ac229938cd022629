"""A study at work in a process of its own, which its server hears and can stop.

The process is gentle to others, and ends with the server. To stop it is to interrupt it as Ctrl-C
does: the store keeps what it has.
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
from agent_economy.study.errors import StudyError
from agent_economy.study.store.folder import QUESTION

GENTLE = 10
"""What `nice` adds: runs that somebody watches go first."""

TELL_S = 0.25
"""Between two tellings, at least."""

RANGES_S = 1.0
RANGES_SHARE = 0.05
"""Between two estimates of ranges and of what is left, at least; and the time share they take."""

LOOK_S = 0.02
"""Between two looks for a folder that is being made."""

STOP_S = 10.0
"""A process that was interrupted has so long until it is killed."""

COUNTS = ("round", "runs", "computed", "seconds", "survivors")
"""What is told of a study's progress as it is."""

NOTHING: dict[str, Any] = {
    "round": 0,
    "runs": 0,
    "computed": 0,
    "seconds": 0.0,
    "survivors": 0,
    "left_runs": None,
    "standings": [],
    "eliminated": [],
}
"""What is known of a study that has only begun."""


class StudyJob:
    """A study at work.

    Attributes:
        plan: What is asked.
        said: How far it is, as `ProgressReporter` says.
        message: Why it ended, if not because it was done or stopped.
    """

    def __init__(self, plan: Plan, folder: Path) -> None:
        """Begin."""
        self.plan, self._folder = plan, folder
        self.said = {**NOTHING, "survivors": len(plan.configurations)}
        self.message: str | None = None
        self._is_stopped = False
        self._is_heard = threading.Event()
        self._ended = threading.Event()
        context = multiprocessing.get_context("spawn")
        self._line, line = context.Pipe(duplex=False)
        self._process = context.Process(target=work, args=(plan, folder, line), daemon=True)
        self._process.start()
        line.close()
        threading.Thread(target=self._listen, daemon=True).start()

    @property
    def is_alive(self) -> bool:
        """Whether it goes on."""
        return not self._ended.is_set()

    def wait_until_begun(self) -> None:
        """Wait until its folder is there, or it has ended."""
        while not ((self._folder / QUESTION).exists() or self._ended.wait(LOOK_S)):
            pass

    def stop(self) -> None:
        """Interrupt it, and wait until it has ended."""
        self._is_stopped = True
        # Before it is heard it is only being made, and an interrupt would be lost, or printed.
        self._is_heard.wait(STOP_S)
        if self.is_alive and self._process.pid is not None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._process.pid, signal.SIGINT)
        if not self._ended.wait(STOP_S):
            self._process.kill()
            self._ended.wait()

    def _listen(self) -> None:
        with contextlib.suppress(EOFError, OSError), self._line:
            while True:
                self._hear(self._line.recv())
        self._is_heard.set()
        self._process.join()
        if self.message is None and not self._is_stopped:
            self.message = why(self._process.exitcode or 0)
        self._ended.set()

    def _hear(self, said: dict[str, Any]) -> None:
        self._is_heard.set()
        self.message = said.pop("message", None)
        gone = self.said["eliminated"] + said.pop("eliminated", [])
        self.said = {**self.said, **said, "eliminated": gone}


def why(code: int) -> str | None:
    """Return why a process ended, if not well."""
    if code == 0:
        return None
    how = f"was killed by signal {-code}" if code < 0 else f"ended with code {code}"
    return f"The process of this study {how}. What it had stored is kept: go on with it."


def work(plan: Plan, folder: Path, line: Connection) -> None:
    """Run a study, or go on with it; this is what the process does."""
    os.nice(GENTLE)
    threading.Thread(target=end_with_server, daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt, ConnectionError):
        # A shell that starts the server in the background may have it ignored.
        signal.signal(signal.SIGINT, interrupted)
        line.send({})
        try:
            study.run_plan(plan, folder, on_progress=ProgressReporter(line))
        except (StudyError, InputError) as error:
            line.send({"message": str(error)})


def interrupted(*_: object) -> None:
    """Interrupt this process once: Ctrl-C in a terminal reaches it, and its server that asks again.

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
        time.sleep(STOP_S)
        os._exit(1)


class ProgressReporter:
    """Tells the server how far a study is, not too often."""

    def __init__(self, line: Connection) -> None:
        """Begin with nothing told."""
        self._line = line
        self._eliminated: list[list[int]] = []
        self._gone: set[int] = set()
        self._estimated: dict[str, Any] = {}
        self._tell_at_s = self._estimate_at_s = 0.0

    def __call__(self, now: Progress) -> None:
        """Tell, if it is time."""
        self._eliminated += [[each.configuration, each.by, each.runs] for each in now.eliminated]
        self._gone |= {each.configuration for each in now.eliminated}
        now_s = time.monotonic()
        if now_s < self._tell_at_s and not now.is_over:
            return
        if now_s >= self._estimate_at_s:
            self._estimated = estimated(now)
            took_s = time.monotonic() - now_s
            self._estimate_at_s = now_s + max(RANGES_S, took_s / RANGES_SHARE)
        counts = {name: getattr(now, name) for name in COUNTS}
        # Some may have been put out since the estimate.
        left = [row for row in self._estimated["standings"] if row[0] not in self._gone]
        told = {**counts, **self._estimated, "standings": left, "eliminated": self._eliminated}
        self._line.send(told)
        self._eliminated = []
        self._tell_at_s = time.monotonic() + TELL_S


def estimated(now: Progress) -> dict[str, Any]:
    """Return what takes a moment to say: the best with their ranges, and the runs left."""
    return {
        "standings": [
            [leader.configuration, leader.runs, leader.merit, merit.low, merit.high]
            for leader, merit in now.intervals()
        ],
        "left_runs": None if now.is_over else now.estimate_remaining(),
    }

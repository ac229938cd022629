"""Faults of the processes of a drive: what breaks each, and when its robot stops."""

import os
import resource
import signal
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from live_bench import Bench, Drive, driving, fleet_text

from agent_economy.live.channel import SILENCE_S
from agent_economy.live.clock import now_s

PAUSE_S = 0.2
"""Time between two faults."""

FLUSH_S = 0.5
"""The loop writes its recording this often."""


@dataclass(frozen=True)
class ProcessFault:
    """A fault of a process.

    Attributes:
        name: Its name in tables.
        inject: Breaks the drive.
        limit_s: The time after which it can be detected: the stop is timed from there.
        expected: The fault that the rules report; None where the warden cannot.
        exit_code: The exit code of the drive.
    """

    name: str
    inject: Callable[[Drive], None]
    limit_s: float
    expected: str | None
    exit_code: int


def of_loop(number: signal.Signals) -> Callable[[Drive], None]:
    """Return what sends a signal to the loop."""
    return lambda drive: os.kill(drive.loop_pid(), number)


def of_warden(number: signal.Signals) -> Callable[[Drive], None]:
    """Return what sends a signal to the warden."""
    return lambda drive: drive.process.send_signal(number)


def keep_busy(drive: Drive) -> None:
    """Leave the loop a fifth of the time, in pieces, as on an overloaded machine."""
    pid = drive.loop_pid()

    def share() -> None:
        try:
            while drive.process.poll() is None:
                os.kill(pid, signal.SIGSTOP)
                time.sleep(0.4)
                os.kill(pid, signal.SIGCONT)
                time.sleep(0.1)
        except ProcessLookupError:
            return

    threading.Thread(target=share, daemon=True).start()


def fill_disk(drive: Drive) -> None:
    """Let the recording grow no further."""
    size = drive.record.stat().st_size
    resource.prlimit(drive.loop_pid(), resource.RLIMIT_FSIZE, (size, size))


def press_stop(drive: Drive) -> None:
    """Send an emergency stop to the endpoint."""
    drive.post("/stop")


FAULTS = (
    ProcessFault("emergency stop", press_stop, 0.0, "emergency_stop", 3),
    ProcessFault("loop killed", of_loop(signal.SIGKILL), 0.0, "loop_dead", 3),
    ProcessFault("loop suspended", of_loop(signal.SIGSTOP), SILENCE_S, "loop_silent", 3),
    ProcessFault("loop busy", keep_busy, SILENCE_S, "loop_silent", 3),
    ProcessFault("disk full", fill_disk, FLUSH_S, "recording_error", 3),
    ProcessFault("warden killed", of_warden(signal.SIGKILL), 0.0, None, -signal.SIGKILL),
    ProcessFault("warden suspended", of_warden(signal.SIGSTOP), SILENCE_S, None, -signal.SIGKILL),
)
"""One per drive."""


class Drives:
    """Drives of one robot each, one per fault."""

    def __init__(self, bench: Bench, scenario: Path, folder: Path, stack: ExitStack) -> None:
        """Start them, and wait until all robots move; they end with the stack."""
        self._bench = bench
        self._broken_s: list[float] = []
        self.drives: list[Drive] = []
        for robot in range(len(FAULTS)):
            own = folder / str(robot)
            own.mkdir(exist_ok=True)
            fleet = own / "fleet.toml"
            text = fleet_text(bench, scenario=str(scenario), robots=[robot])
            fleet.write_text(text, encoding="utf-8")
            self.drives.append(stack.enter_context(driving(fleet)))
        for robot, drive in enumerate(self.drives):
            drive.wait_until_moving(f"bender/{robot}")
        bench.wait_for_motion(len(FAULTS))

    def inject(self) -> None:
        """Break each drive in its way, one after the other."""
        for fault, drive in zip(FAULTS, self.drives, strict=True):
            self._broken_s.append(now_s())
            fault.inject(drive)
            time.sleep(PAUSE_S)

    def limit_s(self, robot: int) -> float:
        """Return the time from which on a fault can be detected."""
        return self._broken_s[robot] + FAULTS[robot].limit_s

    def stop_delay_s(self, robot: int) -> float:
        """Return the time from there to the stop after the last motion line."""
        fault, drive = FAULTS[robot], self.drives[robot]
        if fault.expected:
            drive.wait_for_fault(f"bender/{robot}", fault.expected)
        drive.wait()
        moved_s = max(self._bench.moves_after(robot, 0.0))
        stopped_s = self._bench.stops_after(robot, moved_s)[0]
        return stopped_s - self.limit_s(robot)

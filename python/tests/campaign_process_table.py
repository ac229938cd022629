"""The campaign of `make safety`: faults of the processes of a drive, and requests of operators.

A new one is one row: what is done, and what has to happen.
"""

import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import process_faults
from campaign_scene import Scene, name_of
from campaign_table import REACTION_S, Kind, State, manual_kind

from agent_economy.live.channel import SILENCE_S
from agent_economy.live.clock import now_s
from agent_economy.live.rules.faults import MANUAL_LIFETIME_S

MOVING = (State.STRAIGHT, State.TURNING, State.MANUAL)
AUTOMATIC = (State.STRAIGHT, State.TURNING)
SOME = (State.STRAIGHT, State.MANUAL, State.HELD, State.STOPPED)
ALL = tuple(State)
LOOK_S = 0.1
"""Time after which the loop looks again whether the warden is silent."""

LATER_S = 1.0
"""Time between two faults."""

Inject = Callable[[Scene], float]
"""Does something to a drive, and returns the time that counts."""


@dataclass(frozen=True)
class ProcessRow:
    """Something that is done to a drive, and what has to happen to each of its robots.

    Attributes:
        name: Its name in tables.
        inject: Does it.
        names: Faults of the rules of which one has to be reported; none where the warden cannot.
        detect_s: The time after which it can be detected: delays count from there.
        limit_s: The longest delay.
        states: The states in which it is tried.
        is_passed: Whether nothing has to happen.
    """

    name: str
    inject: Inject
    names: tuple[str, ...] = ()
    detect_s: float = 0.0
    limit_s: float = REACTION_S
    states: tuple[State, ...] = SOME
    is_passed: bool = False

    def kind(self, state: State) -> Kind:
        """Return what has to happen in a state."""
        if self.is_passed:
            return Kind.NOTHING
        if not self.names or state in AUTOMATIC:
            return Kind.STOP
        return manual_kind(self.names[0]) if state is State.MANUAL else Kind.REPORT

    def expected(self, state: State) -> str:
        """Return what has to happen, as tables print it."""
        if self.is_passed:
            return "stop on request" if state.moves else "stands"
        return f"{self.kind(state)}: {' or '.join(self.names) or 'by the loop'}"


def signals(*steps: tuple[str, signal.Signals]) -> Inject:
    """Return what sends signals to processes at once; the time of the last one counts."""

    def inject(stage: Scene) -> float:
        pids = {"loop": stage.loop_pid, "warden": stage.drive.process.pid}
        at_s = now_s()
        for process, number in steps:
            at_s = now_s()
            os.kill(pids[process], number)
        return at_s

    return inject


def first(*parts: Inject) -> Inject:
    """Return what does several things, with time between; the time of the first one counts."""

    def inject(stage: Scene) -> float:
        return in_order(parts, stage)[0]

    return inject


def last(*parts: Inject) -> Inject:
    """Return what does several things, with time between; the time of the last one counts."""

    def inject(stage: Scene) -> float:
        return in_order(parts, stage)[-1]

    return inject


def in_order(parts: tuple[Inject, ...], stage: Scene) -> list[float]:
    """Do several things, with time between; return their times."""
    times_s = []
    for number, part in enumerate(parts):
        if number:
            time.sleep(LATER_S)
        times_s.append(part(stage))
    return times_s


def pause_warden(stage: Scene) -> float:
    """Suspend the warden for a time that is shorter than any limit."""
    at_s = now_s()
    stage.drive.process.send_signal(signal.SIGSTOP)
    time.sleep(0.1)
    stage.drive.process.send_signal(signal.SIGCONT)
    return at_s


def with_drive(act: Callable[..., None], stage: Scene) -> float:
    """Do something to the drive."""
    at_s = now_s()
    act(stage.drive)
    return at_s


def request(path: str, stage: Scene) -> float:
    """Send a request for all robots."""
    at_s = now_s()
    stage.ask(path)
    return at_s


def request_each(path: str, body: Callable[[Scene], dict[str, object]], stage: Scene) -> float:
    """Send a request for each robot; the time of the last one counts."""
    at_s = now_s()
    for robot in range(stage.robots):
        at_s = now_s()
        stage.ask(path, robot=name_of(robot), **body(stage))
    return at_s


def take_over(stage: Scene) -> float:
    """Let another client become the operator."""
    at_s = now_s()
    stage.drive.ask("/operator", client="another", take=True, take_over=True)
    return at_s


def silence(stage: Scene) -> float:
    """Let the operator send nothing any more."""
    stage.hands.close()
    return stage.hands.last_s


def switch(stage: Scene) -> dict[str, object]:
    """Return the mode in which the robots are not."""
    return {"mode": "auto" if stage.state is State.MANUAL else "manual"}


KILL, STOP, CONT = signal.SIGKILL, signal.SIGSTOP, signal.SIGCONT
DISK = partial(with_drive, process_faults.fill_disk)
BUSY = partial(with_drive, process_faults.keep_busy)
KILL_WARDEN = signals(("warden", KILL))
SUSPEND_BOTH = signals(("warden", STOP), ("loop", STOP))
SILENT, DEAD = ("loop_silent",), ("loop_dead",)
GAP = ("event_loop_gap", "loop_silent")
STANDING = (State.STRAIGHT, State.HELD, State.STOPPED)

PROCESSES = (
    ProcessRow("loop killed", signals(("loop", KILL)), DEAD),
    ProcessRow("loop suspended", signals(("loop", STOP)), SILENT, SILENCE_S),
    ProcessRow(
        "loop suspended for 1 s",
        first(signals(("loop", STOP)), signals(("loop", CONT))),
        SILENT,
        SILENCE_S,
        states=(State.STRAIGHT,),
    ),
    ProcessRow("loop busy", BUSY, SILENT, SILENCE_S, states=(State.STRAIGHT, State.MANUAL)),
    # The recording is written twice per second, and its error is a message of the next step.
    ProcessRow("disk full", DISK, ("recording_error",), process_faults.FLUSH_S + 0.1),
    ProcessRow("warden killed", KILL_WARDEN, states=ALL),
    ProcessRow("warden suspended", signals(("warden", STOP)), (), SILENCE_S),
    ProcessRow("warden suspended for 0.1 s", pause_warden, is_passed=True),
    ProcessRow(
        "loop killed, then the warden",
        first(signals(("loop", KILL)), KILL_WARDEN),
        DEAD,
        states=STANDING,
    ),
    ProcessRow(
        "loop suspended, then warden killed",
        first(signals(("loop", STOP)), KILL_WARDEN),
        SILENT,
        SILENCE_S,
        states=STANDING,
    ),
    ProcessRow("disk full, then warden killed", last(DISK, KILL_WARDEN), states=(State.MANUAL,)),
    # Until then nothing stops the robots.
    ProcessRow(
        "loop suspended and warden killed: loop continued",
        last(signals(("loop", STOP), ("warden", KILL)), signals(("loop", CONT))),
    ),
    ProcessRow(
        "both suspended: warden continued", last(SUSPEND_BOTH, signals(("warden", CONT))), GAP
    ),
    # A loop that was suspended itself judges the warden from then on.
    ProcessRow(
        "both suspended: loop continued",
        last(SUSPEND_BOTH, signals(("loop", CONT))),
        detect_s=SILENCE_S,
        # The silence counts from its first look, and it looks every 0.1 s.
        limit_s=REACTION_S + LOOK_S,
    ),
)

REQUESTS = (
    # Where it is latched already, nothing new is reported.
    ProcessRow(
        "request: stop",
        partial(request, "/stop"),
        ("emergency_stop",),
        states=tuple(state for state in State if state is not State.STOPPED),
    ),
    ProcessRow("request: hold", partial(request, "/hold"), ("held",), states=MOVING),
    ProcessRow(
        "request: mode",
        partial(request_each, "/mode", switch),
        ("mode_changed",),
        states=(State.STRAIGHT, State.MANUAL, State.HELD),
    ),
    ProcessRow(
        "request: navigation off",
        partial(request_each, "/navigate", lambda _: {"is_on": False}),
        ("held",),
        states=AUTOMATIC,
    ),
    ProcessRow("request: take over", take_over, ("no_setpoint",), states=(State.MANUAL,)),
    ProcessRow(
        "operator silent", silence, ("no_setpoint",), MANUAL_LIFETIME_S, states=(State.MANUAL,)
    ),
    ProcessRow("Ctrl-Z", signals(("warden", signal.SIGTSTP)), ("emergency_stop",), states=MOVING),
)


def fleets(row: ProcessRow) -> list[tuple[State, int]]:
    """Return the states and the numbers of robots with which a row is tried."""
    both = (State.STRAIGHT, State.MANUAL)
    return [
        (state, robots) for state in row.states for robots in ((1, 2) if state in both else (2,))
    ]

"""The campaign of `make safety`: every fault of one robot, and what has to happen in each state.

A new fault is one row. What a fault does in manual mode is not stated here: the rules have it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from agent_economy.live.rules.faults import FAULTS as RULES
from agent_economy.live.rules.faults import InManual


class State(StrEnum):
    """What the robots do when a fault begins."""

    STRAIGHT = "straight"
    """They drive straight on in automatic mode, between walls that the sonars see."""
    TURNING = "turning"
    """They turn away from near walls in automatic mode."""
    MANUAL = "manual"
    """They are driven straight on by hand."""
    HELD = "held"
    """An operator holds them; they are armed."""
    STOPPED = "stopped"
    """An emergency stop is latched."""
    UNARMED = "not armed"
    """They could be armed, and have not been since the start."""

    @property
    def moves(self) -> bool:
        """Whether robots move in it."""
        return self in (State.STRAIGHT, State.TURNING, State.MANUAL)


class Kind(StrEnum):
    """What has to happen."""

    STOP = "stop"
    SLOW = "speed limit"
    REPORT = "report"
    NOTHING = "no fault"


REACTION_S = 0.1
"""The limit: a turn of the warden is 0.02 s, and the emulator needs its time to read the line."""

RECONNECT_S = 0.3
"""The limit where the motor port has to be connected again before stop can be written."""

RETURN_S = 0.8
"""The limit for a motor port that can be reached again: it is tried every 0.4 s."""

UNSEEN_S = 15.0
"""The limit for a robot that moves although it should stand: noise hides it for seconds."""

MOTIONS = ("driving", "turning", "standing")

AGES_S = {"sonar": 0.5, "compass": 1.0, "gps": 3.0}


@dataclass(frozen=True)
class Finding:
    """A fault that the rules have to report.

    Attributes:
        names: The faults of the rules of which one has to be reported.
        cause: What the limit counts from: the last line sent "before" the fault, the first one
            "after" it, the first motor line "written" after it, or the fault itself, "at once".
        detect_s: The time after the cause until it can be detected: delays count from there.
        limit_s: The longest delay.
    """

    names: tuple[str, ...]
    cause: str = "after"
    detect_s: float = 0.0
    limit_s: float = REACTION_S

    @property
    def name(self) -> str:
        """Its name in tables."""
        return " or ".join(self.names)


@dataclass(frozen=True)
class WireRow:
    """A fault of one port of one robot, and what has to happen.

    Attributes:
        port: The port.
        fault: The fault of the emulator; "unplug" is `refuse` and `close`.
        value: Its value.
        findings: What is found: while "driving", "turning" or "standing".
        request_limit_s: The limit of a stop that is requested while the fault lasts.
        is_deaf: Whether a stop that is requested has no effect, which has to be found.
        allowed: Faults that may appear although none has to.
        is_link: Whether no stop can reach the robot until it is healed: the report is timed.
    """

    port: str
    fault: str
    value: Any
    findings: Mapping[str, Finding]
    request_limit_s: float = REACTION_S
    is_deaf: bool = False
    allowed: tuple[str, ...] = ()
    is_link: bool = False

    @property
    def name(self) -> str:
        """The fault and its value, in tables."""
        return self.fault if self.value is None else f"{self.fault} {self.value:g}"

    def finding(self, state: State) -> Finding | None:
        """Return what has to be found in a state."""
        turning = "turning" if state is State.TURNING else "driving"
        return self.findings.get(turning if state.moves else "standing")

    def kind(self, state: State) -> Kind:
        """Return what has to happen in a state."""
        finding = self.finding(state)
        if finding is None:
            return Kind.NOTHING
        if not state.moves:
            return Kind.REPORT
        if state is State.MANUAL:
            return manual_kind(finding.names[0])
        return Kind.STOP

    def expected(self, state: State) -> str:
        """Return what has to happen, as tables print it."""
        finding, kind = self.finding(state), self.kind(state)
        if finding is not None:
            return f"{kind}: {finding.name}"
        if not state.moves:
            return "stands"
        return "on request: moves_while_stopped" if self.is_deaf else "stop on request"

    def limit_s(self, state: State) -> float:
        """Return the limit of its figure in a state."""
        finding = self.finding(state)
        if finding is not None:
            return finding.limit_s
        return UNSEEN_S if self.is_deaf else self.request_limit_s


def manual_kind(name: str) -> Kind:
    """Return what a fault of the rules does in manual mode."""
    effect = next(each.in_manual for each in RULES if each.name == name)
    if effect is InManual.STOP:
        return Kind.STOP
    return Kind.REPORT if effect is InManual.WARN else Kind.SLOW


def row(
    port: str,
    fault: str,
    value: Any = None,
    found: Finding | Mapping[str, Finding] | None = None,
    **further: Any,
) -> WireRow:
    """Return a row; what is found always, or only while "driving", "turning" or "standing"."""
    if isinstance(found, Finding):
        found = dict.fromkeys(MOTIONS, found)
    return WireRow(port, fault, value, found or {}, **further)


LOST = Finding(("lost_link",), "at once")
IMPOSSIBLE = Finding(("impossible_value",))
JUMP = Finding(("jump",))
STALE = {port: Finding(("stale_input",), "before", age_s) for port, age_s in AGES_S.items()}
# 3 s of commanded motion, or a change of 8 deviations, and then the next line.
FROZEN = {
    port: Finding(("frozen",), "at once", limit_s=limit_s)
    for port, limit_s in {"sonar": 3.7, "compass": 3.7, "gps": 5.5}.items()
}
MOVES = Finding(("moves_while_stopped",), "at once", limit_s=UNSEEN_S)

MOTORS = (
    row("motors", "drop", 0.1, request_limit_s=0.6),
    row("motors", "drop", 1.0, is_deaf=True),
    row("motors", "delay", 1.0, request_limit_s=1.1, allowed=("moves_while_stopped",)),
    row("motors", "duplicate"),
    row("motors", "garble", is_deaf=True),
    row("motors", "half", is_deaf=True),
    row("motors", "stall", is_deaf=True),
    row("motors", "cut", found=Finding(("lost_link",), "written", 0.3), is_link=True),
    row("motors", "close", found=Finding(("lost_link",), "at once", limit_s=RECONNECT_S)),
    row("motors", "refuse"),
    row("motors", "unplug", found=LOST, is_link=True),
    row("motors", "runaway", 0.3, found={"standing": MOVES}, is_deaf=True),
    row("motors", "ignore_stop", is_deaf=True),
    row("motors", "obey_nothing", is_deaf=True),
)


def of_lines(port: str) -> tuple[WireRow, ...]:
    """Return the faults that every port with lines can have."""
    stale = STALE[port]
    return (
        row(port, "drop", 0.1, allowed=("stale_input",)),
        row(port, "drop", 1.0, found=stale),
        row(port, "delay", 0.1),
        row(port, "delay", 60.0, found=stale),
        row(port, "duplicate"),
        row(port, "garble", found=stale),
        # The halves of two compass lines would mix whenever the emulator is late by 0.08 s.
        *(() if port == "compass" else (row(port, "half", 0.02),)),
        row(port, "half", found=stale),
        row(port, "stall", found=stale),
        row(port, "cut", found=stale),
        row(port, "close", found=LOST),
        row(port, "refuse"),
        row(port, "unplug", found=LOST),
        row(port, "nan", found=IMPOSSIBLE),
    )


ROWS = (
    *MOTORS,
    *of_lines("compass"),
    row("compass", "freeze", found={"turning": FROZEN["compass"]}),
    row("compass", "jump", 90.0, found=JUMP),
    row(
        "compass",
        "one_digit",
        # While the robot turns, the one heading may be near the last one: then it is frozen.
        found={
            "driving": JUMP,
            "standing": JUMP,
            "turning": Finding(("jump", "frozen"), "at once", limit_s=FROZEN["compass"].limit_s),
        },
    ),
    row("compass", "obey_nothing"),
    *of_lines("gps"),
    row("gps", "freeze", found={"driving": FROZEN["gps"]}),
    row("gps", "jump", 50.0, found=JUMP),
    row("gps", "short", 3, found=STALE["gps"]),
    *of_lines("sonar"),
    row("sonar", "freeze", found={"driving": FROZEN["sonar"]}),
    # Another object can come into view of a robot that drives; two ranges of one that stands are
    # a motion.
    row("sonar", "jump", 2.0, found={"standing": Finding(("moves_while_stopped",))}),
    row("sonar", "short", 3, found=STALE["sonar"]),
    row("sonar", "seven", found=STALE["sonar"]),
)
"""Every fault of every port that can have it."""

"""The table of faults: docs/safety.md prints it.

Its limits are here too, so that a row and what it states cannot differ.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from enum import StrEnum

CLEAR_S = 1.0
"""A fault stays active for this time after its cause has ended: an input has to be fresh for it."""

LONG_STOP_S = 5.0
"""After a stop of this length a robot has to be armed again."""

MAX_UNACKNOWLEDGED_S = 0.3
"""A link is lost when the peer has acknowledged nothing for this time."""

MAX_GAP_S = 1.0
"""The longest time between two turns of the warden's event loop."""

MAX_SILENCE_S = 0.3
"""The longest time between two messages of the loop."""

SETTLING_S = 1.0
"""Time after a stop command in which a robot may still move."""

STILL_S = 3.0
"""Time for which the inputs must not change before a standstill is confirmed."""

STANDSTILL_S = 10.0
"""Time over which the means of positions and headings must not change for that, too."""

MOVES_SIGMAS, STANDS_SIGMAS, MISSED_SIGMAS = 8.0, 3.5, 3.0
"""A slope of positions or headings shows a motion above the first number of standard deviations of
the slope, plus the drift; up to the second, it confirms a standstill. A motion that is faster by
the third is noticed in 998 of 1000 cases. The first is large because the errors of receivers are
correlated, and slopes therefore larger than those of independent errors."""

DRIFT_M_S, DRIFT_RAD_S = 0.1, math.radians(1.0)
"""Positions and headings of a robot that stands may drift as fast as this."""

FROZEN_S = 3.0
"""Time of commanded motion in which an input has to change."""

FROZEN_LINES = 3
"""An input is frozen after this many equal lines at least."""

JITTER_S = 0.3
"""A line may be this much older than its arrival; a longer delay is a lost link."""

MANUAL_LIFETIME_S = 0.4
"""Time for which a setpoint of the operator is valid."""

NOISE_SIGMAS = 8.0
"""Two readings differ when they are this many standard deviations of the noise apart.

The difference of two readings has 1.41 standard deviations of one, so normal noise alone reaches
this in less than one of 10 million readings."""

TURN_MARGIN_S = 5.0
"""A turn to a heading may take a full turn at the maximum turn rate, and this time more."""

TURN_GAP_S = 1.0
"""Turns with a shorter time between them are one: a brain repeats one that has not ended."""


class Clears(StrEnum):
    """What ends the stop that a fault caused."""

    ITSELF = "by itself"
    """The fault: one second after its cause has ended."""
    ARMING = "arming"
    """An operator who arms the robot, once the fault is no longer active."""
    RELEASE = "release, then arming"
    """An operator who releases the emergency stop, and then arms the robot."""
    RESUME = "resume"
    """An operator who ends the hold; the stop ends one second later."""


class InManual(StrEnum):
    """What a fault does in manual mode."""

    STOP = "stop"
    SLOW = "warn, limit speed"
    SLOW_NOT_ARMED = "warn, limit speed, not armed"
    WARN = "warn"


SLOW = (InManual.SLOW, InManual.SLOW_NOT_ARMED)
"""What limits the speed."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault: a row of the table, or one that is active, with its reason.

    Attributes:
        name: Its name. Faults are equal if their rows are, whatever their reasons.
        cause: When it is active.
        delay_s: Time from the cause to the stop, beyond one turn of the warden.
        clears: What ends the stop.
        in_manual: What it does in manual mode.
        delay_note: What the delay depends on.
        reason: The cause with its values; empty in the table.
    """

    name: str
    cause: str
    delay_s: float
    clears: Clears
    in_manual: InManual
    delay_note: str = ""
    reason: str = field(default="", compare=False)

    @property
    def delay(self) -> str:
        """The delay with its note, as the table prints it."""
        return f"{self.delay_s:g} s{self.delay_note}"

    @property
    def latches(self) -> bool:
        """Whether the robot has to be armed after it."""
        return self.clears in (Clears.ARMING, Clears.RELEASE)

    def because(self, reason: str) -> "Fault":
        """Return the fault with a reason."""
        return replace(self, reason=reason)


EMERGENCY_STOP = Fault(
    "emergency_stop",
    "An operator pressed emergency stop.",
    0.0,
    Clears.RELEASE,
    InManual.STOP,
)
MOVES_WHILE_STOPPED = Fault(
    "moves_while_stopped",
    f"Heading, position or two ranges changed by more than {NOISE_SIGMAS:g} standard deviations of "
    f"their noise within {STILL_S:g} s, or means of positions or headings by more than "
    f"{DRIFT_M_S:g} m/s or {math.degrees(DRIFT_RAD_S):g} degrees/s and {MOVES_SIGMAS:g} standard "
    "deviations of their slope, although stop has been commanded.",
    SETTLING_S,
    Clears.ARMING,
    InManual.STOP,
    " of settling, then until the change exceeds the noise",
)
LOST_LINK = Fault(
    "lost_link",
    "A port is not connected, or the robot has acknowledged nothing for "
    f"{MAX_UNACKNOWLEDGED_S:g} s.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
)
EVENT_LOOP_GAP = Fault(
    "event_loop_gap",
    f"More than {MAX_GAP_S:g} s passed between two turns of the warden, or its clock went "
    "backwards.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
    "; stop is sent when the warden runs again",
)
OUTSIDE_FENCE = Fault(
    "outside_fence",
    "The position is outside the fence, or there is a fence and no input for positions.",
    0.0,
    Clears.ARMING,
    InManual.SLOW,
)
OUTSIDE_WORLD = Fault(
    "outside_world",
    f"The position is outside the world by more than {NOISE_SIGMAS:g} standard deviations of its "
    "noise. No robot is armed there, in either mode.",
    0.0,
    Clears.ARMING,
    InManual.SLOW_NOT_ARMED,
)
IMPOSSIBLE_VALUE = Fault(
    "impossible_value",
    "A value is not a number or out of its bounds, or a line has the wrong number of values.",
    0.0,
    Clears.ARMING,
    InManual.SLOW,
)
JUMP = Fault(
    "jump",
    "Heading or position changed by more than the maximum turn rate or speed allows in the time "
    f"between two lines plus {JITTER_S:g} s, and {NOISE_SIGMAS:g} standard deviations of the "
    "noise. Active until it is back, or an operator has confirmed the value.",
    0.0,
    Clears.ARMING,
    InManual.SLOW,
)
FROZEN = Fault(
    "frozen",
    f"{FROZEN_LINES} lines or more had equal values although a change of more than "
    f"{NOISE_SIGMAS:g} standard deviations of the noise was commanded: turning for headings, "
    "driving for positions and ranges. Active until the values have changed, or an operator has "
    "confirmed them.",
    FROZEN_S,
    Clears.ARMING,
    InManual.SLOW,
    " of commanded motion, or longer until the commanded change exceeds the noise",
)
TURN_DOES_NOT_END = Fault(
    "turn_does_not_end",
    "A turn to a heading takes longer than a full turn at the maximum turn rate plus "
    f"{TURN_MARGIN_S:g} s. Turns with less than {TURN_GAP_S:g} s between them are one.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
)
LOOP_DEAD = Fault(
    "loop_dead",
    "The process of the loop has ended.",
    0.0,
    Clears.ARMING,
    InManual.WARN,
)
LOOP_SILENT = Fault(
    "loop_silent",
    f"The loop has sent no message for more than {MAX_SILENCE_S:g} s.",
    0.0,
    Clears.ARMING,
    InManual.WARN,
)
LOOP_LATE = Fault(
    "loop_late",
    "A step of the loop was late by more than `max_lateness_s`.",
    0.0,
    Clears.ARMING,
    InManual.WARN,
)
RECORDING_ERROR = Fault(
    "recording_error",
    "The recording cannot be written.",
    0.0,
    Clears.ARMING,
    InManual.WARN,
)
LOW_BATTERY = Fault(
    "low_battery",
    "The robot reports a charge below `min_battery`.",
    0.0,
    Clears.ARMING,
    InManual.WARN,
)
MISSING_INPUT = Fault(
    "missing_input",
    "An input has had no line since the start.",
    0.0,
    Clears.ITSELF,
    InManual.SLOW,
)
STALE_INPUT = Fault(
    "stale_input",
    "The newest value of an input is older than its `max_age_s`.",
    0.0,
    Clears.ITSELF,
    InManual.SLOW,
)
NO_SETPOINT = Fault(
    "no_setpoint",
    "There is no valid setpoint: none has come, it has expired, or it is not a number. In manual "
    "mode the operator's counts, otherwise the loop's.",
    0.0,
    Clears.ITSELF,
    InManual.STOP,
)
CONTROLS_DEFLECTED = Fault(
    "controls_deflected",
    "In manual mode, the controls of the operator are deflected and have not been neutral since "
    "the robot could move.",
    0.0,
    Clears.ITSELF,
    InManual.STOP,
)
HELD = Fault(
    "held",
    "An operator holds all robots, or has switched off the navigation of this robot in automatic "
    "mode.",
    0.0,
    Clears.RESUME,
    InManual.STOP,
)
LONG_STOP = Fault(
    "long_stop",
    "Other faults than `held` and `controls_deflected` stopped the robot for more than "
    f"{LONG_STOP_S:g} s.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
)
MODE_CHANGED = Fault(
    "mode_changed",
    "An operator switched between automatic and manual mode.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
)
NOT_ARMED = Fault(
    "not_armed",
    "The robot has not been armed since the start, or since the emergency stop was released.",
    0.0,
    Clears.ARMING,
    InManual.STOP,
)

FAULTS: tuple[Fault, ...] = (
    EMERGENCY_STOP,
    MOVES_WHILE_STOPPED,
    LOST_LINK,
    EVENT_LOOP_GAP,
    OUTSIDE_FENCE,
    OUTSIDE_WORLD,
    IMPOSSIBLE_VALUE,
    JUMP,
    FROZEN,
    TURN_DOES_NOT_END,
    LOOP_DEAD,
    LOOP_SILENT,
    LOOP_LATE,
    RECORDING_ERROR,
    LOW_BATTERY,
    MISSING_INPUT,
    STALE_INPUT,
    NO_SETPOINT,
    CONTROLS_DEFLECTED,
    HELD,
    LONG_STOP,
    MODE_CHANGED,
    NOT_ARMED,
)
"""All faults, gravest first."""

_GRAVITY = {fault.name: place for place, fault in enumerate(FAULTS)}


def gravest_first(faults: Iterable[Fault]) -> tuple[Fault, ...]:
    """Return one fault per name, gravest first, with the reasons of all of that name."""
    found: dict[str, Fault] = {}
    for fault in faults:
        before = found.setdefault(fault.name, fault)
        if before.reason != fault.reason:
            found[fault.name] = before.because(f"{before.reason}; {fault.reason}")
    return tuple(sorted(found.values(), key=lambda each: _GRAVITY[each.name]))

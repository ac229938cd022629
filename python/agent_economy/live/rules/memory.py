"""What the rules remember from one update to the next."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from agent_economy.live.readings import STOP, Motion
from agent_economy.live.rules.faults import NOT_ARMED, Fault
from agent_economy.live.rules.interface import Action, Mode
from agent_economy.live.rules.monitors import NOTHING_COMMANDED, Commanded, InputMemory


@dataclass(frozen=True, slots=True)
class Held:
    """A fault that is active, and since when its cause has ended; None while it lasts."""

    fault: Fault
    ended_s: float | None = None


@dataclass(frozen=True, slots=True)
class RobotMemory:
    """What is remembered of one robot.

    Attributes:
        mode: Its mode.
        navigates: Whether it follows its plan in automatic mode.
        latched: Why it has to be armed.
        held: Its active faults, by name.
        inputs: Its inputs, by port.
        motion: The motion commanded last.
        commanded: The motion commanded since the start.
        action: Its last action.
        stopped_since_s: Since when stop has been commanded; None while it moves.
        blocked_since_s: Since when faults other than a hold stop it; None while none does.
        turning_since_s: Since when it turns to a heading by itself; None if it does not.
        turned_s: When it did so last.
        neutral_of: The operator whose controls have been neutral since it could move, if any.
    """

    mode: Mode = Mode.AUTO
    navigates: bool = True
    latched: tuple[Fault, ...] = (NOT_ARMED.because("not armed since the start"),)
    held: Mapping[str, Held] = field(default_factory=dict)
    inputs: Mapping[str, InputMemory] = field(default_factory=dict)
    motion: Motion = STOP
    commanded: Commanded = NOTHING_COMMANDED
    action: Action = Action.LATCHED_STOP
    stopped_since_s: float | None = None
    blocked_since_s: float | None = None
    turning_since_s: float | None = None
    turned_s: float = -math.inf
    neutral_of: int | None = None


@dataclass(frozen=True, slots=True)
class Memory:
    """What is remembered of a fleet: pass it to the next update."""

    time_s: float | None
    robots: Mapping[str, RobotMemory]
    is_held: bool = False

"""What goes into the rules and what comes out: plain values.

Times are seconds of one clock, which runs on while the machine sleeps. Robots are keyed by name,
links and samples by port.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum

from agent_economy.live.readings import Motion
from agent_economy.live.rules.faults import Fault


class Action(IntEnum):
    """What a robot does. The graver action wins."""

    MOVE = 0
    """It follows the setpoint."""
    STOP = 1
    """It stands until its faults have cleared."""
    LATCHED_STOP = 2
    """It stands until an operator arms it."""


class Mode(StrEnum):
    """Where the setpoints of a robot come from."""

    AUTO = "auto"
    """From the loop."""
    MANUAL = "manual"
    """From an operator."""


@dataclass(frozen=True, slots=True)
class Sample:
    """The newest reading of an input.

    Attributes:
        time_s: When it arrived.
        values: Its values: see `Quantity`. NaN is an impossible value.
    """

    time_s: float
    values: tuple[float | None, ...]


@dataclass(frozen=True, slots=True)
class Link:
    """The state of the connection to one port.

    Attributes:
        is_up: Whether it is connected.
        unacknowledged_s: Time for which the peer has acknowledged nothing of what was written.
        reason: Why it is down.
    """

    is_up: bool
    unacknowledged_s: float = 0.0
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Setpoint:
    """A motion requested of a robot.

    Attributes:
        motion: The motion.
        tick: The step of the loop that it comes from.
        received_s: When it arrived.
        lifetime_s: Time for which it is valid; the plan of the fleet limits it.
        operator: Counts the operators of the drive: another number is another person.
    """

    motion: Motion
    tick: int
    received_s: float
    lifetime_s: float
    operator: int = 0


@dataclass(frozen=True, slots=True)
class RobotInputs:
    """What is known of one robot.

    Attributes:
        links: Its links, by port. A port that is missing here is down.
        samples: Its newest samples, by port.
        setpoint: The newest setpoint of the loop.
        manual: The newest setpoint of the operator.
    """

    links: Mapping[str, Link]
    samples: Mapping[str, Sample]
    setpoint: Setpoint | None
    manual: Setpoint | None = None


@dataclass(frozen=True, slots=True)
class LoopInputs:
    """What is known of the loop.

    Attributes:
        is_alive: Whether its process runs.
        last_message_s: When its newest message arrived; None if none has.
        lateness_s: Time by which its newest step was late.
        recording_error: Why the recording could not be written; empty if it could.
    """

    is_alive: bool
    last_message_s: float | None
    lateness_s: float = 0.0
    recording_error: str = ""


@dataclass(frozen=True, slots=True)
class Inputs:
    """Everything that is known in one turn of the warden.

    Attributes:
        robots: Its robots, by name.
        loop: The loop.
        gap_s: Time between the last two turns of the warden's event loop.
    """

    robots: Mapping[str, RobotInputs]
    loop: LoopInputs
    gap_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Requests:
    """What operators requested since the last turn.

    Attributes:
        stop: Emergency stop of all robots. It wins over all other requests.
        release: Release of the emergency stop. The robots stand until they are armed.
        arm: Names of the robots to arm. A robot that cannot be armed now is not armed later.
        mode: The modes to switch to, by name. A switch stops the robot until it is armed.
        hold: Hold of all robots: they stand, and stay armed. It wins over a resume.
        resume: End of the hold.
        navigate: Whether robots follow their plans in automatic mode, by name.
        confirm: The ports whose doubted values are confirmed by hand, by name of the robot.
    """

    stop: bool = False
    release: bool = False
    arm: frozenset[str] = frozenset()
    mode: Mapping[str, Mode] = field(default_factory=dict)
    hold: bool = False
    resume: bool = False
    navigate: Mapping[str, bool] = field(default_factory=dict)
    confirm: Mapping[str, Collection[str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Unseen:
    """The fastest motion that the inputs of a robot with a confirmed standstill do not exclude.

    Attributes:
        speed_m_s: Its speed.
        turn_rate_rad_s: Its turn rate; None without an input for headings.
    """

    speed_m_s: float
    turn_rate_rad_s: float | None


@dataclass(frozen=True, slots=True)
class Decision:
    """What one robot does, and why. Faults are listed gravest first.

    Attributes:
        action: What it does.
        motion: The motion to command: `STOP` unless the action is `MOVE`.
        faults: The faults that stop it now, and those that have cleared within the last second.
        latched: Why it has to be armed; empty if it is armed.
        is_armed: Whether it moves when it has no fault.
        blockers: Why it cannot be armed now.
        warnings: The faults that do not stop it in its mode.
        unseen: The motion that its inputs do not exclude; None unless they confirm its standstill.
        mode: Its mode.
        navigates: Whether it follows its plan in automatic mode.
        doubted: The ports whose values have to change, or to be confirmed by hand.
    """

    action: Action
    motion: Motion
    faults: tuple[Fault, ...]
    latched: tuple[Fault, ...]
    is_armed: bool
    blockers: tuple[Fault, ...]
    warnings: tuple[Fault, ...]
    unseen: Unseen | None = None
    mode: Mode = Mode.AUTO
    navigates: bool = True
    doubted: tuple[str, ...] = ()

    @property
    def is_confirmed(self) -> bool:
        """Whether its inputs confirm its standstill."""
        return self.unseen is not None


@dataclass(frozen=True, slots=True)
class Outputs:
    """What the rules decide.

    Attributes:
        robots: The decisions for all robots, by name.
        is_held: Whether an operator holds all robots.
    """

    robots: Mapping[str, Decision]
    is_held: bool = False

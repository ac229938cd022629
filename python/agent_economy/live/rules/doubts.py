"""Inputs that are doubted: frozen ones, and those that have jumped and stayed there.

A doubt lasts until the input has changed, or an operator has confirmed its value by hand.
"""

import math
from dataclasses import dataclass, replace

from agent_economy.live.plan import InputPlan, RobotPlan
from agent_economy.live.readings import Quantity
from agent_economy.live.rules.differences import Values, change, has_number, margin, max_rate
from agent_economy.live.rules.faults import (
    CLEAR_S,
    FROZEN,
    FROZEN_LINES,
    FROZEN_S,
    JITTER_S,
    JUMP,
    Fault,
)
from agent_economy.live.rules.interface import Sample

UNITS = {
    Quantity.HEADING: ("degrees", math.degrees(1.0)),
    Quantity.POSITION: ("m", 1.0),
    Quantity.RANGES: ("m", 1.0),
}
"""The unit of changes in reasons, and its number per unit of the readings."""


@dataclass(frozen=True, slots=True)
class Doubts:
    """Why an input is doubted.

    Attributes:
        frozen: The values with which it was found frozen; None if it was not.
        frozen_reason: What was found.
        origin: The sample before a jump; None without one.
        jump_reason: What was found.
        since_s: When the first jump came that has not been cleared.
        broken_s: When the last sample came that does not continue those before it: after a jump,
            or when a frozen input changed.
        was_driven: Whether the robot has been driven since the jump; its values before are no
            evidence then.
    """

    frozen: Values | None = None
    frozen_reason: str = ""
    origin: Sample | None = None
    jump_reason: str = ""
    since_s: float = -math.inf
    broken_s: float = -math.inf
    was_driven: bool = False

    def faults(self) -> tuple[Fault, ...]:
        """Return the faults that they are."""
        jumps = () if self.origin is None else (JUMP.because(self.jump_reason),)
        frozen = () if self.frozen is None else (FROZEN.because(self.frozen_reason),)
        return (*jumps, *frozen)

    def without_times(self) -> "Doubts":
        """Return the doubts after the clock went backwards: only an operator clears a jump."""
        never = -math.inf
        return replace(self, since_s=never, broken_s=never, was_driven=True)


NO_DOUBTS = Doubts()


@dataclass(frozen=True, slots=True)
class CommandedChange:
    """A motion that was commanded while the values of an input were equal.

    Attributes:
        time_s: For how long.
        change: The change that it causes, in the unit of the input.
    """

    time_s: float
    change: float


@dataclass(frozen=True, slots=True)
class Step:
    """A sample of an input that is judged, with what is known of the robot.

    Attributes:
        before: The last possible sample before it.
        sample: The sample.
        plan: The input.
        robot: The robot.
        commanded: The motion commanded since the values before last changed.
        is_driven: Whether the robot is commanded to move.
    """

    before: Sample | None
    sample: Sample
    plan: InputPlan
    robot: RobotPlan
    commanded: CommandedChange
    is_driven: bool

    @property
    def is_equal(self) -> bool:
        """Whether the values are those before."""
        return self.before is not None and self.before.values == self.sample.values

    def explained(self, time_s: float) -> float:
        """Return the change that the fastest motion of a time and the noise explain."""
        rate = max_rate(self.plan, self.robot) or 0.0
        return rate * (max(time_s, 0.0) + JITTER_S) + margin(self.plan)


def after_step(doubts: Doubts, step: Step, equal_lines: int) -> Doubts:
    """Return the doubts about an input after a sample; `equal_lines` counts it."""
    doubts = _after_jump(doubts, step)
    doubts = _if_frozen(doubts, step, equal_lines)
    return _cleared(doubts, step)


def _after_jump(doubts: Doubts, step: Step) -> Doubts:
    """Return the doubts with a jump from the sample before, if it is one.

    An input that was frozen and changes again makes up for what it has missed, which is the motion
    that was commanded meanwhile.
    """
    before, sample, plan = step.before, step.sample, step.plan
    if before is None or max_rate(plan, step.robot) is None:
        return doubts
    limit = step.explained(sample.time_s - before.time_s)
    if doubts.frozen is not None:
        limit += step.commanded.change
    size = change(before.values, sample.values, plan.quantity)
    if size <= limit:
        return doubts
    unit, scale = UNITS[plan.quantity]
    reason = (
        f"{plan.port}: changed by {scale * size:.1f} {unit} at once (limit {scale * limit:.1f} "
        f"{unit}) and is not back: it has to be confirmed by hand"
    )
    doubts = replace(doubts, jump_reason=reason, broken_s=sample.time_s)
    if doubts.origin is not None:
        return doubts
    return replace(doubts, origin=before, since_s=sample.time_s, was_driven=False)


def _if_frozen(doubts: Doubts, step: Step, equal_lines: int) -> Doubts:
    """Return the doubts with a frozen input, if enough motion was commanded without a change."""
    commanded, values = step.commanded, step.sample.values
    is_enough = commanded.time_s >= FROZEN_S and commanded.change > margin(step.plan)
    if not (step.is_equal and is_enough and equal_lines >= FROZEN_LINES and has_number(values)):
        return doubts
    reason = (
        f"{step.plan.port}: no change in {commanded.time_s:.1f} s of commanded motion: it is "
        "frozen, or the robot does not move; it has to change, or to be confirmed by hand"
    )
    return replace(doubts, frozen=values, frozen_reason=reason)


def _cleared(doubts: Doubts, step: Step) -> Doubts:
    """Return the doubts that a sample leaves.

    A frozen input has changed when its values are others. After a jump, they have to be again
    where they were: as near as noise and the way explain that the robot went until it was stopped.
    """
    sample, plan = step.sample, step.plan
    if doubts.frozen is not None and sample.values != doubts.frozen:
        doubts = replace(doubts, frozen=None, frozen_reason="", broken_s=sample.time_s)
    if doubts.origin is None:
        return doubts
    is_late = sample.time_s - doubts.since_s > CLEAR_S
    was_driven = doubts.was_driven or (step.is_driven and is_late)
    limit = step.explained(doubts.since_s - doubts.origin.time_s)
    if not was_driven and change(doubts.origin.values, sample.values, plan.quantity) <= limit:
        return replace(doubts, origin=None, jump_reason="")
    return replace(doubts, was_driven=was_driven)

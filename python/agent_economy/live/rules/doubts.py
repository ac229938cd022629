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

UNITS = {Quantity.HEADING: "degrees", Quantity.POSITION: "m", Quantity.RANGES: "m"}


@dataclass(frozen=True, slots=True)
class Doubts:
    """Why an input is doubted.

    Attributes:
        frozen: The values with which it was found frozen; None if it was not.
        frozen_reason: What was found.
        origin: The values before a jump; None without one.
        jump_reason: What was found.
        jumped_s: When the last sample came that does not continue those before it: after a jump,
            or when a frozen input changed.
        was_driven: Whether the robot has been driven since; its values before are no evidence then.
    """

    frozen: Values | None = None
    frozen_reason: str = ""
    origin: Values | None = None
    jump_reason: str = ""
    jumped_s: float = -math.inf
    was_driven: bool = False

    def faults(self) -> tuple[Fault, ...]:
        """Return the faults that they are."""
        jumps = () if self.origin is None else (JUMP.because(self.jump_reason),)
        frozen = () if self.frozen is None else (FROZEN.because(self.frozen_reason),)
        return (*jumps, *frozen)


NONE = Doubts()


@dataclass(frozen=True, slots=True)
class Commanded:
    """A motion that was commanded while the values of an input were equal.

    Attributes:
        time_s: For how long.
        change: The change that it causes, in the unit of the input.
    """

    time_s: float
    change: float


def dispelled(
    doubts: Doubts, sample: Sample, plan: InputPlan, robot: RobotPlan, *, is_driven: bool
) -> Doubts:
    """Return the doubts that a new sample leaves.

    A frozen input has changed when its values are others. After a jump, they have to be again
    where they were: as near as noise and the way of a robot that has just been stopped explain.
    """
    if doubts.frozen is not None and sample.values != doubts.frozen:
        doubts = replace(doubts, frozen=None, frozen_reason="", jumped_s=sample.time_s)
    if doubts.origin is None:
        return doubts
    was_driven = doubts.was_driven or (is_driven and sample.time_s - doubts.jumped_s > CLEAR_S)
    limit = (max_rate(plan, robot) or 0.0) * JITTER_S + margin(plan)
    if not was_driven and change(doubts.origin, sample.values, plan.quantity) <= limit:
        return replace(doubts, origin=None, jump_reason="")
    return replace(doubts, was_driven=was_driven)


def after_jump(
    doubts: Doubts, before: Sample | None, sample: Sample, plan: InputPlan, robot: RobotPlan
) -> Doubts:
    """Return the doubts with a jump from the sample before, if it is one.

    An input that was frozen and changes again makes up for what it has missed: that is no jump.
    """
    rate = max_rate(plan, robot)
    if before is None or rate is None or doubts.frozen is not None:
        return doubts
    limit = rate * (max(sample.time_s - before.time_s, 0.0) + JITTER_S) + margin(plan)
    size = change(before.values, sample.values, plan.quantity)
    if size <= limit:
        return doubts
    unit = UNITS[plan.quantity]
    reason = (
        f"{plan.port}: changed by {size:.1f} {unit} at once (limit {limit:.1f} {unit}) and is not "
        "back: it has to be confirmed by hand"
    )
    origin = before.values if doubts.origin is None else doubts.origin
    after = replace(doubts, origin=origin, jump_reason=reason, jumped_s=sample.time_s)
    return replace(after, was_driven=doubts.was_driven and doubts.origin is not None)


def if_frozen(
    doubts: Doubts, sample: Sample, equal_lines: int, commanded: Commanded, plan: InputPlan
) -> Doubts:
    """Return the doubts with a frozen input, if enough motion was commanded without a change."""
    is_enough = commanded.time_s >= FROZEN_S and commanded.change > margin(plan)
    if not is_enough or equal_lines < FROZEN_LINES or not has_number(sample.values):
        return doubts
    reason = (
        f"{plan.port}: no change in {commanded.time_s:.1f} s of commanded motion: it is frozen, or "
        "the robot does not move; it has to change, or to be confirmed by hand"
    )
    return replace(doubts, frozen=sample.values, frozen_reason=reason)

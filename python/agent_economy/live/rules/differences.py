"""Differences of two readings of an input, and what noise and motion explain of them."""

import math

from agent_economy.live.plan import InputPlan, RobotPlan
from agent_economy.live.readings import Quantity
from agent_economy.live.rules.faults import NOISE_SIGMAS

Values = tuple[float | None, ...]


def differs(before: Values, after: Values, plan: InputPlan) -> bool:
    """Return whether two readings differ by more than the noise."""
    if plan.quantity is not Quantity.RANGES:
        return change(before, after, plan.quantity) > margin(plan)
    # One sonar may see a person pass.
    changed = [
        abs(new - old) > margin(plan)
        for old, new in zip(before, after, strict=False)
        if old is not None and new is not None and math.isfinite(old) and math.isfinite(new)
    ]
    return sum(changed) >= max(1, min(2, len(after)))


def change(before: Values, after: Values, quantity: Quantity) -> float:
    """Return the distance of two readings, in the unit of their quantity."""
    changes = [(new or 0.0) - (old or 0.0) for old, new in zip(before, after, strict=False)]
    if quantity is Quantity.HEADING:
        return abs((changes[0] + math.pi) % math.tau - math.pi)
    return math.hypot(*changes)


def margin(plan: InputPlan) -> float:
    """Return the difference of two readings that noise alone does not reach."""
    return NOISE_SIGMAS * plan.noise


def max_rate(plan: InputPlan, robot: RobotPlan) -> float | None:
    """Return the fastest change of an input, per second; None where it is not limited."""
    match plan.quantity:
        case Quantity.HEADING:
            return robot.max_turn_rate_rad_s
        case Quantity.POSITION:
            return robot.max_speed_m_s
    return None


def has_number(values: Values) -> bool:
    """Return whether a reading has a finite value."""
    return any(each is not None and math.isfinite(each) for each in values)

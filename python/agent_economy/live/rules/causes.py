"""The causes of faults outside the inputs: each function yields its faults while they are true."""

import math
from collections.abc import Iterable, Iterator, Mapping

from agent_economy.live.legs import is_inside
from agent_economy.live.plan import FleetPlan, InputPlan, Point, RobotPlan
from agent_economy.live.readings import Motion, Quantity
from agent_economy.live.rules.faults import (
    CONTROLS_DEFLECTED,
    EVENT_LOOP_GAP,
    LOOP_DEAD,
    LOOP_LATE,
    LOOP_SILENT,
    LOST_LINK,
    LOW_BATTERY,
    MAX_GAP_S,
    MAX_SILENCE_S,
    MAX_UNACKNOWLEDGED_S,
    NO_SETPOINT,
    NOISE_SIGMAS,
    OUTSIDE_FENCE,
    OUTSIDE_WORLD,
    RECORDING_ERROR,
    TURN_DOES_NOT_END,
    TURN_MARGIN_S,
    Fault,
)
from agent_economy.live.rules.interface import Link, LoopInputs, Setpoint
from agent_economy.live.rules.monitors import age_s

M_PER_KM = 1000.0


def gap(elapsed_s: float, gap_s: float) -> Iterator[Fault]:
    """Yield a fault if the warden itself was suspended or blocked."""
    if not (elapsed_s >= 0.0 and math.isfinite(elapsed_s)):
        yield EVENT_LOOP_GAP.because("the clock went backwards")
    elif not max(elapsed_s, gap_s) <= MAX_GAP_S or math.isnan(gap_s):
        yield EVENT_LOOP_GAP.because(
            f"{max(elapsed_s, gap_s):.2f} s between two turns (limit {MAX_GAP_S} s)"
        )


def loop(plan: FleetPlan, time_s: float, known: LoopInputs) -> Iterator[Fault]:
    """Yield the faults of the loop and of its recording."""
    silent_s = math.inf if known.last_message_s is None else age_s(time_s, known.last_message_s)
    if not known.is_alive:
        yield LOOP_DEAD.because(
            "the process of the loop has ended: nothing stops the robots if the warden ends too"
        )
    if silent_s > MAX_SILENCE_S:
        yield LOOP_SILENT.because(f"no message for {silent_s:.2f} s (limit {MAX_SILENCE_S} s)")
    if not known.lateness_s <= plan.max_lateness_s:
        yield LOOP_LATE.because(f"{known.lateness_s:.2f} s late (limit {plan.max_lateness_s} s)")
    if known.recording_error:
        yield RECORDING_ERROR.because(known.recording_error)


def links(plan: RobotPlan, known: Mapping[str, Link]) -> Iterator[Fault]:
    """Yield a fault for each port that is not connected, or half open."""
    for port in plan.ports:
        link = known.get(port, Link(is_up=False))
        if not link.is_up:
            yield LOST_LINK.because(f"{port}: {link.reason or 'not connected'}")
        elif not link.unacknowledged_s < MAX_UNACKNOWLEDGED_S:
            yield LOST_LINK.because(
                f"{port}: nothing acknowledged for {link.unacknowledged_s:.2f} s"
            )


def fence(plan: RobotPlan, positions_m: Iterable[tuple[float, ...]]) -> Iterator[Fault]:
    """Yield a fault if the robot is outside its fence, or cannot know."""
    if plan.fence_m is None:
        return
    if not any(each.quantity is Quantity.POSITION for each in plan.inputs):
        yield OUTSIDE_FENCE.because("there is a fence, but no input for positions")
    for x_m, y_m in positions_m:
        if not is_inside((x_m, y_m), plan.fence_m):
            yield OUTSIDE_FENCE.because(f"({x_m:.1f}, {y_m:.1f}) m is outside the fence")


def world(
    size_m: Point | None, plan: InputPlan, positions_m: Iterable[tuple[float, ...]]
) -> Iterator[Fault]:
    """Yield a fault if the robot is outside the world by more than the noise of its position."""
    if size_m is None:
        return
    for x_m, y_m in positions_m:
        outside_m = math.hypot(max(-x_m, 0.0, x_m - size_m[0]), max(-y_m, 0.0, y_m - size_m[1]))
        if outside_m > NOISE_SIGMAS * plan.noise:
            origin_m = math.hypot(x_m, y_m)
            yield OUTSIDE_WORLD.because(
                f"{plan.port}: {_distance(outside_m)} outside the world and "
                f"{_distance(origin_m)} from the origin of the scenario: is world.origin right?"
            )


def _distance(distance_m: float) -> str:
    return f"{distance_m:.1f} m" if distance_m < M_PER_KM else f"{distance_m / M_PER_KM:,.0f} km"


def controls(newest: Setpoint | None, *, were_neutral: bool) -> Iterator[Fault]:
    """Yield a fault if controls that have not been neutral yet request a motion."""
    if newest is not None and not newest.motion.is_stop and not were_neutral:
        yield CONTROLS_DEFLECTED.because("the controls are not neutral: release them first")


def battery(plan: RobotPlan, charges: Iterable[tuple[float, ...]]) -> Iterator[Fault]:
    """Yield a fault if the charge is low."""
    for (charge,) in charges:
        if charge < plan.min_battery:
            yield LOW_BATTERY.because(f"{charge:.0%} of charge (limit {plan.min_battery:.0%})")


def setpoint(newest: Setpoint | None, max_lifetime_s: float, time_s: float) -> Iterator[Fault]:
    """Yield the faults of the newest setpoint."""
    if newest is None:
        yield NO_SETPOINT.because("no setpoint yet")
        return
    lifetime_s = min(newest.lifetime_s, max_lifetime_s)
    age = age_s(time_s, newest.received_s)
    if not age <= lifetime_s:
        yield NO_SETPOINT.because(f"{age:.2f} s old (lifetime {lifetime_s} s)")
    if not _is_finite(newest.motion):
        yield NO_SETPOINT.because("a value of the setpoint is not a number")


def _is_finite(motion: Motion) -> bool:
    values = (motion.speed_m_s, motion.turn_rate_rad_s, motion.heading_rad or 0.0)
    return all(math.isfinite(each) for each in values)


def turning(plan: RobotPlan, since_s: float | None, time_s: float) -> Iterator[Fault]:
    """Yield a fault if a turn to a heading does not end."""
    if since_s is None or plan.max_turn_rate_rad_s <= 0.0:
        return
    limit_s = 2 * math.pi / plan.max_turn_rate_rad_s + TURN_MARGIN_S
    if time_s - since_s > limit_s:
        yield TURN_DOES_NOT_END.because(f"no end after {limit_s:.1f} s")

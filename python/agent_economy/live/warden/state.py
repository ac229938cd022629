"""What the warden knows, as pages show it: never more than is known."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any, cast

from agent_economy._core import LocalFrame
from agent_economy.live.frame import FULL_TURN_DEG, bearing_deg, place_deg
from agent_economy.live.plan import InputPlan
from agent_economy.live.readings import Motion, Quantity
from agent_economy.live.rules import Decision, Fault, Mode, Setpoint
from agent_economy.live.rules.faults import MANUAL_LIFETIME_S, MAX_UNACKNOWLEDGED_S
from agent_economy.live.warden.port_link import PortLink
from agent_economy.live.warden.robot import Robot
from agent_economy.live.warden.sentences import reason_of
from agent_economy.types.warden import (
    Battery,
    FaultView,
    Heading,
    LinkState,
    Position,
    Ranges,
    RequestedMotion,
    WardenLink,
    WardenRobot,
    Waypoint,
    WrittenLine,
)


def robot_state(
    robot: Robot,
    decision: Decision,
    goals: Iterable[Mapping[str, Any]],
    frame: LocalFrame,
    now_s: float,
) -> WardenRobot:
    """Return what is known of one robot."""
    return {
        "name": robot.plan.name,
        "driver": robot.plan.driver,
        "mode": cast("Any", decision.mode.value),
        "is_armed": decision.is_armed,
        "action": cast("Any", decision.action.name.lower()),
        "requested": _requested(robot, decision.mode, now_s),
        "written": _written(robot, now_s),
        "is_standing": decision.is_confirmed,
        "unseen": None if decision.unseen is None else cast("Any", asdict(decision.unseen)),
        "doubted": list(decision.doubted),
        "faults": _reasons(decision.faults),
        "latched": _reasons(decision.latched),
        "blockers": _reasons(decision.blockers),
        "warnings": _reasons(decision.warnings),
        "links": [_link(robot, port, link, now_s) for port, link in robot.links.items()],
        "position": _position(robot, frame, now_s),
        "heading": _heading(robot, frame, now_s),
        "ranges": _ranges(robot, now_s),
        "battery": _battery(robot),
        "waypoints": [_waypoint(goal, frame) for goal in goals],
        "navigates": decision.navigates,
    }


def _requested(robot: Robot, mode: Mode, now_s: float) -> RequestedMotion | None:
    """Return the motion that is requested now; None if the newest request has expired."""
    setpoint = robot.manual if mode is Mode.MANUAL else robot.setpoint
    if setpoint is None or now_s - setpoint.received_s > _lifetime_s(setpoint, mode):
        return None
    return _motion(setpoint.motion)


def _lifetime_s(setpoint: Setpoint, mode: Mode) -> float:
    return MANUAL_LIFETIME_S if mode is Mode.MANUAL else setpoint.lifetime_s


def _motion(motion: Motion) -> RequestedMotion:
    return {
        "speed_m_s": _finite(motion.speed_m_s),
        "turn_rate_rad_s": _finite(motion.turn_rate_rad_s),
        "heading_rad": _finite(motion.heading_rad),
    }


def _written(robot: Robot, now_s: float) -> WrittenLine | None:
    if robot.written is None:
        return None
    line, at_s = robot.written
    return {"line": line, "age_s": now_s - at_s, "is_acknowledged": robot.is_acknowledged()}


def _reasons(faults: Iterable[Fault]) -> list[FaultView]:
    return [{"name": fault.name, "reason": fault.reason} for fault in faults]


def _link(robot: Robot, port: str, link: PortLink, now_s: float) -> WardenLink:
    connection = link.connection
    waiting_s = connection.unacknowledged_s(now_s)
    state: LinkState = "connected"
    reason = ""
    if not connection.is_up:
        state, reason = ("lost" if link.has_connected else "connecting"), connection.reason
    elif waiting_s >= MAX_UNACKNOWLEDGED_S:
        state, reason = "lost", f"nothing acknowledged for {waiting_s:.1f} s"
    read = robot.readings.get(port)
    limits = [each.max_age_s for each in robot.plan.inputs if each.port == port]
    return {
        "port": port,
        "state": state,
        "age_s": None if read is None else now_s - read[1],
        "max_age_s": limits[0] if limits else None,
        "reason": reason,
    }


def _position(robot: Robot, frame: LocalFrame, now_s: float) -> Position | None:
    plan, values, age_s = _read(robot, Quantity.POSITION, now_s)
    if plan is None or not all(map(_is_number, values)):
        return None
    x_m, y_m = values
    latitude_deg, longitude_deg = place_deg(frame, x_m, y_m) or (None, None)
    return {
        "port": plan.port,
        "x_m": x_m,
        "y_m": y_m,
        "latitude_deg": latitude_deg,
        "longitude_deg": longitude_deg,
        "uncertainty_m": plan.noise,
        "age_s": age_s,
    }


def _heading(robot: Robot, frame: LocalFrame, now_s: float) -> Heading | None:
    plan, values, age_s = _read(robot, Quantity.HEADING, now_s)
    if plan is None or not all(map(_is_number, values)):
        return None
    return {
        "port": plan.port,
        "magnetic_deg": bearing_deg(frame, values[0]),
        "world_deg": math.degrees(values[0]) % FULL_TURN_DEG,
        "age_s": age_s,
    }


def _ranges(robot: Robot, now_s: float) -> Ranges | None:
    plan, values, age_s = _read(robot, Quantity.RANGES, now_s)
    if plan is None:
        return None
    is_known = [each is not None and not math.isnan(each) for each in values]
    values_m = [_finite(each) for each in values]
    return {"port": plan.port, "values_m": values_m, "is_known": is_known, "age_s": age_s}


def _read(
    robot: Robot, quantity: Quantity, now_s: float
) -> tuple[InputPlan | None, tuple[Any, ...], float]:
    """Return the input of a quantity, its newest values and their age; None without values."""
    for plan in robot.plan.inputs:
        if plan.quantity is quantity and plan.port in robot.readings:
            reading, at_s = robot.readings[plan.port]
            return plan, reading.values, now_s - at_s
    return None, (), math.inf


def _battery(robot: Robot) -> Battery | None:
    plan, values, _ = _read(robot, Quantity.BATTERY, 0.0)
    if plan is not None and all(map(_is_number, values)):
        return {"share": values[0], "is_estimated": False}
    settings = robot.plan.settings
    used = robot.driver.used_charge(robot.standing_s, robot.driving_s, settings)
    return None if used is None else {"share": 1.0 - used, "is_estimated": True}


def _waypoint(goal: Mapping[str, Any], frame: LocalFrame) -> Waypoint:
    x_m, y_m = goal["at_m"]
    latitude_deg, longitude_deg = place_deg(frame, x_m, y_m) or (None, None)
    return {
        "goal": goal["goal"],
        "x_m": x_m,
        "y_m": y_m,
        "latitude_deg": latitude_deg,
        "longitude_deg": longitude_deg,
        "verdict": goal["verdict"],
        "served_by": goal["served_by"],
        "reason": reason_of(goal["unserved"]) if goal.get("unserved") else None,
    }


def _is_number(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _finite(value: float | None) -> Any:  # of setpoints, all are
    """Return a number that JSON has; None for others."""
    return value if value is not None and math.isfinite(value) else None

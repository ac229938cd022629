"""Decides what each robot does: a pure function of the time, what is known and what is requested.

One update collects the faults of a robot, applies the requests of operators, and lets the gravest
action win. What the faults are and do is in `faults`; how inputs are judged is in `inputs`.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from agent_economy.live.plan import FleetPlan, RobotPlan
from agent_economy.live.readings import STOP, Motion, Quantity
from agent_economy.live.rules import causes
from agent_economy.live.rules.faults import (
    CLEAR_S,
    CONTROLS_DEFLECTED,
    EMERGENCY_STOP,
    HELD,
    LONG_STOP,
    LONG_STOP_S,
    MANUAL_LIFETIME_S,
    MAX_GAP_S,
    MODE_CHANGED,
    NOT_ARMED,
    SLOW,
    TURN_GAP_S,
    Fault,
    InManual,
    gravest_first,
)
from agent_economy.live.rules.inputs import judged, outside_world, unseen, values
from agent_economy.live.rules.interface import (
    Action,
    Decision,
    Inputs,
    Mode,
    Outputs,
    Requests,
    RobotInputs,
    Setpoint,
)
from agent_economy.live.rules.memory import Held, Memory, RobotMemory
from agent_economy.live.rules.monitors import Conditions

_UNKNOWN = RobotInputs({}, {}, None)
_PATIENT = (HELD, CONTROLS_DEFLECTED)
"""Faults after which a robot need not be armed, however long they last."""


@dataclass(frozen=True, slots=True)
class _Turn:
    """What is the same for all robots in one update."""

    plan: FleetPlan
    time_s: float
    elapsed_s: float
    requests: Requests
    faults: tuple[Fault, ...]
    is_held: bool


def initial(plan: FleetPlan) -> Memory:
    """Return the memory before the first update: no robot is armed."""
    return Memory(None, {robot.name: RobotMemory() for robot in plan.robots})


def update(
    memory: Memory, plan: FleetPlan, time_s: float, inputs: Inputs, requests: Requests
) -> tuple[Memory, Outputs]:
    """Return what each robot of a fleet does now, and the memory for the next update.

    It raises nothing, whatever the inputs are; what makes no sense stops the robots.
    """
    turn = _turn(memory, plan, time_s, inputs, requests)
    decided = {}
    for robot in plan.robots:
        before = memory.robots.get(robot.name, RobotMemory())
        if memory.time_s is not None and turn.time_s < memory.time_s:
            before = _rewound(before, turn.time_s)
        known = inputs.robots.get(robot.name, _UNKNOWN)
        decided[robot.name] = _decide(before, robot, known, turn)
    robots = {name: each for name, (each, _) in decided.items()}
    after = Memory(turn.time_s, robots, turn.is_held)
    outputs = {name: decision for name, (_, decision) in decided.items()}
    return after, Outputs(outputs, turn.is_held)


def _turn(
    memory: Memory, plan: FleetPlan, time_s: float, inputs: Inputs, requests: Requests
) -> _Turn:
    before_s = memory.time_s
    elapsed_s = 0.0 if before_s is None else time_s - before_s
    faults = (*causes.gap(elapsed_s, inputs.gap_s), *causes.loop(plan, time_s, inputs.loop))
    if not math.isfinite(time_s):
        time_s = before_s or 0.0
    elapsed_s = min(max(elapsed_s, 0.0), MAX_GAP_S) if math.isfinite(elapsed_s) else 0.0
    is_held = requests.hold or (memory.is_held and not requests.resume)
    return _Turn(plan, time_s, elapsed_s, requests, faults, is_held)


def _rewound(memory: RobotMemory, time_s: float) -> RobotMemory:
    """Return the memory without times, after the clock went backwards. Doubts remain."""
    held = {name: Held(each.fault, time_s) for name, each in memory.held.items()}
    inputs = {port: each.without_times() for port, each in memory.inputs.items()}
    return RobotMemory(memory.mode, memory.navigates, memory.latched, held, inputs)


# The rules of one robot.


def _decide(
    memory: RobotMemory, plan: RobotPlan, inputs: RobotInputs, turn: _Turn
) -> tuple[RobotMemory, Decision]:
    memory, requested = _after_requests(memory, plan.name, turn.requests)
    memory, found = judged(memory, inputs.samples, _conditions(memory, plan, turn))
    is_manual = memory.mode is Mode.MANUAL
    setpoint = inputs.manual if is_manual else inputs.setpoint
    were_neutral = not is_manual or (
        setpoint is not None and setpoint.operator == memory.neutral_of
    )
    lifetime_s = MANUAL_LIFETIME_S if is_manual else turn.plan.setpoint_lifetime_s
    expired = tuple(causes.setpoint(setpoint, lifetime_s, turn.time_s))
    now = gravest_first(
        (
            *requested,
            *found,
            *turn.faults,
            *causes.links(plan, inputs.links),
            *causes.fence(plan, values(memory, plan, Quantity.POSITION)),
            *outside_world(memory, plan, turn.plan.size_m, turn.time_s),
            *causes.battery(plan, values(memory, plan, Quantity.BATTERY)),
            *(expired or causes.controls(setpoint, were_neutral=were_neutral)),
            *_hold_of(memory, turn),
            *causes.turning(plan, memory.turning_since_s, turn.time_s),
        )
    )
    is_arming = plan.name in turn.requests.arm
    memory, faults, warnings = _after_faults(memory, now, turn, is_arming=is_arming)
    action = _action(memory, faults)
    motion = STOP
    if action is Action.MOVE and setpoint is not None:
        motion = _limited(setpoint.motion, plan, is_slow=_is_slow(warnings))
    memory = _after_motion(memory, action, motion, turn.time_s)
    memory = replace(
        memory,
        blocked_since_s=_blocked_since_s(memory, faults, turn.time_s),
        neutral_of=_neutral_of(memory, faults, setpoint),
    )
    decision = Decision(
        action=action,
        motion=motion,
        faults=faults,
        latched=memory.latched,
        is_armed=not memory.latched,
        blockers=_blockers(faults, warnings),
        warnings=warnings,
        unseen=unseen(memory, plan, turn.time_s),
        mode=memory.mode,
        navigates=memory.navigates,
        doubted=tuple(port for port, each in memory.inputs.items() if each.doubts.faults()),
    )
    return memory, decision


def _conditions(memory: RobotMemory, plan: RobotPlan, turn: _Turn) -> Conditions:
    commanded = memory.commanded
    if not memory.motion.is_stop:
        commanded = commanded.after(memory.motion, turn.elapsed_s)
    return Conditions(
        robot=plan,
        time_s=turn.time_s,
        commanded=commanded,
        is_stopped=memory.action is not Action.MOVE,
        stopped_since_s=memory.stopped_since_s,
        confirmed=turn.requests.confirm.get(plan.name, ()),
    )


def _blocked_since_s(memory: RobotMemory, faults: tuple[Fault, ...], time_s: float) -> float | None:
    is_blocked = bool(memory.latched) or any(each not in _PATIENT for each in faults)
    return _since(memory.blocked_since_s, time_s, is_true=is_blocked)


def _neutral_of(
    memory: RobotMemory, faults: tuple[Fault, ...], setpoint: Setpoint | None
) -> int | None:
    """Return the operator whose controls are or have been neutral while the robot could move."""
    can_move = not memory.latched and all(each == CONTROLS_DEFLECTED for each in faults)
    if memory.mode is not Mode.MANUAL or not can_move or setpoint is None:
        return None
    is_known = setpoint.motion.is_stop or setpoint.operator == memory.neutral_of
    return setpoint.operator if is_known else None


def _blockers(faults: tuple[Fault, ...], warnings: tuple[Fault, ...]) -> tuple[Fault, ...]:
    """Return why a robot cannot be armed, gravest first."""
    others = (each for each in warnings if each.in_manual is InManual.SLOW_NOT_ARMED)
    return gravest_first((*faults, *others))


def _hold_of(memory: RobotMemory, turn: _Turn) -> Iterator[Fault]:
    if turn.is_held:
        yield HELD.because("all robots are held: not resumed")
    if memory.mode is Mode.AUTO and not memory.navigates:
        yield HELD.because("its navigation is switched off")


def _after_requests(
    memory: RobotMemory, name: str, requests: Requests
) -> tuple[RobotMemory, tuple[Fault, ...]]:
    """Return the memory after stop, release and a switch of modes, and the faults they are.

    Arming comes after the faults. Because a fault stays active for `CLEAR_S`, a robot cannot be
    armed together with a release or a switch.
    """
    latched, requested = memory.latched, []
    if requests.stop:
        latched = _with(latched, EMERGENCY_STOP.because("emergency stop"))
    elif requests.release and EMERGENCY_STOP in latched:
        rest = tuple(each for each in latched if each != EMERGENCY_STOP)
        latched = _with(rest, NOT_ARMED.because("the emergency stop was released"))
    if EMERGENCY_STOP in latched:
        requested.append(EMERGENCY_STOP.because("emergency stop: not released"))
    mode = requests.mode.get(name, memory.mode)
    if mode != memory.mode and mode in tuple(Mode):
        requested.append(MODE_CHANGED.because(f"switched to {Mode(mode)} mode"))
        memory = replace(memory, mode=Mode(mode))
    navigates = bool(requests.navigate.get(name, memory.navigates))
    if latched is not memory.latched or navigates != memory.navigates:
        memory = replace(memory, latched=latched, navigates=navigates)
    return memory, tuple(requested)


def _after_faults(
    memory: RobotMemory, now: tuple[Fault, ...], turn: _Turn, *, is_arming: bool
) -> tuple[RobotMemory, tuple[Fault, ...], tuple[Fault, ...]]:
    """Return the memory with what is latched, the faults that stop the robot, and the others."""
    if memory.held or now:
        memory = replace(memory, held=_hold(memory.held, now, turn.time_s))
    active = gravest_first(each.fault for each in memory.held.values())
    faults = tuple(each for each in active if _stops(each, memory.mode))
    warnings = tuple(each for each in active if not _stops(each, memory.mode))
    latched = memory.latched
    for fault in now:
        if fault.latches and _stops(fault, memory.mode):
            latched = _with(latched, fault)
    if is_arming and not _blockers(faults, warnings):
        latched = ()
    since_s = memory.blocked_since_s
    is_long = since_s is not None and turn.time_s - since_s > LONG_STOP_S
    if is_long and faults and not latched:
        names = ", ".join(each.name for each in faults)
        reason = f"stopped for more than {LONG_STOP_S:g} s: {names}"
        latched = (LONG_STOP.because(reason),)
    if latched is not memory.latched:
        memory = replace(memory, latched=latched)
    return memory, faults, warnings


def _action(memory: RobotMemory, faults: tuple[Fault, ...]) -> Action:
    return max(
        Action.LATCHED_STOP if memory.latched else Action.MOVE,
        Action.STOP if faults else Action.MOVE,
    )


def _after_motion(
    memory: RobotMemory, action: Action, motion: Motion, time_s: float
) -> RobotMemory:
    turned_s = memory.turned_s if motion.heading_rad is None else time_s
    is_turning = time_s - turned_s < TURN_GAP_S
    return replace(
        memory,
        action=action,
        motion=motion,
        stopped_since_s=_since(memory.stopped_since_s, time_s, is_true=motion.is_stop),
        turning_since_s=_since(memory.turning_since_s, time_s, is_true=is_turning),
        turned_s=turned_s,
    )


def _since(before_s: float | None, time_s: float, *, is_true: bool) -> float | None:
    if not is_true:
        return None
    return time_s if before_s is None else before_s


def _hold(before: Mapping[str, Held], now: Iterable[Fault], time_s: float) -> Mapping[str, Held]:
    held = {}
    for name, each in before.items():
        ended_s = time_s if each.ended_s is None else each.ended_s
        if time_s - ended_s < CLEAR_S:
            held[name] = Held(each.fault, ended_s)
    return held | {fault.name: Held(fault) for fault in now}


def _stops(fault: Fault, mode: Mode) -> bool:
    return mode is Mode.AUTO or fault.in_manual is InManual.STOP


def _is_slow(warnings: Iterable[Fault]) -> bool:
    return any(each.in_manual in SLOW for each in warnings)


def _with(latched: tuple[Fault, ...], fault: Fault) -> tuple[Fault, ...]:
    """Return the latched faults with one more. The first reason of a fault remains."""
    return latched if fault in latched else gravest_first((*latched, fault))


def _limited(motion: Motion, plan: RobotPlan, *, is_slow: bool) -> Motion:
    # Values of tracks that are not slowed down go to the motors as they were requested.
    max_m_s = min(plan.max_speed_m_s, plan.manual_speed_m_s) if is_slow else plan.max_speed_m_s
    return Motion(
        _clamped(motion.speed_m_s, max_m_s),
        _clamped(motion.turn_rate_rad_s, plan.max_turn_rate_rad_s),
        motion.heading_rad,
        None if is_slow else motion.tracks,
    )


def _clamped(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))

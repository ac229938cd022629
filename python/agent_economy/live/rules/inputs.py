"""Judges all inputs of one robot: see `monitors` for one of them."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from agent_economy.live.plan import InputPlan, Point, RobotPlan
from agent_economy.live.readings import Quantity
from agent_economy.live.rules import causes
from agent_economy.live.rules.faults import (
    MOVES_WHILE_STOPPED,
    OUTSIDE_FENCE,
    OUTSIDE_WORLD,
    SLOW,
    Fault,
)
from agent_economy.live.rules.interface import Sample, Unseen
from agent_economy.live.rules.memory import RobotMemory
from agent_economy.live.rules.monitors import Conditions, InputMemory, age_s, judge

_PLACES = (OUTSIDE_FENCE, OUTSIDE_WORLD)
"""Faults of what an input states, not of the input."""


def judged(
    memory: RobotMemory, samples: Mapping[str, Sample], now: Conditions
) -> tuple[RobotMemory, tuple[Fault, ...]]:
    """Return the memory after the newest samples of a robot, and the faults that they show."""
    plan = now.robot
    found = {
        each.port: judge(
            memory.inputs.get(each.port, InputMemory()), samples.get(each.port), each, now
        )
        for each in plan.inputs
    }
    moved = [port for port, each in found.items() if each.has_moved]
    faults = [fault for each in found.values() for fault in each.faults]
    if moved:
        faults.append(MOVES_WHILE_STOPPED.because(f"{', '.join(moved)}: changed after stop"))
    memories = {port: each.memory for port, each in found.items()}
    return replace(memory, inputs=memories, commanded=now.commanded), tuple(faults)


def unseen(memory: RobotMemory, plan: RobotPlan, time_s: float) -> Unseen | None:
    """Return the motion that the inputs of a robot do not exclude; None if it may move faster.

    Without positions nothing excludes that it drives straight on in open ground.
    """
    inputs = [each for each in plan.inputs if each.quantity is not Quantity.BATTERY]
    is_known = not any(
        each.fault.in_manual in SLOW and each.fault not in _PLACES for each in memory.held.values()
    )
    is_still = all(memory.inputs[each.port].is_still(time_s, each.quantity) for each in inputs)
    if not (memory.motion.is_stop and is_known and is_still):
        return None
    speed_m_s = _slowest(memory, inputs, Quantity.POSITION, time_s)
    if speed_m_s is None or speed_m_s >= plan.max_speed_m_s:
        return None
    return Unseen(speed_m_s, _slowest(memory, inputs, Quantity.HEADING, time_s))


def _slowest(
    memory: RobotMemory, inputs: Iterable[InputPlan], quantity: Quantity, time_s: float
) -> float | None:
    """Return the unseen rate of the best input of a quantity."""
    found = (memory.inputs[each.port].standstill for each in inputs if each.quantity is quantity)
    rates = (each.unseen_at(time_s) for each in found)
    return min((rate for rate in rates if rate is not None), default=None)


def values(memory: RobotMemory, plan: RobotPlan, quantity: Quantity) -> Iterator[tuple[float, ...]]:
    """Yield the newest possible values of the inputs of a quantity."""
    for each in plan.inputs:
        sample = memory.inputs[each.port].possible
        if each.quantity is quantity and sample is not None:
            yield _numbers(sample)


def _numbers(sample: Sample) -> tuple[float, ...]:
    return tuple(value for value in sample.values if value is not None)


def outside_world(
    memory: RobotMemory, plan: RobotPlan, size_m: Point | None, time_s: float
) -> Iterator[Fault]:
    """Yield a fault for each input that places a robot outside the world, and is not stale."""
    for each in plan.inputs:
        sample = memory.inputs[each.port].possible
        if each.quantity is not Quantity.POSITION or sample is None:
            continue
        if age_s(time_s, sample.time_s) <= each.max_age_s:
            yield from causes.world(size_m, each, [_numbers(sample)])

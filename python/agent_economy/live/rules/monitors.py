"""Judges one input of a robot: whether it is fresh and possible, and whether the robot moves.

Each monitor looks at the newest sample and remembers what it needs of earlier ones.
"""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from itertools import zip_longest

from agent_economy.live.plan import InputPlan, RobotPlan
from agent_economy.live.readings import COUNTS, Motion, Quantity
from agent_economy.live.rules.differences import Values, differs
from agent_economy.live.rules.doubts import (
    NO_DOUBTS,
    CommandedChange,
    Doubts,
    Step,
    after_step,
)
from agent_economy.live.rules.faults import (
    IMPOSSIBLE_VALUE,
    MISSING_INPUT,
    SETTLING_S,
    STALE_INPUT,
    STILL_S,
    Fault,
)
from agent_economy.live.rules.interface import Sample
from agent_economy.live.rules.standstill import NO_STANDSTILL, Standstill, observed

MAX_AHEAD_S = 0.1
"""A stamp may be this much ahead of the time of the update."""

_BOUNDS = {
    Quantity.RANGES: (0.0, math.inf),
    Quantity.BATTERY: (0.0, 1.0),
}


@dataclass(frozen=True, slots=True)
class Commanded:
    """The motion that has been commanded since the start.

    Attributes:
        turning_s: Time of turning.
        turned_rad: Sum of all turns, in either direction.
        driving_s: Time of driving.
        driven_m: Sum of all ways, forward and in reverse.
    """

    turning_s: float = 0.0
    turned_rad: float = 0.0
    driving_s: float = 0.0
    driven_m: float = 0.0

    def after(self, motion: Motion, elapsed_s: float) -> "Commanded":
        """Return the motion with one more; turns that the robot makes by itself do not count."""
        turn_rate, speed = abs(motion.turn_rate_rad_s), abs(motion.speed_m_s)
        return Commanded(
            self.turning_s + (elapsed_s if turn_rate else 0.0),
            self.turned_rad + turn_rate * elapsed_s,
            self.driving_s + (elapsed_s if speed else 0.0),
            self.driven_m + speed * elapsed_s,
        )


NOTHING_COMMANDED = Commanded()


@dataclass(frozen=True, slots=True)
class Conditions:
    """The conditions under which the inputs of a robot are judged.

    Attributes:
        robot: The robot.
        time_s: The time.
        commanded: The motion commanded until now.
        is_stopped: Whether the rules have stopped the robot.
        stopped_since_s: Since when stop has been commanded; None while the robot moves.
        confirmed: The ports whose values an operator confirms by hand.
    """

    robot: RobotPlan
    time_s: float
    commanded: Commanded
    is_stopped: bool
    stopped_since_s: float | None
    confirmed: Collection[str] = ()


@dataclass(frozen=True, slots=True)
class InputMemory:
    """What is remembered of one input.

    Attributes:
        newest: The newest sample.
        possible: The newest sample of possible values.
        value_times_s: When each value last came; None if it never has.
        equal_lines: Number of lines since the values last changed.
        commanded: The motion commanded until then.
        reference: The sample that a standing robot must not differ from.
        still_since_s: Since when the input shows no motion.
        doubts: Why it is doubted.
        standstill: What the samples since the robot was stopped show of slow motion.
    """

    newest: Sample | None = None
    possible: Sample | None = None
    value_times_s: tuple[float | None, ...] = ()
    equal_lines: int = 0
    commanded: Commanded = NOTHING_COMMANDED
    reference: Sample | None = None
    still_since_s: float | None = None
    doubts: Doubts = NO_DOUBTS
    standstill: Standstill = NO_STANDSTILL

    def without_times(self) -> "InputMemory":
        """Return what remains of it after the clock went backwards."""
        return InputMemory(doubts=self.doubts.without_times())

    def is_still(self, time_s: float, quantity: Quantity) -> bool:
        """Return whether it has shown no motion: for `STILL_S`, slow ones for longer."""
        has_slope = quantity in (Quantity.POSITION, Quantity.HEADING)
        if has_slope and self.standstill.unseen is None:
            return False
        return self.still_since_s is not None and time_s - self.still_since_s >= STILL_S


@dataclass(frozen=True, slots=True)
class Judgement:
    """What an input shows.

    Attributes:
        memory: What to remember of it.
        faults: Its faults.
        has_moved: Whether it shows that the robot moves, although stop has been commanded.
    """

    memory: InputMemory
    faults: tuple[Fault, ...]
    has_moved: bool


def judge(
    memory: InputMemory, sample: Sample | None, plan: InputPlan, now: Conditions
) -> Judgement:
    """Return what the newest sample of an input shows; None if there is none."""
    memory = _restarted(memory, now)
    if plan.port in now.confirmed:
        # What has been commanded until now is no evidence any more.
        memory = replace(memory, doubts=NO_DOUBTS, equal_lines=0, commanded=now.commanded)
    has_moved = False
    if sample is not None and _is_new(sample, memory):
        if _impossible(sample.values, plan):
            times = _value_times_s(memory, sample)
            memory = replace(memory, newest=sample, value_times_s=times)
        else:
            before, memory = memory, _after(memory, sample, plan, now)
            has_moved = not _is_break(memory, sample) and (
                _moves_while_stopped(before, sample, plan, now) or memory.standstill.moves
            )
    faults = [*memory.doubts.faults(), *_freshness(memory, plan, now.time_s)]
    if memory.newest is not memory.possible and memory.newest is not None:
        faults.append(IMPOSSIBLE_VALUE.because(f"{plan.port}: {memory.newest.values}"))
    return Judgement(memory, tuple(faults), has_moved)


def age_s(time_s: float, stamp_s: float) -> float:
    """Return the age of a stamp; infinite if it is not a number or far in the future."""
    age = time_s - stamp_s
    return max(age, 0.0) if age >= -MAX_AHEAD_S else math.inf


def _is_new(sample: Sample, memory: InputMemory) -> bool:
    is_known = memory.newest is not None and sample.time_s == memory.newest.time_s
    return math.isfinite(sample.time_s) and not is_known


def _value_times_s(memory: InputMemory, sample: Sample) -> tuple[float | None, ...]:
    pairs = zip_longest(sample.values, memory.value_times_s)
    return tuple(before if value is None else sample.time_s for value, before in pairs)


def _after(memory: InputMemory, sample: Sample, plan: InputPlan, now: Conditions) -> InputMemory:
    """Return the memory after a possible sample."""
    is_equal = memory.possible is not None and memory.possible.values == sample.values
    doubts = _doubts(memory, sample, plan, now)
    reference, still_since_s = _reference(memory, sample, plan, now)
    after = InputMemory(
        newest=sample,
        possible=sample,
        value_times_s=_value_times_s(memory, sample),
        equal_lines=memory.equal_lines + 1 if is_equal else 1,
        commanded=memory.commanded if is_equal else now.commanded,
        reference=reference,
        still_since_s=still_since_s,
        doubts=doubts,
        standstill=memory.standstill,
    )
    return replace(after, standstill=_standstill(after, sample, plan, now))


# Freshness. Ranges are judged one by one: a sonar that was there once must not disappear.


def _freshness(memory: InputMemory, plan: InputPlan, time_s: float) -> Iterator[Fault]:
    times = [each for each in memory.value_times_s if each is not None]
    if not times:
        yield MISSING_INPUT.because(f"{plan.port}: no line yet")
        return
    oldest_s = age_s(time_s, min(times))
    if oldest_s > plan.max_age_s:
        yield STALE_INPUT.because(f"{plan.port}: {oldest_s:.2f} s old (limit {plan.max_age_s} s)")


# Impossible values.


def _impossible(values: Values, plan: InputPlan) -> bool:
    if plan.quantity is Quantity.RANGES:
        return not all(each is None or _is_possible(each, plan) for each in values)
    if len(values) != COUNTS[plan.quantity]:
        return True
    return not all(each is not None and _is_possible(each, plan) for each in values)


def _is_possible(value: float, plan: InputPlan) -> bool:
    if plan.quantity is Quantity.RANGES and value == math.inf:
        return True
    low, high = plan.bounds or _BOUNDS.get(plan.quantity, (-math.inf, math.inf))
    return math.isfinite(value) and low <= value <= high


# What a possible sample shows, compared with earlier ones.


def _doubts(memory: InputMemory, sample: Sample, plan: InputPlan, now: Conditions) -> Doubts:
    """Return the doubts about an input after a possible sample."""
    step = Step(
        before=memory.possible,
        sample=sample,
        plan=plan,
        robot=now.robot,
        commanded=_commanded_change(plan, memory.commanded, now.commanded),
        is_driven=now.stopped_since_s is None,
    )
    return after_step(memory.doubts, step, memory.equal_lines + 1)


def _is_break(memory: InputMemory, sample: Sample) -> bool:
    return memory.doubts.broken_s == sample.time_s


def _restarted(memory: InputMemory, now: Conditions) -> InputMemory:
    """Return the memory without equal lines while the robot is stopped by the rules.

    Of a frozen input, the motion that was commanded until it froze is kept: it explains a change.
    """
    if not now.is_stopped or memory.doubts.frozen is not None:
        return memory
    if memory.equal_lines == 0 and memory.commanded is now.commanded:
        return memory
    return replace(memory, equal_lines=0, commanded=now.commanded)


def _commanded_change(plan: InputPlan, before: Commanded, after: Commanded) -> CommandedChange:
    """Return the time for which a change of an input was commanded, and the change.

    Headings may be constant while the robot drives, and positions while it turns.
    """
    match plan.quantity:
        case Quantity.HEADING:
            time_s, change = (
                after.turning_s - before.turning_s,
                after.turned_rad - before.turned_rad,
            )
        case Quantity.POSITION | Quantity.RANGES:
            time_s, change = after.driving_s - before.driving_s, after.driven_m - before.driven_m
        case _:
            return CommandedChange(0.0, 0.0)
    return CommandedChange(time_s, change)


# Standstill.


def _moves_while_stopped(
    memory: InputMemory, sample: Sample, plan: InputPlan, now: Conditions
) -> bool:
    reference, settled_s = memory.reference, _settled_s(now)
    if reference is None or settled_s is None or reference.time_s < settled_s:
        return False
    return differs(reference.values, sample.values, plan)


def _standstill(
    memory: InputMemory, sample: Sample, plan: InputPlan, now: Conditions
) -> Standstill:
    """Return what the samples since the robot has settled show of slow motion."""
    settled_s = _settled_s(now)
    if settled_s is None or sample.time_s < settled_s or _is_break(memory, sample):
        return NO_STANDSTILL
    return observed(memory.standstill, sample, plan)


def _reference(
    memory: InputMemory, sample: Sample, plan: InputPlan, now: Conditions
) -> tuple[Sample | None, float | None]:
    """Return the sample to compare with, and since when the input is still.

    The sample is taken when the robot has stopped, and again when it has settled. It is replaced
    when the input differs, and every `STILL_S`, because positions drift slowly.
    """
    settled_s, before = _settled_s(now), memory.reference
    if settled_s is None:
        return None, None
    if before is None or differs(before.values, sample.values, plan):
        return sample, sample.time_s
    is_settled = before.time_s < settled_s <= sample.time_s
    is_old = sample.time_s - before.time_s >= STILL_S
    return sample if is_settled or is_old else before, memory.still_since_s


def _settled_s(now: Conditions) -> float | None:
    return None if now.stopped_since_s is None else now.stopped_since_s + SETTLING_S

"""The results of each configuration of a study of a requirement."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from agent_economy.scenario import Requirement, Value
from agent_economy.study.answer.clearance import Clearance, clearance
from agent_economy.study.answer.evidence import Evidence, Interval, Sample
from agent_economy.study.answer.goal_time import GoalTime, goal_time
from agent_economy.study.answer.labels import label
from agent_economy.study.answer.quantiles import Quantiles, quantiles_of
from agent_economy.study.plan import Plan
from agent_economy.study.selection import Elimination
from agent_economy.study.teams import rounded

Status = Literal["selected", "certified", "refuted", "open", "not needed", "impossible"]


@dataclass(frozen=True)
class RequirementEnding:
    """The end of a study of a requirement.

    Attributes:
        selected: Index of the cheapest certified configuration; None if none is certified.
        certified: The certified configurations.
        eliminations: The refuted configurations, in the order of their refutation.
        is_over: Whether it ended by itself, so that its promise holds.
        obstacle: Why some configurations cannot be run; empty if all can.
    """

    selected: int | None
    certified: frozenset[int]
    eliminations: tuple[Elimination, ...]
    is_over: bool
    obstacle: str = ""

    @cached_property
    def refuted(self) -> frozenset[int]:
        """The refuted configurations."""
        return frozenset(each.configuration for each in self.eliminations)


@dataclass(frozen=True)
class RequirementResult:
    """The result of one configuration.

    Attributes:
        values: Values of the varied factors, by path.
        label: Name for people.
        cost: What is minimised.
        price: Price of its robots; without prices, their number.
        runs: Number of runs.
        quarantined: Number of quarantined runs, which count as not met.
        status: "selected": the cheapest certified one. "certified": it meets the requirement.
            "refuted": its share is below probability + tolerance. "open": neither is shown. "not
            needed": neither is shown either, but one that is not dearer is certified.
            "impossible": all its runs are quarantined, so that it is refuted or will be.
        met: The share of runs that meet the requirement; the intervals of all configurations hold
            simultaneously. None without runs.
        failing: The share of runs in which each condition does not hold, in their order;
            quarantined runs included. Empty without runs.
        quantiles: Quantiles of the columns of the conditions.
        goal_time: Where the time of a goal goes; None if no goal was served.
        clearance: The lanes that were declared clear; None without runs, or without a lane.
    """

    values: dict[str, Value]
    label: str
    cost: float
    price: float
    runs: int
    quarantined: int
    status: Status
    met: Interval | None
    failing: tuple[float, ...]
    quantiles: tuple[Quantiles, ...]
    goal_time: GoalTime | None = None
    clearance: Clearance | None = None

    @property
    def is_possible(self) -> bool:
        """Whether it can be run."""
        return self.status != "impossible"


def results(
    plan: Plan, requirement: Requirement, evidence: Evidence, ending: RequirementEnding
) -> tuple[RequirementResult, ...]:
    """Return the result of each configuration."""
    return tuple(
        RequirementResult(
            values=dict(sample.values),
            label=label(sample.values),
            cost=float(plan.costs[index]),
            price=price(sample),
            runs=sample.runs,
            quarantined=sample.quarantined,
            status=status(plan, evidence, ending, index),
            met=evidence.interval(index, "met") if sample.runs else None,
            failing=failing(sample, requirement),
            quantiles=quantiles_of(evidence, sample, quantile_columns(requirement)),
            goal_time=goal_time(sample),
            clearance=clearance(sample, evidence.confidence),
        )
        for index, sample in enumerate(evidence.samples)
    )


def status(plan: Plan, evidence: Evidence, ending: RequirementEnding, index: int) -> Status:
    """Return what is known of a configuration."""
    sample = evidence.samples[index]
    if index == ending.selected:
        return "selected"
    if index in ending.certified:
        return "certified"
    if sample.runs and not sample.is_possible:
        return "impossible"
    if index in ending.refuted:
        return "refuted"
    is_cheaper = ending.selected is None or plan.costs[index] < plan.costs[ending.selected]
    return "open" if is_cheaper else "not needed"


def quantile_columns(requirement: Requirement) -> tuple[str, ...]:
    """Return the columns of the conditions, each once."""
    return tuple(dict.fromkeys(condition.column for condition in requirement.conditions))


def failing(sample: Sample, requirement: Requirement) -> tuple[float, ...]:
    """Return the share of runs in which each condition does not hold; empty without runs."""
    if not sample.runs:
        return ()
    is_outcome = sample.columns["quarantined"] == 0
    holds = (condition.holds(sample.columns) & is_outcome for condition in requirement.conditions)
    return tuple(float(1 - each.mean()) for each in holds)


def price(sample: Sample) -> float:
    """Return the price of a configuration's team; without prices, its number of robots."""
    low, high = sample.limits.get("price", (0.0, 0.0))
    if low == high != 0:
        return rounded(low)
    return float(sample.limits["robots"][1])

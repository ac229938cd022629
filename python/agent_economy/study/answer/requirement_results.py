"""The results of each configuration of a study of a requirement."""

from dataclasses import dataclass
from typing import Literal, Self

from agent_economy import _core
from agent_economy.scenario import Requirement, Value
from agent_economy.study.answer.clearance import Clearance, clearance
from agent_economy.study.answer.evidence import Evidence, Interval, Sample
from agent_economy.study.answer.goal_time import GoalTime, goal_time
from agent_economy.study.answer.labels import label
from agent_economy.study.answer.quantiles import Quantiles, quantiles_of
from agent_economy.study.answer.ties import Verdict
from agent_economy.study.arguments import Floats
from agent_economy.study.teams import rounded

Known = Literal["certified", "may meet", "refuted", "open", "not needed", "impossible"]
Status = Literal["selected"] | Known


@dataclass(frozen=True)
class RequirementEnding:
    """The state of a study of a requirement, at its end or before.

    Attributes:
        costs: The cost of each configuration.
        selected: Index of the cheapest certified configuration; None if none is certified.
        certified: The certified configurations.
        refuted: Those that are shown not to meet the requirement with tolerance to spare.
        below: Those that are shown not to meet the requirement, tolerance or not.
        is_over: Whether its promise holds: all that are cheaper than the selected one are refuted.
        is_finest: Whether it ended by itself: its promise holds at a finer tolerance, too.
        obstacle: Why some configurations cannot be run; empty if all can.
    """

    costs: Floats
    selected: int | None
    certified: frozenset[int]
    refuted: frozenset[int]
    below: frozenset[int]
    is_over: bool
    is_finest: bool
    obstacle: str = ""

    @classmethod
    def of(cls, procedure: _core.Procedure, costs: Floats, obstacle: str = "") -> Self:
        """Return the state of a procedure."""
        return cls(
            costs=costs,
            selected=procedure.selected,
            certified=frozenset(procedure.certified.tolist()),
            refuted=frozenset(each for each, _, _ in procedure.eliminations),
            below=frozenset(procedure.below.tolist()),
            is_over=procedure.is_settled,
            is_finest=procedure.next() is None,
            obstacle=obstacle,
        )

    def status(self, index: int) -> Known:
        """Return what is known of a configuration, which is not selected before the end."""
        if index in self.certified:
            return "certified"
        if index in self.refuted:
            return "refuted" if index in self.below else "may meet"
        is_cheaper = self.selected is None or self.costs[index] < self.costs[self.selected]
        return "open" if is_cheaper else "not needed"


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
            "refuted": its share is shown to be below probability. "may meet": it is shown to be
            below probability + tolerance only. "open": nothing is shown. "not needed": nothing is
            shown, but one that is not dearer is certified. "impossible": all its runs are
            quarantined, so that it is refuted or will be.
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

    @property
    def verdict(self) -> Verdict | Known:
        """Its status, in the word for a selected configuration of any study."""
        return "best" if self.status == "selected" else self.status

    @property
    def worst(self) -> tuple[int, float] | None:
        """The number of the condition that fails most often, and its share of runs.

        None if none failed.
        """
        failed = ((at, share) for at, share in enumerate(self.failing) if share > 0)
        return max(failed, key=lambda pair: pair[1], default=None)

    @property
    def is_eliminated(self) -> bool:
        """Whether it is refuted."""
        return self.status == "refuted"


def results(
    requirement: Requirement, evidence: Evidence, ending: RequirementEnding
) -> tuple[RequirementResult, ...]:
    """Return the result of each configuration."""
    return tuple(
        RequirementResult(
            values=dict(sample.values),
            label=label(sample.values),
            cost=float(ending.costs[index]),
            price=price(sample),
            runs=sample.runs,
            quarantined=sample.quarantined,
            status=status(sample, ending, index),
            met=evidence.interval(index, "met") if sample.runs else None,
            failing=failing(sample, requirement),
            quantiles=quantiles_of(evidence, sample, quantile_columns(requirement)),
            goal_time=goal_time(sample),
            clearance=clearance(sample, evidence.confidence),
        )
        for index, sample in enumerate(evidence.samples)
    )


def status(sample: Sample, ending: RequirementEnding, index: int) -> Status:
    """Return what is known of a configuration at the end."""
    if index == ending.selected:
        return "selected"
    known = ending.status(index)
    if sample.runs and not sample.is_possible and known != "certified":
        return "impossible"
    return known


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

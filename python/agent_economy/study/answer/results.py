"""The results of each configuration."""

from dataclasses import dataclass

from agent_economy.scenario import Value
from agent_economy.study.answer.clearance import Clearance, clearance
from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.answer.front import Place, front
from agent_economy.study.answer.goal_time import GoalTime, goal_time
from agent_economy.study.answer.labels import label
from agent_economy.study.answer.quantiles import Quantiles, quantiles_of
from agent_economy.study.answer.ties import Standing, Verdict, standings
from agent_economy.study.selection import Elimination


@dataclass(frozen=True)
class Ending:
    """The end of a race.

    Attributes:
        best: Index of the selected configuration.
        eliminations: The eliminated configurations, in the order of their elimination.
        guarantee: The guarantee of the selection in words.
        is_guaranteed: Whether there is a guarantee.
        obstacle: Why some configurations cannot be run; empty if all can.
    """

    best: int
    eliminations: tuple[Elimination, ...]
    guarantee: str
    is_guaranteed: bool
    obstacle: str = ""


@dataclass(frozen=True)
class Result:
    """The result of one configuration; the intervals of all hold simultaneously.

    Attributes:
        values: Values of the varied factors, by path.
        label: Name for people.
        runs: Number of runs.
        quarantined: Number of runs without a finite merit, which count as the worst.
        merit: Figure of merit.
        time_s: Time of a run, capped.
        failed: Share of runs that failed.
        standing: Comparison with the selected configuration.
        place: Place with respect to the Pareto front of price, time and failures.
        eliminated: When and by which configuration; None if it was not eliminated.
        quantiles: Quantiles of the time of success.
        goal_time: Where the time of a goal goes; None if no goal was served.
        clearance: The lanes that were declared clear; None without runs, or without a lane.
    """

    values: dict[str, Value]
    label: str
    runs: int
    quarantined: int
    merit: Interval
    time_s: Interval
    failed: Interval
    standing: Standing
    place: Place
    eliminated: Elimination | None
    quantiles: tuple[Quantiles, ...] = ()
    goal_time: GoalTime | None = None
    clearance: Clearance | None = None

    met = None

    @property
    def verdict(self) -> Verdict:
        """What the comparison with the selected configuration proves."""
        return self.standing.verdict

    @property
    def is_possible(self) -> bool:
        """Whether it can be run, and was compared."""
        return self.verdict != "impossible"

    @property
    def is_eliminated(self) -> bool:
        """Whether the race eliminated it."""
        return self.eliminated is not None


def results(evidence: Evidence, ending: Ending, delta: float) -> tuple[Result, ...]:
    """Return the result of each configuration."""
    eliminated = {each.configuration: each for each in ending.eliminations}
    standing = standings(evidence, ending.best, delta)
    placed = zip(standing, front(evidence), strict=True)
    return tuple(
        Result(
            values=dict(evidence.samples[index].values),
            label=label(evidence.samples[index].values),
            runs=evidence.samples[index].runs,
            quarantined=evidence.samples[index].quarantined,
            merit=evidence.interval(index, "merit"),
            time_s=evidence.interval(index, "time_s"),
            failed=evidence.interval(index, "failed"),
            standing=stands,
            place=place,
            eliminated=eliminated.get(index),
            quantiles=quantiles_of(evidence, evidence.samples[index], ("time_s",)),
            goal_time=goal_time(evidence.samples[index]),
            clearance=clearance(evidence.samples[index], evidence.confidence),
        )
        for index, (stands, place) in enumerate(placed)
    )

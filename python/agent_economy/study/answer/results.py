"""What the runs of each configuration came to."""

from dataclasses import dataclass

from agent_economy.scenario import Value
from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.answer.front import Place, front
from agent_economy.study.answer.labels import label
from agent_economy.study.answer.ties import Standing, standings
from agent_economy.study.selection import Elimination


@dataclass(frozen=True)
class Ending:
    """How a race ended.

    Attributes:
        best: The configuration selected.
        eliminations: Who went out, in that order.
        guarantee: What is guaranteed, in words.
        is_guaranteed: Whether anything is.
    """

    best: int
    eliminations: tuple[Elimination, ...]
    guarantee: str
    is_guaranteed: bool


@dataclass(frozen=True)
class Result:
    """What the runs of one configuration came to; intervals of all hold together.

    Attributes:
        values: By path, what it differs in from the others.
        label: What people call it.
        runs: How many.
        quarantined: How many of them gave no finite merit and count as the worst.
        merit: Figure of merit.
        time_s: Time of a run, capped.
        failed: Share of runs that failed.
        standing: How it stands to the selected one.
        place: Its place on the front of price, time and success.
        eliminated: When and by whom; None for those that never were.
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


def results(evidence: Evidence, ending: Ending, delta: float) -> tuple[Result, ...]:
    """Return what the runs of each configuration came to."""
    gone = {each.configuration: each for each in ending.eliminations}
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
            eliminated=gone.get(index),
        )
        for index, (stands, place) in enumerate(placed)
    )

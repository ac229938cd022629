"""The answer of a study: whom to send, how sure that is, and what else the runs say."""

from dataclasses import dataclass

from agent_economy.scenario import Scenario, Value
from agent_economy.study import published
from agent_economy.study.effort import Effort, efforts
from agent_economy.study.evidence import Evidence, Interval
from agent_economy.study.front import Place, front
from agent_economy.study.labels import label
from agent_economy.study.plan import Plan
from agent_economy.study.published import PublishedResult
from agent_economy.study.saturation import Saturation, saturations
from agent_economy.study.selection import Elimination
from agent_economy.study.sensitivity import Sensitivity, sensitivity
from agent_economy.study.sentence import in_words
from agent_economy.study.ties import Standing, standings


@dataclass(frozen=True)
class Outcome:
    """How a race ended.

    Attributes:
        best: The configuration selected.
        eliminations: Who went out, in that order.
        guarantee: What is guaranteed, in words.
    """

    best: int
    eliminations: tuple[Elimination, ...]
    guarantee: str


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


@dataclass(frozen=True)
class Answer:
    """How many of which robots to send.

    Attributes:
        scenario: What was asked.
        seed: Of all random numbers.
        sentence: The answer for people.
        guarantee: What is guaranteed of it, in words.
        delta: The difference of merit worth finding.
        confidence: Of the guarantee, and of all intervals together.
        best: Index of the selected configuration.
        results: Of each configuration.
        saturations: Where each varied team size saturates.
        sensitivity: What each factor does; None where there are too few to say.
        efforts: What smaller deltas would take.
        published: Results of others, with the same merit.
    """

    scenario: Scenario
    seed: int
    sentence: str
    guarantee: str
    delta: float
    confidence: float
    best: int
    results: tuple[Result, ...]
    saturations: tuple[Saturation, ...]
    sensitivity: Sensitivity | None
    efforts: tuple[Effort, ...]
    published: tuple[PublishedResult, ...]

    @property
    def runs(self) -> int:
        """Runs of all configurations together."""
        return sum(result.runs for result in self.results)


def conclude(plan: Plan, evidence: Evidence, outcome: Outcome) -> Answer:
    """Return the answer that a study's runs give."""
    found = results(plan, evidence, outcome)
    saturated = saturations(evidence, outcome.best, plan.delta)
    return Answer(
        scenario=plan.scenario,
        seed=plan.seed,
        sentence=in_words(plan.scenario, plan.delta, outcome.best, found),
        guarantee=outcome.guarantee,
        delta=plan.delta,
        confidence=plan.confidence,
        best=outcome.best,
        results=found,
        saturations=saturated,
        sensitivity=sensitivity(evidence),
        efforts=efforts(evidence, outcome.best, plan.delta) if plan.runs is None else (),
        published=published.results(plan.scenario),
    )


def results(plan: Plan, evidence: Evidence, outcome: Outcome) -> tuple[Result, ...]:
    """Return what the runs of each configuration came to."""
    gone = {each.configuration: each for each in outcome.eliminations}
    is_good = plan.runs is None and plan.guarantee == "pgs"
    standing = standings(evidence, outcome.best, plan.delta, is_good=is_good)
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

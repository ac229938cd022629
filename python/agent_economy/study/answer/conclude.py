"""The answer of a study: whom to send, how sure that is, and what else the runs say."""

from dataclasses import dataclass

from agent_economy.scenario import Scenario
from agent_economy.study.answer import published
from agent_economy.study.answer.effort import Effort, efforts
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.published import PublishedResult
from agent_economy.study.answer.results import Ending, Result, results
from agent_economy.study.answer.saturation import Saturation, saturations
from agent_economy.study.answer.sensitivity import Sensitivity, sensitivity
from agent_economy.study.answer.sentence import in_words
from agent_economy.study.plan import Plan


@dataclass(frozen=True)
class Answer:
    """How many of which robots to send.

    Attributes:
        scenario: What was asked.
        seed: Of all random numbers.
        sentence: The answer for people.
        guarantee: What is guaranteed of it, in words.
        is_guaranteed: Whether anything is.
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
    is_guaranteed: bool
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


def conclude(plan: Plan, evidence: Evidence, ending: Ending) -> Answer:
    """Return the answer that a study's runs give."""
    found = results(evidence, ending, plan.delta)
    saturated = saturations(evidence, ending.best, plan.delta)
    return Answer(
        scenario=plan.scenario,
        seed=plan.seed,
        sentence=in_words(plan.scenario, plan.delta, ending.best, found),
        guarantee=ending.guarantee,
        is_guaranteed=ending.is_guaranteed,
        delta=plan.delta,
        confidence=plan.confidence,
        best=ending.best,
        results=found,
        saturations=saturated,
        sensitivity=sensitivity(evidence),
        efforts=efforts(evidence, ending.best, plan.delta) if plan.runs is None else (),
        published=published.results(plan.scenario),
    )

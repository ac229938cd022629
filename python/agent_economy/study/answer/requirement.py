"""The answer to the question of the cheapest configuration that meets a requirement."""

from dataclasses import dataclass

from agent_economy.scenario import Requirement, Scenario
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.requirement_results import (
    RequirementEnding,
    RequirementResult,
    results,
)
from agent_economy.study.answer.requirement_words import (
    guarantee,
    requirement_verdict,
    sentence,
)
from agent_economy.study.answer.verdict import Verdict, as_html
from agent_economy.study.plan import Plan
from agent_economy.study.question import Cheapest
from agent_economy.study.store.ledger import Answered


@dataclass(frozen=True)
class RequirementAnswer:
    """The answer of a study of a requirement.

    Attributes:
        scenario: The scenario.
        seed: Seed of all random numbers.
        verdict: The answer in four lines.
        sentence: The answer in words.
        guarantee: Its promise in words.
        is_guaranteed: Whether the study ended by itself, so that no cheaper configuration meets the
            requirement with tolerance to spare.
        confidence: Confidence of the promise; and, as a statement of its own, of all intervals.
        requirement: The requirement.
        cost: What a configuration costs, as an expression.
        selected: Index of the cheapest certified configuration; None if none is certified.
        results: Result of each configuration.
        questions: The questions that were answered from the same runs, this one included.
    """

    scenario: Scenario
    seed: int
    verdict: Verdict
    sentence: str
    guarantee: str
    is_guaranteed: bool
    confidence: float
    requirement: Requirement
    cost: str
    selected: int | None
    results: tuple[RequirementResult, ...]
    questions: tuple[Answered, ...] = ()

    def __repr__(self) -> str:
        """Return the verdict and the number of runs."""
        return f"RequirementAnswer({' '.join(self.verdict)!r}, {self.runs:,} runs)"

    def _repr_html_(self) -> str:
        """Return the verdict for notebooks."""
        return as_html(self.verdict)

    @property
    def runs(self) -> int:
        """Number of runs of all configurations together."""
        return sum(result.runs for result in self.results)


def conclude_requirement(
    plan: Plan, evidence: Evidence, ending: RequirementEnding
) -> RequirementAnswer:
    """Return the answer that follows from the runs of a study of a requirement.

    Raises:
        TypeError: If the plan has another question.
    """
    question = plan.question
    if not isinstance(question, Cheapest):
        message = "the question is not about a requirement"
        raise TypeError(message)
    found = results(plan, question.requirement, evidence, ending)
    return RequirementAnswer(
        scenario=plan.scenario,
        seed=plan.seed,
        verdict=requirement_verdict(
            question, found, plan.confidence, ending.obstacle, is_over=ending.is_over
        ),
        sentence=sentence(
            question, found, plan.confidence, ending.obstacle, is_over=ending.is_over
        ),
        guarantee=guarantee(question, found, plan.confidence, is_over=ending.is_over),
        is_guaranteed=ending.is_over,
        confidence=plan.confidence,
        requirement=question.requirement,
        cost=question.cost,
        selected=ending.selected,
        results=found,
    )

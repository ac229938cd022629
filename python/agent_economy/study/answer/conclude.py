"""The answer of a study: which team to send, with which guarantee, and further results."""

from dataclasses import dataclass

from agent_economy.scenario import Scenario
from agent_economy.study.answer import published
from agent_economy.study.answer.effort import Effort, efforts
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.published import PublishedResult
from agent_economy.study.answer.results import Ending, Result, results
from agent_economy.study.answer.saturation import Saturation, saturations
from agent_economy.study.answer.sensitivity import Sensitivity, sensitivity
from agent_economy.study.answer.sentence import sentence
from agent_economy.study.answer.side_statements import Omission, SideStatements
from agent_economy.study.answer.verdict import Verdict, as_html, verdict
from agent_economy.study.plan import Plan
from agent_economy.study.question import Best
from agent_economy.study.store.ledger import Answered


@dataclass(frozen=True)
class Answer:
    """The answer of a study: the selected configuration, and the results of all.

    Attributes:
        scenario: The scenario of the study.
        seed: Seed of all random numbers.
        verdict: The answer in four lines.
        sentence: The answer in words.
        guarantee: The guarantee of the selection in words.
        is_guaranteed: Whether there is a guarantee.
        delta: Indifference zone, in units of merit.
        confidence: Confidence of the guarantee, and of all intervals together.
        best: Index of the selected configuration.
        results: Result of each configuration.
        saturations: The saturation of each varied team size.
        sensitivity: Influence of each factor; None if there are too few configurations.
        efforts: Predicted runs for smaller deltas.
        published: Published results, scored with the same merit.
        omissions: Those of the preceding four that could not be stated, each with the reason.
        questions: The questions that were answered from the same runs, this one included.
    """

    scenario: Scenario
    seed: int
    verdict: Verdict
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
    omissions: tuple[Omission, ...] = ()
    questions: tuple[Answered, ...] = ()

    def __repr__(self) -> str:
        """Return the verdict and the number of runs."""
        return f"Answer({' '.join(self.verdict)!r}, {self.runs:,} runs)"

    def _repr_html_(self) -> str:
        """Return the verdict for notebooks."""
        return as_html(self.verdict)

    @property
    def runs(self) -> int:
        """Number of runs of all configurations together."""
        return sum(result.runs for result in self.results)


def conclude(plan: Plan, evidence: Evidence, ending: Ending) -> Answer:
    """Return the answer that follows from the runs of a study."""
    best, delta = ending.best, delta_of(plan)
    found = results(evidence, ending, delta)
    side = SideStatements()
    saturated = side.make("saturations", lambda: saturations(evidence, best, delta))
    influences = side.make("sensitivity", lambda: sensitivity(evidence))
    predicted = None
    if plan.runs is None:
        predicted = side.make("efforts", lambda: efforts(evidence, best, delta))
    theirs = side.make("published", lambda: published.results(plan.scenario))
    return Answer(
        scenario=plan.scenario,
        seed=plan.seed,
        verdict=verdict(plan.scenario, ending, found, delta, plan.confidence),
        sentence=sentence(plan.scenario, delta, ending, found, has_prices=evidence.has_prices),
        guarantee=ending.guarantee,
        is_guaranteed=ending.is_guaranteed,
        delta=delta,
        confidence=plan.confidence,
        best=best,
        results=found,
        saturations=saturated or (),
        sensitivity=influences,
        efforts=predicted or (),
        published=theirs or (),
        omissions=tuple(side.omissions),
    )


def delta_of(plan: Plan) -> float:
    """Return the indifference zone of a plan whose question is the best."""
    if isinstance(plan.question, Best):
        return plan.question.delta
    message = "the question is not about the best by merit"
    raise TypeError(message)

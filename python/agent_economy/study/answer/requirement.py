"""The answer to the question of the cheapest configuration that meets a requirement."""

from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.scenario import Requirement, Scenario
from agent_economy.shares import percent, percent_bounds
from agent_economy.study.agents import StudyAgents
from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.answer.study_answer import StudyAnswer, Verdict
from agent_economy.study.store.ledger import Answered

STYLES = {"selected": "bold", "refuted": "dim", "not needed": "dim", "impossible": "dim"}
"""The style of each status that has one, on a terminal."""


@dataclass(frozen=True, repr=False)
class RequirementAnswer(StudyAnswer):
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
        runs_to_decide: About how many further runs decide whether cheaper configurations meet it;
            None if none may.
        selected: Index of the cheapest certified configuration; None if none is certified.
        results: Result of each configuration.
        questions: The questions that were answered from the same runs, this one included.
        agents: The brains and controllers in Python that replaced those of the scenario.
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
    runs_to_decide: int | None = None
    questions: tuple[Answered, ...] = ()
    agents: tuple[StudyAgents, ...] = ()

    # The verdict contains all that they would state.
    details = precision = ""

    @property
    def chosen(self) -> RequirementResult | None:
        """The result of the selected configuration, if one is certified."""
        return None if self.selected is None else self.results[self.selected]

    @property
    def contenders(self) -> frozenset[int]:
        """Those that are certified or open, and the next cheaper one than the selected one."""
        known = [at for at, each in enumerate(self.results) if each.met and each.is_possible]
        known.sort(key=lambda at: self.results[at].cost)
        end = len(known) if self.selected is None else known.index(self.selected)
        in_play = ("selected", "certified", "open")
        near = (at for at in known if self.results[at].status in in_play)
        return frozenset((*near, *known[:end][-1:]))

    def foremost(self, count: int) -> list[RequirementResult]:
        """Return the teams by their cost; of many, the selected one and those next to it.

        Without a selected one, those that come closest.
        """
        ordered = sorted(self.results, key=lambda result: result.cost)
        if self.chosen is None:
            closest = sorted(ordered, key=lambda each: each.met.value if each.met else -1.0)[
                -count:
            ]
            return [each for each in ordered if each in closest]
        at = ordered.index(self.chosen)
        last = min(len(ordered), max(count, at + count // 4))
        return ordered[max(0, last - count) : last]

    @property
    def heads(self) -> tuple[str, ...]:
        """The heads of `cells`."""
        return (self.cost, "runs", "met", "most frequent failure", "")

    def cells(self, result: RequirementResult, *, ranges: bool) -> Iterator[str]:
        """Yield the cells of a result for a terminal, with ranges or without."""
        yield f"{result.cost:,.12g}"
        yield f"{result.runs:,}" if result.runs else ""
        met = result.met if result.is_possible else None
        between = f" ({'..'.join(percent_bounds(met.low, met.high))})" if met and ranges else ""
        yield f"{percent(met.value)}{between}" if met else ""
        yield self.worst_failure(result)
        yield result.status

    def worst_failure(self, result: RequirementResult) -> str:
        """Return the condition that fails most often and its share; empty if none failed."""
        if result.worst is None or not result.is_possible:
            return ""
        worst, share = result.worst
        return f"{self.requirement.conditions[worst].text}: {percent(share)}"

    def style(self, result: RequirementResult) -> str | None:
        """Return the style of the row of a result on a terminal."""
        return STYLES.get(result.status)

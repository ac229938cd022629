"""The answer to the question of the best configuration by merit."""

from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.scenario import Scenario
from agent_economy.shares import percent, percent_bounds
from agent_economy.study.agents import StudyAgents
from agent_economy.study.answer.effort import Effort
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.published import PublishedResult
from agent_economy.study.answer.results import Result
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.answer.sensitivity import Sensitivity
from agent_economy.study.answer.side_statements import Omission
from agent_economy.study.answer.study_answer import StudyAnswer, Verdict
from agent_economy.study.store.ledger import Answered


@dataclass(frozen=True, repr=False)
class Answer(StudyAnswer):
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
        sensitivity: Influence of each factor; None if there are too few configurations, or if it
            cannot be stated.
        efforts: Predicted runs for smaller deltas.
        published: Published results, scored with the same merit.
        omissions: Those of the preceding four that could not be stated, each with the reason.
        questions: The questions that were answered from the same runs, this one included.
        agents: The brains and controllers in Python that replaced those of the scenario.
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
    agents: tuple[StudyAgents, ...] = ()

    @property
    def chosen(self) -> Result:
        """The result of the selected configuration."""
        return self.results[self.best]

    @property
    def details(self) -> str:
        """What the verdict does not contain."""
        return self.sentence

    @property
    def precision(self) -> str:
        """The indifference zone."""
        return f"delta {self.delta:g}, "

    @property
    def contenders(self) -> frozenset[int]:
        """The selected one and those that are not proved to be worse, or the next best one."""
        possible = [index for index, each in enumerate(self.results) if each.is_possible]
        near = [index for index in possible if self.results[index].verdict != "worse"]
        if len(near) > 1:
            return frozenset(near)
        others = sorted(set(possible) - set(near), key=lambda at: -self.results[at].merit.value)
        return frozenset((*near, *others[:1]))

    def foremost(self, count: int) -> list[Result]:
        """Return all results in the configurations' order if they fit, else the best ones first."""
        if len(self.results) <= count:
            return list(self.results)
        others = [result for result in self.results if result is not self.chosen]

        def rank(result: Result) -> tuple[bool, float]:
            return not result.is_possible, -result.merit.value

        return [self.chosen, *sorted(others, key=rank)][:count]

    @property
    def heads(self) -> tuple[str, ...]:
        """The heads of `cells`."""
        has_quarantined = any(result.quarantined for result in self.results)
        counts = ("runs", "quarantined") if has_quarantined else ("runs",)
        return (*counts, "time, s", "failed", "merit", "behind", "")

    def cells(self, result: Result, *, ranges: bool) -> Iterator[str]:
        """Yield the cells of a result for a terminal, with ranges or without."""

        def cell(given: Interval, style: str) -> str:
            if not result.is_possible:
                return ""
            value, *ends = (format(each, style) for each in (given.value, given.low, given.high))
            return f"{value} ({'..'.join(ends)})" if ranges else value

        yield f"{result.runs:,}"
        if "quarantined" in self.heads:
            yield f"{result.quarantined:,}"
        yield cell(result.time_s, "z.1f")
        yield failed_cell(result.failed, ranges=ranges) if result.is_possible else ""
        yield cell(result.merit, "z.2f")
        yield behind_cell(result.standing.behind) if result.standing.behind else ""
        yield result.verdict

    def style(self, result: Result) -> str | None:
        """Return the style of the row of a result on a terminal."""
        return "bold" if result is self.chosen else None


def behind_cell(behind: Interval) -> str:
    """Return how far a configuration is behind the selected one, or ahead of it."""
    value = f"{behind.value:z.3f}"
    return f"{value[1:]} ahead" if value.startswith("-") else value


def failed_cell(failed: Interval, *, ranges: bool) -> str:
    """Return the share of failed runs, with its range or without."""
    low, high = percent_bounds(failed.low, failed.high, decimals=2)
    if failed.value == 0:
        return f"none (..{high})" if ranges else "none"
    value = percent(failed.value, decimals=2)
    return f"{value} ({low}..{high})" if ranges else value

"""The selection, order and names of what a report about a requirement shows."""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

from agent_economy.scenario import Condition, Value
from agent_economy.study.answer.clearance import Clearance
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.goal_time import GoalTime
from agent_economy.study.answer.labels import varied
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.report.view import MAX_SHOWN, are_grid


@dataclass(frozen=True)
class RequirementView:
    """An answer about a requirement and its evidence, as a report shows them."""

    answer: RequirementAnswer
    evidence: Evidence

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The name of each configuration; all are different."""
        labels = [result.label for result in self.answer.results]
        times = Counter(labels)
        return tuple(
            f"{index + 1}: {label}" if times[label] > 1 else label
            for index, label in enumerate(labels)
        )

    @cached_property
    def by_cost(self) -> tuple[int, ...]:
        """All configurations, the cheapest first."""
        results = self.answer.results
        return tuple(sorted(range(len(results)), key=lambda index: results[index].cost))

    @cached_property
    def known(self) -> tuple[int, ...]:
        """The configurations that have runs, the cheapest first."""
        return tuple(
            index
            for index in self.by_cost
            if self.result(index).runs and self.result(index).is_possible
        )

    @cached_property
    def shown(self) -> tuple[int, ...]:
        """The configurations with runs that are shown: the selected one and those next to it."""
        if len(self.known) <= MAX_SHOWN:
            return self.known
        end = len(self.known)
        if self.answer.selected is not None:
            end = min(end, self.known.index(self.answer.selected) + MAX_SHOWN // 5)
        return self.known[max(0, end - MAX_SHOWN) : end]

    @property
    def selected(self) -> int | None:
        """The selected configuration; None if none is certified."""
        return self.answer.selected

    @cached_property
    def configurations(self) -> list[dict[str, Value]]:
        """The values of the varied factors of each configuration."""
        return [result.values for result in self.answer.results]

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """Paths that have more than one value."""
        return varied(self.configurations)

    @cached_property
    def is_grid(self) -> bool:
        """Whether two factors are varied in a full grid."""
        return are_grid(self.configurations, self.varied)

    @cached_property
    def with_goal_time(self) -> dict[int, GoalTime]:
        """Where the time of a goal goes in those that are shown, in the order of the design."""
        times = {index: self.result(index).goal_time for index in sorted(self.shown)}
        return {index: time for index, time in times.items() if time is not None}

    @cached_property
    def with_clearance(self) -> dict[int, Clearance]:
        """The lanes declared clear by those that are shown, in their order."""
        lanes = {index: self.result(index).clearance for index in self.shown}
        return {index: of for index, of in lanes.items() if of is not None}

    @cached_property
    def compared_distributions(self) -> tuple[int, ...]:
        """The chosen configuration, or the dearest, and the next cheaper one."""
        if not self.known:
            return ()
        selected = self.answer.selected
        last = self.known.index(selected) if selected is not None else len(self.known) - 1
        return self.known[max(0, last - 1) : last + 1][::-1]

    @cached_property
    def deciding_condition(self) -> Condition:
        """The condition that fails most often in the configurations that are compared."""
        conditions = self.answer.requirement.conditions
        indices = self.compared_distributions or self.known

        def fails(number: int) -> float:
            return sum(self.result(index).failing[number] for index in indices)

        return conditions[max(range(len(conditions)), key=fails)]

    @property
    def band_alpha(self) -> float:
        """The allowed error of the band of one distribution: two are drawn."""
        return (1 - self.answer.confidence) / 2

    @cached_property
    def has_prices(self) -> bool:
        """Whether the prices of the configurations that are shown differ."""
        return (
            len({self.result(index).price for index in self.shown}) > 1 and self.evidence_has_prices
        )

    @cached_property
    def evidence_has_prices(self) -> bool:
        """Whether robots have prices."""
        return any(
            sample.limits.get("price", (0.0, 0.0))[1] != 0 for sample in self.evidence.samples
        )

    def result(self, index: int) -> RequirementResult:
        """Return the result of a configuration."""
        return self.answer.results[index]

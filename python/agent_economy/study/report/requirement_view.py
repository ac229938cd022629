"""The selection and order of what a report about a requirement shows."""

from dataclasses import dataclass
from functools import cached_property

from agent_economy.scenario import Condition
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.report.view import MAX_SHOWN, View
from agent_economy.study.selection import percentage

STYLES = {"selected": "best", "refuted": "worse", "impossible": "impossible"}
"""The CSS class of the row of each status that has one."""


@dataclass(frozen=True)
class RequirementView(View):
    """An answer about a requirement and its evidence."""

    answer: RequirementAnswer
    evidence: Evidence

    quarantine = "without an outcome: quarantined, each counts as not met"
    principles = (
        (
            "order",
            "that more robots are better is not assumed; each configuration is judged alone",
        ),
        ("quarantine", "a run without an outcome counts as not met and is never omitted"),
    )

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """The required share and the tolerance."""
        requirement = self.answer.requirement
        return (
            (percentage(requirement.probability), "required share of missions"),
            (percentage(requirement.tolerance), "tolerance"),
        )

    def price(self, index: int) -> float:
        """Return the price of a configuration; without prices, its number of robots."""
        return self.result(index).price

    def style(self, index: int) -> str:
        """Return the CSS class of the row of a configuration."""
        return STYLES.get(self.result(index).status, "")

    @cached_property
    def known(self) -> tuple[int, ...]:
        """The configurations that have runs, the cheapest first."""
        found = (
            at for at, each in enumerate(self.answer.results) if each.runs and each.is_possible
        )
        return tuple(sorted(found, key=lambda index: self.result(index).cost))

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
    def compared_distributions(self) -> tuple[int, ...]:
        """The chosen configuration, or the dearest, and the next cheaper one."""
        if not self.known:
            return ()
        selected = self.answer.selected
        last = self.known.index(selected) if selected is not None else len(self.known) - 1
        return self.known[max(0, last - 1) : last + 1][::-1]

    @cached_property
    def deciding_condition(self) -> Condition:
        """The condition that fails most often in the configurations that are compared.

        The first one if none fails.
        """
        return max(self.answer.requirement.conditions, key=self.fails)

    def fails(self, condition: Condition) -> float:
        """Return the share of missions that fail a condition, summed over those compared."""
        number = self.answer.requirement.conditions.index(condition)
        indices = self.compared_distributions or self.known
        return sum(self.result(index).failing[number] for index in indices)

    @property
    def band_alpha(self) -> float:
        """The allowed error of the band of one distribution: two are drawn."""
        return (1 - self.answer.confidence) / 2

    @cached_property
    def has_prices(self) -> bool:
        """Whether robots have prices, which differ in the configurations that are shown."""
        prices = {self.result(index).price for index in self.shown}
        limits = (sample.limits.get("price", (0.0, 0.0)) for sample in self.evidence.samples)
        return len(prices) > 1 and any(high != 0 for _, high in limits)

    def result(self, index: int) -> RequirementResult:
        """Return the result of a configuration."""
        return self.answer.results[index]

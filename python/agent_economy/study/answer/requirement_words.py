"""The answer about a requirement in words."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from agent_economy.scenario import Requirement
from agent_economy.shares import of_runs, percent_bounds, vanishes
from agent_economy.study.answer import clearance
from agent_economy.study.answer.condition_words import in_words
from agent_economy.study.answer.labels import alternatives, first, listed, recommendation
from agent_economy.study.answer.requirement_results import (
    RequirementEnding,
    RequirementResult,
    Status,
)
from agent_economy.study.answer.study_answer import Verdict
from agent_economy.study.answer.verdict import declarations, upper
from agent_economy.study.selection import percentage

CHEAPER = {"price": "no cheaper compared team", "robots": "no compared team with fewer robots"}
"""Teams of a lower cost in words: the promise covers those that were compared."""

NONE = "No compared team is certified."

MAX_NAMED = 5
"""Configurations that a sentence names individually."""


@dataclass(frozen=True)
class RequirementWords:
    """The words of an answer.

    Attributes:
        requirement: The requirement.
        cost: What a configuration costs, as an expression.
        results: Result of each configuration.
        confidence: Confidence of the promise.
        ending: The end of the study.
        runs_to_decide: About how many runs decide the cheaper teams that may meet it.
    """

    requirement: Requirement
    cost: str
    results: Sequence[RequirementResult]
    confidence: float
    ending: RequirementEnding
    runs_to_decide: int | None

    def verdict(self) -> Verdict:
        """Return the answer in four lines."""
        low, high = self.low, spare_of(self.requirement)
        chosen = self.chosen
        if chosen is None:
            is_over = self.ending.is_over
            first = NONE if is_over else "Stopped before a team was certified."
            second = " ".join(f"{part}." for part in self.why())
        else:
            first = f"{recommendation(chosen.values)}."
            did = seen(chosen, self.requirement)
            met = f"{upper(self.holds)} in at least {low} of missions{did}."
            second = " ".join([met, *declarations(chosen.clearance)])
        parts = self.of_cheaper() + self.impossible(self.cheaper)
        third = " ".join(f"{part}." for part in parts) or "No compared team is cheaper."
        confidently = f"{percentage(self.confidence)} confidence"
        fourth = f"{confidently}; shares from {low} to {high} are not distinguished."
        if not self.ending.is_over:
            only = f"only that the selected team meets it is guaranteed ({confidently})"
            fourth = f"Stopped early: {only if chosen else 'nothing is guaranteed'}."
        return first, second or "There were no runs.", third, fourth

    def sentence(self) -> str:
        """Return which team to send, what it meets, and what is known of cheaper ones."""
        chosen = self.chosen
        share_met = f"{self.holds} in at least {self.low} of missions"
        if chosen is None:
            parts = [f"No team is certified: {share_met}", *self.why()]
        else:
            confidently = f"({percentage(self.confidence)} confidence)"
            parts = [f"{recommendation(chosen.values)}: {share_met} {confidently}"]
            parts += [upper(clearance.in_words(chosen.clearance))] if chosen.clearance else []
        parts += self.of_cheaper() + self.impossible(self.results)
        if chosen is not None:
            parts += self.edge(chosen)
        return " ".join(f"{part}." for part in parts)

    def guarantee(self) -> str:
        """Return the promise of the answer."""
        spare = spare_of(self.requirement)
        confidently = f"With {percentage(self.confidence)} confidence"
        meets = f"the selected team meets the requirement in at least {self.low} of missions"
        if self.ending.is_over and self.chosen:
            cost = self.cost.strip()
            cheaper = CHEAPER.get(cost, f"no compared team of a lower cost ({cost})")
            return f"{confidently}, {meets}, and {cheaper} meets it in {spare} or more."
        if self.ending.is_over:
            none = f"no compared team meets the requirement in {spare} or more of missions"
            return f"{confidently}, {none}."
        if self.chosen:
            return (
                f"{confidently}, {meets}. Cheaper teams that are not decided may meet it as well."
            )
        return "No guarantee: the study was stopped before a team was certified."

    @property
    def low(self) -> str:
        """The required share."""
        return percentage(self.requirement.probability)

    @property
    def holds(self) -> str:
        """The conditions."""
        return listed([in_words(each) for each in self.requirement.conditions])

    @property
    def chosen(self) -> RequirementResult | None:
        """The result of the selected team, if there is one."""
        selected = self.ending.selected
        return None if selected is None else self.results[selected]

    @cached_property
    def cheaper(self) -> list[RequirementResult]:
        """The results of teams that are cheaper than the selected one; all without one."""
        limit = math.inf if self.chosen is None else self.chosen.cost
        return [each for each in self.results if each.cost < limit]

    def of_cheaper(self) -> list[str]:
        """Return what is known of cheaper teams; only a study that is over makes a promise."""
        below = f"met in fewer than {spare_of(self.requirement)} of missions"
        words = below if self.ending.is_over else "refuted so far, without a guarantee"
        return [
            *self.may_meet(),
            *refuted(self.cheaper, words),
            *named(self.cheaper, "open", "not decided"),
        ]

    def may_meet(self) -> list[str]:
        """Return which cheaper teams may meet it, and how many runs would decide that."""
        found = [(each.met.value, each) for each in self.cheaper if each.met and may_meet(each)]
        if not found:
            return []
        found.sort(key=lambda pair: -pair[0])
        near = self.requirement.probability - self.requirement.tolerance
        count = max(1, sum(share >= near for share, _ in found[:MAX_NAMED]))
        near_teams = [f"{each.label}{seen(each, self.requirement)}" for _, each in found[:count]]
        as_well = " as well" if self.chosen else ""
        others = len(found) - count
        more = f", and so may {others} other{'s' if others > 1 else ''}" if others else ""
        runs = in_figures(self.runs_to_decide)
        may = f"{upper(alternatives(near_teams))} may meet it{as_well}{more}"
        return [f"{may}; about {runs} more runs would decide (--decide)"]

    def impossible(self, results: Sequence[RequirementResult]) -> list[str]:
        """Return which of some teams cannot be run, and why."""
        return named(results, "impossible", f"cannot be run ({self.ending.obstacle})")

    def edge(self, chosen: RequirementResult) -> list[str]:
        """Return a warning if the selected team is the cheapest; none for a single robot."""
        lowest = min(each.cost for each in self.results)
        is_robots = self.cost.strip() == "robots"
        if chosen.cost > lowest or (is_robots and chosen.cost <= 1):
            return []
        fewer = "with fewer robots" if is_robots else "of a lower cost"
        return [f"No team {fewer} was compared; one may meet it as well"]

    def why(self) -> list[str]:
        """Return which team comes closest, and which condition fails most often there."""
        known = [(each.met, each) for each in self.results if each.met and each.is_possible]
        if not known:
            return []
        met, nearest = max(known, key=lambda pair: pair[0].value)
        failing = self.failing_most_often(nearest)
        if met.value == 0:
            return [
                "No run met it",
                *(f"The condition that fails most often: {each}" for each in failing),
            ]
        decimals = decimals_of(self.requirement)
        share_met = of_runs(met.value, nearest.runs, "missions", decimals)
        low, high = percent_bounds(met.low, met.high, decimals)
        closest = "Closest" if self.ending.is_over else "Best so far"
        return [
            f"{closest}: {nearest.label}, met in {share_met} ({low} to {high})",
            *(f"The condition that fails most often there: {each}" for each in failing),
        ]

    def failing_most_often(self, result: RequirementResult) -> list[str]:
        """Return the condition that fails most often, with its share; none if none failed."""
        if result.worst is None:
            return []
        worst, part = result.worst
        condition = self.requirement.conditions[worst].text
        return [f"{condition}, in {of_runs(part, result.runs, 'missions')}"]


def may_meet(result: RequirementResult) -> bool:
    """Return whether a team is refuted with the tolerance to spare only."""
    return result.status == "may meet"


def in_figures(number: int | None) -> str:
    """Return a number with two significant figures."""
    return f"{float(f'{number or 0:.2g}'):,.0f}"


def seen(result: RequirementResult, requirement: Requirement) -> str:
    """Return the share of runs in which a team met a requirement."""
    if result.met is None:
        return ""
    value, runs, decimals = result.met.value, result.runs, decimals_of(requirement)
    met = f"{value:.{decimals}%} of {runs:,}"
    if value == 1:
        met = f"all of {runs:,}"
    elif vanishes(value, decimals):
        met = f"{round(value * runs):,} of {runs:,}"
    return f" ({met} did)"


def decimals_of(requirement: Requirement) -> int:
    """Return the decimals of percentages: two figures of what the requirement allows to fail."""
    return max(1, 1 - math.floor(math.log10(100 * (1 - requirement.probability)) + 1e-9))


def spare_of(requirement: Requirement) -> str:
    """Return the required share with the tolerance."""
    return percentage(round(requirement.probability + requirement.tolerance, 12))


def named(results: Sequence[RequirementResult], status: Status, words: str) -> list[str]:
    """Return a sentence about the teams of a status, the dearest first; none if there is none."""
    each = sorted((each for each in results if each.status == status), key=lambda each: -each.cost)
    if not each:
        return []
    labels = first([result.label for result in each], MAX_NAMED, "more")
    # A separator that labels do not contain: a team of two kinds has a comma in its label.
    return [f"{'; '.join(labels)}: {words}"]


def refuted(results: Sequence[RequirementResult], words: str) -> list[str]:
    """Return a sentence about refuted teams, which names the dearest; none if there is none."""
    each = [each for each in results if each.status == "refuted"]
    if not each:
        return []
    dearest = max(each, key=lambda result: result.cost)
    others = len(each) - 1
    more = f", and {others} other{'s' if others > 1 else ''}" if others else ""
    return [f"{dearest.label}{more}: {words}"]

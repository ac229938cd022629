"""The answer about a requirement in words."""

import math
from collections.abc import Sequence

from agent_economy.scenario import Requirement
from agent_economy.study.answer import clearance
from agent_economy.study.answer.condition_words import in_words
from agent_economy.study.answer.labels import listed, recommendation
from agent_economy.study.answer.requirement_results import RequirementResult, Status
from agent_economy.study.answer.verdict import Verdict, declarations, upper
from agent_economy.study.question import Cheapest
from agent_economy.study.selection import percentage

CHEAPER = {"price": "no cheaper compared team", "robots": "no compared team with fewer robots"}
"""Teams of a lower cost in words: the promise covers those that were compared."""

NONE = "No compared team is certified."

MAX_NAMED = 5
"""Configurations that a sentence names individually."""


def requirement_verdict(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    obstacle: str,
    *,
    is_over: bool,
) -> Verdict:
    """Return the answer in four lines."""
    requirement = question.requirement
    holds = listed([in_words(each) for each in requirement.conditions])
    low, high = percentage(requirement.probability), spare_of(requirement)
    chosen = selected(results)
    if chosen is None:
        first = NONE if is_over else "Stopped before a team was certified."
        second = " ".join(f"{part}." for part in why(question, results, is_over=is_over))
    else:
        first = f"{recommendation(chosen.values)}."
        met = f"{upper(holds)} in at least {low} of missions{seen(chosen, requirement)}."
        second = " ".join([met, *declarations(chosen.clearance)])
    parts = of_cheaper(question, results, is_over=is_over)
    parts += named(cheaper(results), "impossible", f"cannot be run ({obstacle})")
    third = " ".join(f"{part}." for part in parts) or "No compared team is cheaper."
    fourth = (
        f"{percentage(confidence)} confidence; shares from {low} to {high} are not distinguished."
    )
    if not is_over:
        fourth = stopped(chosen, confidence)
    return first, second or "There were no runs.", third, fourth


def stopped(chosen: RequirementResult | None, confidence: float) -> str:
    """Return what a study that was stopped early guarantees."""
    if chosen is None:
        return "Stopped early: nothing is guaranteed."
    confidently = f"{percentage(confidence)} confidence"
    return f"Stopped early: only that the selected team meets it is guaranteed ({confidently})."


def selected(results: Sequence[RequirementResult]) -> RequirementResult | None:
    """Return the result of the selected team, if there is one."""
    return next((each for each in results if each.status == "selected"), None)


def cheaper(results: Sequence[RequirementResult]) -> list[RequirementResult]:
    """Return the results of teams that are cheaper than the selected one; all without one."""
    chosen = selected(results)
    return [each for each in results if chosen is None or each.cost < chosen.cost]


def of_cheaper(
    question: Cheapest, results: Sequence[RequirementResult], *, is_over: bool
) -> list[str]:
    """Return what is known of cheaper teams; only a study that is over makes a promise of them."""
    below = f"met in fewer than {spare_of(question.requirement)} of missions"
    words = below if is_over else "refuted so far, without a guarantee"
    known = cheaper(results)
    return refuted(known, words) + named(known, "open", "not decided")


def seen(result: RequirementResult, requirement: Requirement) -> str:
    """Return the share of runs in which a team met a requirement."""
    if result.met is None:
        return ""
    value, runs = result.met.value, result.runs
    met = f"{round(value * runs):,} of {runs:,}"
    if value == 1:
        met = f"all of {runs:,}"
    elif (rounded := share(value, requirement)) != share(1.0, requirement):
        met = f"{rounded} of {runs:,}"
    return f" ({met} did)"


def share(value: float, requirement: Requirement) -> str:
    """Return a share of missions with two figures of what the requirement allows to fail."""
    places = 1 - math.floor(math.log10(100 * (1 - requirement.probability)) + 1e-9)
    return f"{value:.{max(1, places)}%}"


def spare_of(requirement: Requirement) -> str:
    """Return the required share with the tolerance."""
    return percentage(round(requirement.probability + requirement.tolerance, 12))


def sentence(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    obstacle: str,
    *,
    is_over: bool,
) -> str:
    """Return the answer: which team to send, what it meets, and what is known of cheaper ones."""
    chosen = selected(results)
    requirement = question.requirement
    holds = listed([in_words(each) for each in requirement.conditions])
    low = percentage(requirement.probability)
    if chosen is None:
        none = f"No team is certified: {holds} in at least {low} of missions"
        parts = [none, *why(question, results, is_over=is_over)]
    else:
        confidently = f"({percentage(confidence)} confidence)"
        send = recommendation(chosen.values)
        parts = [f"{send}: {holds} in at least {low} of missions {confidently}"]
        parts += [upper(clearance.in_words(chosen.clearance))] if chosen.clearance else []
    parts += of_cheaper(question, results, is_over=is_over)
    parts += named(results, "impossible", f"cannot be run ({obstacle})")
    if chosen is not None:
        parts += edge(question, chosen, results)
    return " ".join(f"{part}." for part in parts)


def edge(
    question: Cheapest, chosen: RequirementResult, results: Sequence[RequirementResult]
) -> list[str]:
    """Return a warning if the selected team is the cheapest compared; none for a single robot."""
    lowest = min(each.cost for each in results)
    is_robots = question.cost.strip() == "robots"
    if chosen.cost > lowest or (is_robots and chosen.cost <= 1):
        return []
    fewer = "with fewer robots" if is_robots else "of a lower cost"
    return [f"No team {fewer} was compared; one may meet it as well"]


def why(question: Cheapest, results: Sequence[RequirementResult], *, is_over: bool) -> list[str]:
    """Return which team comes closest, and which condition fails most often in its missions."""
    requirement = question.requirement
    known = [(each.met, each) for each in results if each.met is not None and each.is_possible]
    if not known:
        return []
    met, nearest = max(known, key=lambda pair: pair[0].value)
    low, high = (share(bound, requirement) for bound in (met.low, met.high))
    best = f"{nearest.label}, met in {share(met.value, requirement)} of missions ({low} to {high})"
    worst = max(range(len(nearest.failing)), key=nearest.failing.__getitem__)
    condition = requirement.conditions[worst].text
    failing = f"{condition}, in {nearest.failing[worst]:.1%} of missions"
    if met.value == 0:
        return ["No run met it", f"The condition that fails most often: {failing}"]
    return [
        f"{'Closest' if is_over else 'Best so far'}: {best}",
        f"The condition that fails most often there: {failing}",
    ]


def named(results: Sequence[RequirementResult], status: Status, words: str) -> list[str]:
    """Return a sentence about the teams of a status, the dearest first; none if there is none."""
    each = sorted((each for each in results if each.status == status), key=lambda each: -each.cost)
    if not each:
        return []
    labels = [result.label for result in each[:MAX_NAMED]]
    more = len(each) - len(labels)
    # A separator that labels do not contain: a team of two kinds has a comma in its label.
    separated = "; ".join([*labels, f"{more} more"] if more else labels)
    return [f"{separated}: {words}"]


def refuted(results: Sequence[RequirementResult], words: str) -> list[str]:
    """Return a sentence about refuted teams, which names the dearest; none if there is none."""
    each = [each for each in results if each.status == "refuted"]
    if not each:
        return []
    dearest = max(each, key=lambda result: result.cost)
    others = len(each) - 1
    more = f", and {others} other{'s' if others > 1 else ''}" if others else ""
    return [f"{dearest.label}{more}: {words}"]


def guarantee(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    *,
    is_over: bool,
) -> str:
    """Return the promise of an answer."""
    requirement = question.requirement
    share = percentage(requirement.probability)
    spare = spare_of(requirement)
    confidently = f"With {percentage(confidence)} confidence"
    is_certified = selected(results) is not None
    meets = f"the selected team meets the requirement in at least {share} of missions"
    if is_over and is_certified:
        cheaper = cheaper_teams(question.cost.strip())
        return f"{confidently}, {meets}, and {cheaper} meets it in {spare} or more."
    if is_over:
        return (
            f"{confidently}, no compared team meets the requirement in {spare} or more of missions."
        )
    if is_certified:
        return f"{confidently}, {meets}. Cheaper teams that are not decided may meet it as well."
    return "No guarantee: the study was stopped before a team was certified."


def cheaper_teams(cost: str) -> str:
    """Return words for the compared teams of a lower cost."""
    return CHEAPER.get(cost, f"no compared team of a lower cost ({cost})")

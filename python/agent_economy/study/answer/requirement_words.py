"""The answer about a requirement in words."""

import re
from collections.abc import Sequence

from agent_economy.scenario import Condition, Requirement
from agent_economy.study.answer.labels import listed, recommendation
from agent_economy.study.answer.requirement_results import RequirementResult, Status
from agent_economy.study.answer.verdict import Verdict, upper
from agent_economy.study.question import Cheapest
from agent_economy.study.selection import percentage

MINUTE_S = 60

CHEAPER = {"price": "no cheaper compared team", "robots": "no compared team with fewer robots"}
"""Teams of a lower cost in words: the promise covers those that were compared."""

MAX_NAMED = 5
"""Configurations that a sentence names individually."""


def requirement_verdict(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    obstacle: str,
) -> Verdict:
    """Return the answer in four lines."""
    requirement = question.requirement
    holds = listed([in_words(each) for each in requirement.conditions])
    low, high = percentage(requirement.probability), spare_of(requirement)
    chosen = next((each for each in results if each.status == "selected"), None)
    if chosen is None:
        first = "No compared team is certified."
        second = " ".join(f"{part}." for part in why(question, results)) or "There were no runs."
    else:
        first = f"{recommendation(chosen.values)}."
        met = chosen.met
        seen = f" ({met.value:.1%} of {chosen.runs:,} did)" if met else ""
        second = f"{upper(holds)} in at least {low} of missions{seen}."
    cheaper = [each for each in results if chosen is None or each.cost < chosen.cost]
    parts = refuted(cheaper, f"fewer than {high}") + named(cheaper, "open", "not decided")
    parts += named(cheaper, "impossible", f"cannot be run ({obstacle})")
    third = " ".join(f"{part}." for part in parts) or "No compared team is cheaper."
    between = f"shares from {low} to {high} are not distinguished"
    return first, second, third, f"{percentage(confidence)} confidence; {between}."


def spare_of(requirement: Requirement) -> str:
    """Return the required share with the tolerance."""
    return percentage(round(requirement.probability + requirement.tolerance, 12))


def sentence(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    obstacle: str,
) -> str:
    """Return the answer: which team to send, what it meets, and what is known of cheaper ones."""
    chosen = next((each for each in results if each.status == "selected"), None)
    requirement = question.requirement
    holds = listed([in_words(each) for each in requirement.conditions])
    share = percentage(requirement.probability)
    if chosen is None:
        none = f"No team is certified: {holds} in at least {share} of missions"
        parts = [none, *why(question, results)]
    else:
        confidently = f"({percentage(confidence)} confidence)"
        send = recommendation(chosen.values)
        parts = [f"{send}: {holds} in at least {share} of missions {confidently}"]
    spare = spare_of(requirement)
    cheaper = [each for each in results if chosen is None or each.cost < chosen.cost]
    parts += refuted(cheaper, f"fewer than {spare}")
    parts += named(cheaper, "open", "not decided")
    parts += named(results, "impossible", f"cannot be run ({obstacle})")
    if chosen is not None:
        parts += edge(question, chosen, results)
    return " ".join(f"{part}." for part in parts)


def edge(
    question: Cheapest, chosen: RequirementResult, results: Sequence[RequirementResult]
) -> list[str]:
    """Return a warning if the selected team is the cheapest compared; none for a single robot."""
    lowest = min(each.cost for each in results if each.is_possible)
    is_robots = question.cost.strip() == "robots"
    if chosen.cost > lowest or (is_robots and chosen.cost <= 1):
        return []
    fewer = "with fewer robots" if is_robots else "of a lower cost"
    return [f"No team {fewer} was compared; one may meet it as well"]


def why(question: Cheapest, results: Sequence[RequirementResult]) -> list[str]:
    """Return which team comes closest, and which condition fails most often in its missions."""
    known = [each for each in results if each.met is not None and each.is_possible]
    if not known:
        return []
    nearest = max(known, key=lambda each: each.met.value if each.met else 0.0)
    if nearest.met is None:
        return []
    met = f"{nearest.met.value:.1%} ({nearest.met.low:.1%} to {nearest.met.high:.1%})"
    worst = max(range(len(nearest.failing)), key=nearest.failing.__getitem__)
    condition = question.requirement.conditions[worst].text
    failing = f"{condition}, in {nearest.failing[worst]:.1%} of missions"
    return [
        f"Closest: {nearest.label}, in {met}",
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


def in_words(condition: Condition) -> str:
    """Return a condition in words, such as "success within 20 minutes" or "no collisions"."""
    name, value = condition.column.replace("_", " "), condition.value
    if event := re.match(r"time_until\((.*)\)\s*<=", condition.text):
        return f"{event[1]} within {duration(value)}"
    match condition.comparison, condition.column:
        case "<=", "time_s":
            return f"success within {duration(value)}"
        case "<=", _ if value == 0:
            return f"no {name}"
        case "<=", _:
            return f"at most {value:,.10g} {name}"
        case ">=", _ if condition.text.startswith(condition.column):
            return f"at least {value:,.10g} {name}"
        case _:
            return condition.text


def duration(seconds: float) -> str:
    """Return a duration as people write it: "90 s", "20 minutes"."""
    minutes = seconds / MINUTE_S
    is_written = minutes > 1 and minutes.is_integer()
    return f"{minutes:g} minutes" if is_written else f"{seconds:,.10g} s"


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
    is_certified = any(each.status == "selected" for each in results)
    meets = f"the selected team meets the requirement in at least {share} of missions"
    possible = "" if all(each.is_possible for each in results) else " that can be run"
    if is_over and is_certified:
        cheaper = cheaper_teams(question.cost.strip()) + possible
        return f"{confidently}, {meets}, and {cheaper} meets it in {spare} or more."
    if is_over:
        return (
            f"{confidently}, no compared team{possible} meets the requirement in {spare} or more "
            "of missions."
        )
    if is_certified:
        return f"{confidently}, {meets}. Cheaper teams that are not decided may meet it as well."
    return "No guarantee: the run budget was reached before a team was certified."


def cheaper_teams(cost: str) -> str:
    """Return words for the compared teams of a lower cost."""
    return CHEAPER.get(cost, f"no compared team of a lower cost ({cost})")

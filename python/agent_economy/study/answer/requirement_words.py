"""The answer about a requirement in words."""

from collections.abc import Sequence

from agent_economy.study.answer.labels import listed, recommendation
from agent_economy.study.answer.requirement_results import RequirementResult, Status
from agent_economy.study.question import Cheapest
from agent_economy.study.selection import percentage

MAX_NAMED = 5
"""Configurations that a sentence names individually."""


def sentence(
    question: Cheapest,
    results: Sequence[RequirementResult],
    confidence: float,
    obstacle: str,
) -> str:
    """Return the answer: which team to send, what it meets, and what is known of cheaper ones."""
    chosen = next((each for each in results if each.status == "selected"), None)
    requirement = question.requirement
    holds = listed([each.text for each in requirement.conditions])
    share = percentage(requirement.probability)
    if chosen is None:
        parts = [f"No team is certified: {holds} in at least {share} of missions", *why(question, results)]
    else:
        parts = [
            f"{recommendation(chosen.values)}: {holds} in at least {share} of missions "
            f"({percentage(confidence)} confidence)"
        ]
    spare = percentage(round(requirement.probability + requirement.tolerance, 12))
    cheaper = [each for each in results if chosen is None or each.cost < chosen.cost]
    parts += named(cheaper, "refuted", f"fewer than {spare}")
    parts += named(cheaper, "open", "not decided")
    parts += named(results, "impossible", f"cannot be run ({obstacle})")
    return " ".join(f"{part}." for part in parts)


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
    return [
        f"Closest: {nearest.label}, in {met}",
        f"The condition that fails most often there: {condition}, in "
        f"{nearest.failing[worst]:.1%} of missions",
    ]


def named(
    results: Sequence[RequirementResult], status: Status, words: str
) -> list[str]:
    """Return a sentence about the teams of a status, the dearest first; none if there is none."""
    each = sorted((each for each in results if each.status == status), key=lambda each: -each.cost)
    if not each:
        return []
    labels = [result.label for result in each[:MAX_NAMED]]
    more = len(each) - len(labels)
    # A separator that labels do not contain: a team of two kinds has a comma in its label.
    separated = "; ".join([*labels, f"{more} more"] if more else labels)
    return [f"{separated}: {words}"]


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
    spare = percentage(round(requirement.probability + requirement.tolerance, 12))
    confidently = f"With {percentage(confidence)} confidence"
    is_certified = any(each.status == "selected" for each in results)
    meets = f"the selected team meets the requirement in at least {share} of missions"
    if is_over and is_certified:
        return (
            f"{confidently}, {meets}, and no team with less {question.minimize} meets it in "
            f"{spare} or more."
        )
    if is_over:
        return f"{confidently}, no compared team meets the requirement in {spare} or more of missions."
    if is_certified:
        return f"{confidently}, {meets}. Cheaper teams that are not decided may meet it as well."
    return "No guarantee: the run budget was reached before a team was certified."

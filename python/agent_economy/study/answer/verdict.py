"""The verdict of a study: four lines that a reader takes in at a glance."""

import math
from collections.abc import Sequence

from agent_economy.scenario import Scenario
from agent_economy.study.answer import clearance
from agent_economy.study.answer.labels import alternatives, first, listed, recommendation
from agent_economy.study.answer.results import Ending, Result
from agent_economy.study.answer.study_answer import Verdict
from agent_economy.study.selection import percentage
from agent_economy.study.store.ledger import Answered

MAX_NAMED = 4
"""Configurations that a line names individually."""

OFTEN = 0.1
"""Of a configuration whose runs fail more often than this, the failures are stated first."""

MAX_IN_RUNS = 10**9
"""Failures are counted in at most this many runs."""


def verdict(
    scenario: Scenario, ending: Ending, results: Sequence[Result], delta: float, confidence: float
) -> Verdict:
    """Return the verdict of a study of the best by merit."""
    chosen = results[ending.best]
    fails = failures(chosen)
    send = recommendation(chosen.values)
    time_s = f"{chosen.time_s.value:,.3g} s on average"
    if fails_often(chosen.failed.value):
        first = f"{upper(fails)} even with the best compared team, {chosen.label}."
        second = f"{send} only if that is acceptable: a run takes {time_s}."
    else:
        first = f"{send}."
        second = f"A run takes {time_s}; {fails}."
    second = " ".join([second, *declarations(chosen.clearance)])
    third = " ".join([others(chosen, results, delta), *impossible(results, ending.obstacle)])
    return first, second, third, precision(scenario, delta, confidence)


def declarations(of: clearance.Clearance | None) -> list[str]:
    """Return a sentence about the lanes that a team declared clear; none without a lane."""
    return [f"{upper(clearance.in_words(of))}."] if of else []


def impossible(results: Sequence[Result], obstacle: str) -> list[str]:
    """Return a sentence about the configurations that cannot be run, if any, with the reason."""
    labels = [each.label for each in results if not each.is_possible]
    return (
        [f"Cannot be run: {listed(first(labels, MAX_NAMED, 'others'))} ({obstacle})."]
        if labels
        else []
    )


def fails_often(share: float) -> bool:
    """Return whether runs fail so often that the failures are stated first."""
    return share > OFTEN


def upper(words: str) -> str:
    """Return words with a capital at their beginning."""
    return words[:1].upper() + words[1:]


def failures(result: Result) -> str:
    """Return how often runs fail: "about 2 in 100 runs fail (1 to 4)", "none of 37 runs failed"."""
    failed = result.failed
    if failed.value == 0:
        return f"none of {result.runs:,} runs failed (up to {in_runs(failed.high)} may)"
    if failed.value == 1:
        return f"all of {result.runs:,} runs failed"
    runs = runs_with_one(failed.value)
    between = f"{two_figures(runs * failed.low)} to {two_figures(runs * failed.high)}"
    return f"about {two_figures(runs * failed.value)} in {runs:,} runs fail ({between})"


def in_runs(share: float) -> str:
    """Return a share of runs: "2.6 in 1,000"."""
    runs = runs_with_one(share)
    return f"{two_figures(runs * share)} in {runs:,}"


def runs_with_one(share: float) -> int:
    """Return 100 runs, or as many times ten more as have at least one of a share, up to 10^9.

    And not all, unless the share is 1.
    """
    runs = 100
    while runs < MAX_IN_RUNS and (runs * share < 1 or round(runs * share) == runs * (share < 1)):
        runs *= 10
    return runs


def two_figures(number: float) -> str:
    """Return a number as people round it: whole from 10 on, else with two figures, or zero."""
    if number >= 10:  # noqa: PLR2004
        return f"{number:,.0f}"
    return f"{number:.2g}" if number >= 0.01 else "0"  # noqa: PLR2004


def others(chosen: Result, results: Sequence[Result], delta: float) -> str:
    """Return which configurations do about as well, or how far behind the next one is."""
    behind = [
        (result.standing.behind.value, result)
        for result in results
        if result is not chosen and result.standing.behind
    ]
    if not behind:
        return "There was no other to compare."
    tied = [each.label for _, each in behind if each.standing.verdict == "tied"]
    if tied:
        verb = "does" if len(tied) == 1 else "do"
        return f"{upper(alternatives(first(tied, MAX_NAMED, 'others')))} {verb} about as well."
    value, nearest = min(behind, key=lambda pair: pair[0])
    if nearest.standing.verdict == "worse":
        return f"Next: {nearest.label}, worse by {value:.2g} merit."
    if value > 0:
        return f"Next: {nearest.label}, by {value:.2g} merit; which is better is not decided."
    return f"Next: {nearest.label}, {ahead(nearest, -value, delta)}."


def ahead(result: Result, lead: float, delta: float) -> str:
    """Return what is known of a configuration whose mean merit is not below the selected one's."""
    mean = f"a mean merit {lead:.2g} above" if lead else "the same mean merit as"
    known = "which is better is not decided"
    if result.standing.verdict == "not better":
        known = f"it is not better by more than {delta:g}"
    return f"with {mean} that of the selected one in their common runs; {known}"


def precision(scenario: Scenario, delta: float, confidence: float) -> str:
    """Return the confidence, and how many robots or seconds equal delta."""
    weights = {term.column: abs(term.weight) for term in scenario.merit.terms}
    units = {"robots": ("robot", "robots"), "time_s": ("s", "s")}
    amounts = {column: delta / weights[column] for column in units if column in weights}
    equals = [
        f"{two_digits(amount)} {units[column][0 if math.isclose(amount, 1) else 1]}"
        for column, amount in amounts.items()
    ]
    means = f" ({' or '.join(equals)})" if equals else ""
    return (
        f"{percentage(confidence)} confidence; differences under {delta:g} merit{means} were not "
        "looked for."
    )


def two_digits(number: float) -> str:
    """Return a number with two significant digits, without an exponent if it is large."""
    return f"{number:,.0f}" if number >= 100 else f"{number:.2g}"  # noqa: PLR2004


def repeated(questions: Sequence[Answered]) -> str:
    """Return what several questions about the same runs do to the error rate.

    Each promise is wrong with its own probability; together these add up at most.
    """
    error = min(1.0, sum(1 - each.confidence for each in questions))
    together = percentage(round(1 - error, 12))
    return (
        f"{len(questions)} questions were answered from these runs. Where an answer makes a "
        "promise, it holds with its own confidence; all promises together hold with a probability "
        f"of at least {together} only."
    )

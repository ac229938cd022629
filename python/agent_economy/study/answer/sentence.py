"""The answer in words."""

from collections.abc import Sequence

from agent_economy.scenario import Scenario
from agent_economy.shares import of_runs
from agent_economy.study.answer import clearance
from agent_economy.study.answer.labels import first, listed, recommendation
from agent_economy.study.answer.results import Ending, Result
from agent_economy.study.answer.ties import Verdict
from agent_economy.study.answer.verdict import upper
from agent_economy.study.paths import counted_kind, robot_kind

MAX_NAMED = 5
"""Configurations that a sentence names individually."""


def sentence(
    scenario: Scenario,
    delta: float,
    ending: Ending,
    results: Sequence[Result],
    *,
    has_prices: bool,
) -> str:
    """Return the answer: which team to send, its performance, and how close the others are."""
    chosen = results[ending.best]
    parts = [
        recommendation(chosen.values),
        *([f"The price of the team is {chosen.place.price:,.12g}"] if has_prices else []),
        performance(chosen),
        *([upper(clearance.in_words(chosen.clearance))] if chosen.clearance else []),
        *impossible(results, ending.obstacle),
        *named(results, {"tied"}, f"tied within {delta:g}"),
        *named(results, {"undecided", "not better"}, "too close to decide with these runs", delta),
        *published_choice(scenario, chosen, results),
        *edges(chosen, results),
    ]
    return " ".join(f"{part}." for part in parts)


def performance(result: Result) -> str:
    """Return the mean results of a configuration."""
    value, low, high = (
        f"{each:z.2f}" for each in (result.merit.value, result.merit.low, result.merit.high)
    )
    failed = of_runs(result.failed.value, result.runs, "runs", decimals=2)
    return (
        f"A run takes {result.time_s.value:.1f} s on average, {failed} fail, and the figure of "
        f"merit is {value} ({low} to {high})"
    )


def impossible(results: Sequence[Result], obstacle: str) -> list[str]:
    """Return a sentence about the configurations that cannot be run, if any, with the reason."""
    labels = [each.label for each in results if not each.is_possible]
    some = first(labels, MAX_NAMED, "more")
    return [f"Cannot be run: {listed(some)} ({obstacle})"] if labels else []


def named(
    results: Sequence[Result], verdicts: set[Verdict], words: str, max_behind: float = float("inf")
) -> list[str]:
    """Return a sentence about the configurations of some verdicts that are close enough, if any."""
    labels = [
        each.label
        for each in results
        if each.standing.verdict in verdicts
        and each.standing.behind
        and each.standing.behind.value < max_behind
    ]
    some = first(labels, MAX_NAMED, "more")
    return [f"{words.capitalize()}: {listed(some)}"] if labels else []


def published_choice(scenario: Scenario, chosen: Result, results: Sequence[Result]) -> list[str]:
    """Return a comparison with the published choice, if only a team size is varied."""
    published = scenario.published
    paths = list(chosen.values)
    if not published or len(paths) != 1 or robot_kind(paths[0]) is None:
        return []
    theirs = next((each for each in results if each.values[paths[0]] == published.choice), None)
    if theirs is None:
        return []
    if theirs is chosen:
        return [f"{published.source} selected the same team"]
    behind = theirs.standing.behind
    if behind is None or theirs.standing.verdict != "worse":
        return []
    loss = f"{behind.value:.3f} ({behind.low:.3f} to {behind.high:.3f})"
    return [f"The team that {published.source} selected, {theirs.label}, is worse by {loss}"]


def edges(chosen: Result, results: Sequence[Result]) -> list[str]:
    """Return a warning for each team size that was not compared with larger ones."""
    kinds = []
    for path, size in chosen.values.items():
        sizes = {each.values[path] for each in results if each.is_possible}
        if counted_kind(path) is not None and len(sizes) > 1 and size == max(sizes, key=float):
            kinds.append(counted_kind(path))
    return [
        f"No team with more {kind}s was compared; a larger team may be better" for kind in kinds
    ]

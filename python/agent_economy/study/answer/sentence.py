"""The answer in words."""

from collections.abc import Sequence

from agent_economy.scenario import Scenario
from agent_economy.study.answer.labels import listed, order, robot_kind
from agent_economy.study.answer.results import Result

NAMED = 5
"""Configurations that a sentence names one by one."""


def in_words(scenario: Scenario, delta: float, best: int, results: Sequence[Result]) -> str:
    """Return the answer: whom to send, what that gives, and how near the others are."""
    chosen = results[best]
    parts = [
        f"{order(chosen.values)}: {performance(chosen)}",
        *tied(results, delta),
        *too_close(results, delta),
        *published_choice(scenario, chosen, results),
        *edges(chosen, results),
    ]
    return "; ".join(parts) + "."


def performance(told: Result) -> str:
    """Return what a configuration does."""
    merit = told.merit
    return (
        f"a run takes {told.time_s.value:.1f} s on average, {told.failed.value:.2%} fail, figure "
        f"of merit {merit.value:.2f} ({merit.low:.2f} to {merit.high:.2f})"
    )


def tied(results: Sequence[Result], delta: float) -> list[str]:
    """Return which configurations are as good for sure."""
    names = [each.label for each in results if each.standing.verdict == "tied"]
    return [f"{listing(names)} as good within {delta:g}, for sure"] if names else []


def too_close(results: Sequence[Result], delta: float) -> list[str]:
    """Return which configurations seem as good, without the runs settling it."""
    names = [
        each.label
        for each in results
        if each.standing.verdict in {"undecided", "no better"}
        and each.standing.behind
        and each.standing.behind.value < delta
    ]
    return [f"{listing(names)} too close to call with these runs"] if names else []


def listing(names: list[str]) -> str:
    """Return names, not too many, as the subject of a sentence with its verb."""
    named = names if len(names) <= NAMED else [*names[:NAMED], f"{len(names) - NAMED} more"]
    return f"{listed(named)} {'is' if len(names) == 1 else 'are'}"


def published_choice(scenario: Scenario, chosen: Result, results: Sequence[Result]) -> list[str]:
    """Return how the published choice stands, where team size alone is varied."""
    published = scenario.published
    paths = list(chosen.values)
    if not published or len(paths) != 1 or robot_kind(paths[0]) is None:
        return []
    theirs = next((each for each in results if each.values[paths[0]] == published.choice), None)
    if theirs is None:
        return []
    if theirs is chosen:
        return [f"{published.source} chose the same"]
    behind = theirs.standing.behind
    if behind is None or theirs.standing.verdict != "worse":
        return []
    cost = f"{behind.value:.3f} of merit ({behind.low:.3f} to {behind.high:.3f})"
    return [f"the {published.choice} of {published.source} would cost {cost}"]


def edges(chosen: Result, results: Sequence[Result]) -> list[str]:
    """Return a warning for each team size that was not compared with larger ones."""
    kinds = []
    for path, size in chosen.values.items():
        sizes = {each.values[path] for each in results}
        if robot_kind(path) is not None and len(sizes) > 1 and size == max(sizes, key=float):
            kinds.append(robot_kind(path))
    return [
        f"no team with more {kind}s was compared, and one may be better still" for kind in kinds
    ]

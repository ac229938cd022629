"""The assumptions of an answer: scenario, design, seeds, bounds, versions."""

from collections.abc import Iterator

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.report.formatting import brief
from agent_economy.study.report.tables import written
from agent_economy.study.report.view import View
from agent_economy.study.versions import versions

MAX_LISTED = 12
"""Maximum number of values of a factor that are listed."""


def assumptions(view: View) -> Iterator[tuple[str, str]]:
    """Return the assumptions of an answer, each with its name."""
    answer = view.answer
    yield from scenario(answer)
    for path in view.varied:
        yield path, values(answer, path)
    yield "seed", f"{answer.seed}; a run number means the same random numbers in all configurations"
    yield "bounds", "the merit of a run has known bounds; no distribution is assumed"
    yield (
        "quarantine",
        "a run without a finite merit counts as the worst merit and is never omitted",
    )
    yield from versions().items()


def scenario(answer: Answer) -> Iterator[tuple[str, str]]:
    """Return the constant parts of the study."""
    constant = answer.scenario
    yield "scenario", constant.name
    yield "engine", constant.engine
    yield from constant.facts
    yield "design", constant.design


def values(answer: Answer, path: str) -> str:
    """Return the values of a varied factor."""
    found = list(dict.fromkeys(result.values[path] for result in answer.results))
    numbers = [value for value in found if not isinstance(value, str | bool)]
    if len(numbers) == len(found) > MAX_LISTED:
        return f"{len(found)} values from {brief(min(numbers))} to {brief(max(numbers))}"
    listed = [written(value) for value in found[:MAX_LISTED]]
    more = len(found) - len(listed)
    return ", ".join(listed) + (f" and {more} more" if more else "")

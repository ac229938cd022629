"""What an answer rests on: scenario, design, seeds, bounds, versions."""

from collections.abc import Iterator

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.report.tables import written
from agent_economy.study.report.view import View
from agent_economy.study.report.writing import brief
from agent_economy.study.versions import versions

MOST_VALUES = 12
"""Values of a factor that are listed one by one."""


def assumptions(view: View) -> Iterator[tuple[str, str]]:
    """Return what the answer rests on, each with its name."""
    answer = view.answer
    yield from scenario(answer)
    for path in view.varied:
        yield path, values(answer, path)
    yield "seed", f"{answer.seed}; a run has the same random numbers in all configurations"
    yield "bounds", "each configuration's merit lies in a known range: no distribution is assumed"
    yield (
        "quarantine",
        "a run without a finite merit counts as the worst there is, and is never left out",
    )
    yield from versions().items()


def scenario(answer: Answer) -> Iterator[tuple[str, str]]:
    """Return what does not change in a run."""
    given = answer.scenario
    yield "scenario", given.name
    yield "engine", given.engine
    yield from given.facts
    yield "design", given.design


def values(answer: Answer, path: str) -> str:
    """Return the values over which a factor was varied."""
    found = list(dict.fromkeys(result.values[path] for result in answer.results))
    numbers = [value for value in found if not isinstance(value, str | bool)]
    if len(numbers) == len(found) > MOST_VALUES:
        return f"{len(found)} values from {brief(min(numbers))} to {brief(max(numbers))}"
    listed = [written(value) for value in found[:MOST_VALUES]]
    more = len(found) - len(listed)
    return ", ".join(listed) + (f" and {more} more" if more else "")

"""The assumptions of an answer: scenario, design, seeds, bounds, versions."""

from collections.abc import Iterator

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.verdict import repeated
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.formatting import brief
from agent_economy.study.report.tables import written
from agent_economy.study.versions import versions

MAX_LISTED = 12
"""Maximum number of values of a factor that are listed."""


def assumptions(view: AnyView) -> Iterator[tuple[str, str]]:
    """Return the assumptions of an answer, each with its name."""
    answer = view.answer
    yield from scenario(answer)
    for path in view.varied:
        yield path, values(answer, path)
    for each in answer.agents:
        yield each.parameter, f"{each}; source {each.source[:16]}"
    yield "seed", f"{answer.seed}; a run number means the same random numbers in all configurations"
    yield from view.principles
    yield from questions(answer)
    yield from versions().items()


def questions(answer: AnyAnswer) -> Iterator[tuple[str, str]]:
    """Return the questions that were answered from the same runs, if there are several."""
    if len(answer.questions) > 1:
        yield "questions", "; ".join(each.words for each in answer.questions)
        yield "their promises", repeated(answer.questions)


def scenario(answer: AnyAnswer) -> Iterator[tuple[str, str]]:
    """Return the constant parts of the study."""
    constant = answer.scenario
    yield "scenario", constant.name
    yield "engine", constant.engine
    yield from constant.facts
    yield "design", constant.design


def values(answer: AnyAnswer, path: str) -> str:
    """Return the values of a varied factor."""
    found = list(dict.fromkeys(result.values[path] for result in answer.results))
    numbers = [value for value in found if not isinstance(value, str | bool)]
    if len(numbers) == len(found) > MAX_LISTED:
        return f"{len(found)} values from {brief(min(numbers))} to {brief(max(numbers))}"
    listed = [written(value) for value in found[:MAX_LISTED]]
    more = len(found) - len(listed)
    return ", ".join(listed) + (f" and {more} more" if more else "")

"""Reads the study that a page requests, and reports all errors at once."""

import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, TypeVar

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.scenario import Override, Scenario, validation
from agent_economy.scenario.source import check_path
from agent_economy.server.changed_values import declared_in
from agent_economy.server.messages import ONE_SOURCE, Error, errors_of, number, number_of_errors
from agent_economy.server.studies.factors import required
from agent_economy.server.workspace import Workspace
from agent_economy.study import Plan
from agent_economy.study.answer.labels import label
from agent_economy.study.check.arguments import check_question
from agent_economy.study.description import Description
from agent_economy.study.expression import Expression
from agent_economy.study.teams import names
from agent_economy.types import page

T = TypeVar("T")

MERIT, REQUIREMENT = "merit", "requirement"
"""The questions: the best by merit, and the cheapest that meets a requirement."""

FOREIGN = {
    MERIT: ("require", "probability", "tolerance", "minimize"),
    REQUIREMENT: ("delta", "guarantee", "runs", "merit"),
}
"""Parts of a request that belong to the other question."""

PATHS = {
    "merit": ("merit",),
    "design": ("study", "design"),
    "require": ("require", "all"),
    "probability": ("require", "probability"),
    "tolerance": ("require", "tolerance"),
    "minimize": ("study", "minimize"),
    "where": ("study", "where"),
}
"""Paths in a scenario of the parts of a request that replace its values."""

MAX_NAME = 60
"""Maximum length of the name of a scenario in that of a folder."""

MAX_LABELS = 50
"""Maximum number of configurations of a plan that are labelled."""


class StudyRequestError(Exception):
    """The study that a page requests has errors."""

    def __init__(self, errors: "Errors") -> None:
        """Keep the errors, and their total."""
        super().__init__(errors)
        self.errors, self.total = errors, errors.total


class Errors(list[Error]):
    """The first errors that each of several checks has found, and the total of all."""

    total = 0

    def gather(self, check: Callable[[], T]) -> T | None:
        """Return the result of a check, or keep its errors."""
        try:
            return check()
        except InputError as error:
            found = [each for row in errors_of(error) for each in by_line(row)]
            self.extend(found)
            self.total += max(len(found), number_of_errors(error))
            return None


def by_line(error: Error) -> list[Error]:
    """Return an error of several lines, as studies report them, as several with their paths."""
    if error["path"]:
        return [error]
    lines = str(error["message"]).splitlines()
    parts = map(path_and_message, lines)
    return [{**error, "path": path, "message": message} for path, message in parts]


def path_and_message(line: str) -> tuple[str, str]:
    """Return path and message of "delta = -1: must be ...", without a file and line before it.

    The path is empty if the line has none.
    """
    before, equals, _ = line.partition(" = ")
    origin, colon, path = before.rpartition(": ")
    is_path = bool(equals) and " " not in path
    if not is_path:
        return "", line
    return path, line.removeprefix(origin + colon)


def plan(request: Any, workspace: Workspace) -> Plan:
    """Return the plan of the study that a page requests.

    Raises:
        StudyRequestError: If it has errors; all at once.
        InputError: If the request is not an object.
    """
    validation.of_type("request", request, dict, "an object")
    errors = Errors()
    errors.gather(lambda: check_kind(request))
    scenario = errors.gather(lambda: scenario_of(request, workspace))
    changed = None
    if scenario is not None:
        changed = errors.gather(lambda: scenario.changed(overrides(request)))
        check_expressions(errors, request, scenario)
    if changed is not None and request.get("question") == REQUIREMENT:
        errors.gather(lambda: check_conditions(changed))
    seed = errors.gather(lambda: number("seed", request.get("seed", "0"))) or 0
    question = {name: request.get(name) for name in ("delta", "guarantee", "confidence", "runs")}
    if request.get("question") == MERIT and question["guarantee"] is None:
        question["guarantee"] = "indifference"
    guarantee = question["guarantee"]
    wanted = {**question, "guarantee": "indifference" if guarantee is None else guarantee}
    errors.gather(lambda: check_question(seed=seed, **wanted))
    if not errors and changed is not None:
        max_runs = request.get("max_runs")
        made = errors.gather(
            lambda: study.make_plan(changed, seed=seed, max_runs=max_runs, **question)
        )
        if made is not None:
            return made
    raise StudyRequestError(errors)


def check_kind(request: Mapping[str, Any]) -> None:
    """Check that a request has only what belongs to its question.

    Raises:
        InputError: If not.
    """
    kind = request.get("question")
    if kind is None:
        return
    is_known = isinstance(kind, str) and kind in FOREIGN
    validation.check(is_known, "question", kind, f"one of {', '.join(FOREIGN)}")
    for name in FOREIGN[kind]:
        given = request.get(name)
        validation.check(given is None, name, given, f"null with the question {kind!r}")


def check_conditions(scenario: Scenario) -> None:
    """Check that the scenario of a study of a requirement has conditions.

    Raises:
        InputError: If it has none.
    """
    allowed = "a list of at least one condition, such as time_s <= 1200"
    validation.check(scenario.requirement is not None, "require.all", [], allowed)


def check_expressions(errors: Errors, request: Mapping[str, Any], scenario: Scenario) -> None:
    """Check the expressions on teams that a request contains."""
    for name in ("where", "minimize"):
        text = request.get(name)
        if validation.is_text(text):
            errors.gather(partial(Expression, ".".join(PATHS[name]), text, names(scenario)))


def scenario_of(request: Mapping[str, Any], workspace: Workspace) -> Scenario:
    """Return the scenario that a request names or contains.

    Raises:
        InputError: If there is none, or it has errors.
    """
    name, text = request.get("scenario"), request.get("text")
    is_one = (name is None) != (text is None)
    validation.check(is_one, "request", [name, text], ONE_SOURCE)
    each: Any = name if text is None else text
    validation.check(validation.is_text(each), "request", each, "a string")
    return workspace.read(each, name_of(each)) if name is None else workspace.load(name)


def name_of(text: str) -> str:
    """Return the file name of a scenario that is sent, after which its study is named."""
    declared = declared_in(text)
    if declared is None:
        return "scenario.toml"
    name, changes = declared
    plain = re.sub(r"[^\w-]+", "-", name)[:MAX_NAME]
    return f"{plain}{'-changed' if changes else ''}.toml"


def overrides(request: Mapping[str, Any]) -> tuple[Override, ...]:
    """Return what a request overrides in the scenario.

    Raises:
        InputError: If a key or value is not allowed.
    """
    vary = request.get("vary") or {}
    validation.of_type("vary", vary, dict, "an object of values by path")
    for path, values in vary.items():
        check_path("vary", path)
        validation.check(
            validation.is_text(values), f"vary.{path}", values, 'a string such as "1..40"'
        )
    for name in ("merit", "design", "minimize", "where"):
        text = request.get(name)
        validation.check(text is None or validation.is_text(text), name, text, "a string")
    validation.of_type("require", request.get("require"), list | None, "a list of conditions")
    # They replace all factors of the scenario, not only those with the same paths.
    varied = [Override(("study", "vary"), vary, "vary")] if vary else []
    given = {name: request.get(name) for name in PATHS}
    return (
        *varied,
        *(Override(PATHS[name], value, name) for name, value in given.items() if value is not None),
    )


def planned(plan: Plan, name: str, state: page.StudyState | None) -> page.StudyPlan:
    """Return a plan as the page takes it; `name` is the id of its folder."""
    question = plan.question
    return {
        "id": name,
        "name": plan.scenario.name,
        "configurations": len(plan.configurations),
        "labels": [label(values) for values in plan.configurations[:MAX_LABELS]],
        "words": str(Description.of(plan)),
        "delta": question.delta,
        "confidence": plan.confidence,
        "guarantee": question.guarantee,
        "requirement": {**required(question.requirement), "minimize": plan.scenario.cost}
        if question.requirement
        else None,
        "merit": plan.scenario.merit.name,
        "factors": [
            {"path": each.path, "values": each.values, "range": each.range}
            for each in plan.scenario.factors
        ],
        "state": state,
    }

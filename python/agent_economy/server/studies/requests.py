"""What a page asks of a study, read: all that is wrong with it at once."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.scenario import Override, Scenario, validation
from agent_economy.scenario.source import check_path
from agent_economy.server.messages import Fault, faults_of, number, source_of
from agent_economy.server.workspace import Workspace
from agent_economy.study import Plan
from agent_economy.study.answer.labels import label
from agent_economy.study.plan import check_question
from agent_economy.study.question import Question

T = TypeVar("T")

MAX_LABELS = 50
"""Configurations of a plan that are named."""


class StudyRequestError(Exception):
    """What a page asks is not allowed."""

    def __init__(self, faults: list[Fault]) -> None:
        """Say all that is wrong."""
        super().__init__(faults)
        self.faults = faults


class Faults(list[Fault]):
    """What is wrong, found by several who look."""

    def gather(self, look: Callable[[], T]) -> T | None:
        """Return what one finds, or keep what it says is wrong."""
        try:
            return look()
        except InputError as error:
            self.extend(each for fault in faults_of(error) for each in by_line(fault))
            return None


def by_line(fault: Fault) -> list[Fault]:
    """Return a fault of several lines, as studies tell them, as several; each names its path."""
    if fault["path"]:
        return [fault]
    lines = str(fault["message"]).splitlines()
    return [{**fault, "message": line, "path": path_of(line)} for line in lines]


def path_of(line: str) -> str:
    """Return the path of "delta = -1: must be ...": nothing if a line begins with none."""
    path, equals, _ = line.partition(" = ")
    return path if equals and " " not in path else ""


def plan(said: Any, places: Workspace) -> Plan:
    """Return the plan that a page asks for.

    Raises:
        StudyRequestError: If anything is not allowed; all faults at once.
        InputError: If it is no object.
    """
    validation.of_kind("ask", said, dict, "an object")
    faults = Faults()
    scenario = faults.gather(lambda: scenario_of(said, places))
    changed = faults.gather(lambda: scenario.changed(changes(said))) if scenario else None
    seed = faults.gather(lambda: number("seed", said.get("seed", "0")))
    told = {name: said.get(name) for name in ("delta", "confidence", "runs")}
    told["guarantee"] = "indifference" if said.get("guarantee") is None else said["guarantee"]
    faults.gather(lambda: check_question(seed=seed or 0, **told))
    if not faults and changed is not None:
        made = faults.gather(
            lambda: study.make_plan(changed, seed=seed or 0, max_runs=said.get("max_runs"), **told)
        )
        if made is not None:
            return made
    raise StudyRequestError(faults)


def scenario_of(said: Mapping[str, Any], places: Workspace) -> Scenario:
    """Return the scenario that a page names, or the one of its text.

    Raises:
        InputError: If there is none, or it is wrong.
    """
    scenario, text = source_of("ask", said)
    return places.read(text or "") if scenario is None else places.load(scenario)


def changes(said: Mapping[str, Any]) -> tuple[Override, ...]:
    """Return what is asked, as values put over the scenario's.

    Raises:
        InputError: If something cannot be.
    """
    vary = said.get("vary") or {}
    validation.of_kind("vary", vary, dict, "an object of values by their paths")
    for path, values in vary.items():
        check_path("vary", path)
        validation.check(validation.is_text(values), f"vary.{path}", values, 'a text, as "1..40"')
    texts = {("merit",): said.get("merit"), ("study", "design"): said.get("design")}
    for path, text in texts.items():
        validation.check(text is None or validation.is_text(text), path[-1], text, "a text")
    # Together they are all that is varied: what the scenario varies besides stays as it is.
    varied = [Override(("study", "vary"), vary, "vary")] if vary else []
    told = [Override(path, text, path[-1]) for path, text in texts.items() if text is not None]
    return (*varied, *told)


def planned(plan: Plan, name: str, state: str | None) -> dict[str, Any]:
    """Return a plan as a page takes it; `name` is the id of its folder."""
    return {
        "id": name,
        "name": plan.scenario.name,
        "configurations": len(plan.configurations),
        "labels": [label(values) for values in plan.configurations[:MAX_LABELS]],
        "words": str(Question.of(plan)),
        "delta": plan.delta,
        "confidence": plan.confidence,
        "guarantee": plan.guarantee,
        "merit": plan.scenario.merit.name,
        "factors": [
            {"path": each.path, "values": each.values, "range": each.range}
            for each in plan.scenario.factors
        ],
        "state": state,
    }

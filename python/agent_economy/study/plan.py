"""The plan of a study: the configurations that it compares, and the guarantee that it must reach.

A plan is stored as `study.toml` in the study's folder, with the scenario's text and its overrides,
so that the study can be resumed from the folder alone.
"""

import hashlib
import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from agent_economy._core import InputError
from agent_economy.build import Build, own_build
from agent_economy.scenario import Override, Scenario, ScenarioWarning, Source, warnings
from agent_economy.scenario.origin import with_origin
from agent_economy.scenario.validation import check, errors_unless, is_whole, of_type, whole
from agent_economy.study import design, teams
from agent_economy.study.arguments import (
    FIRST_ANALYSIS_RUNS,
    MIN_CONFIDENCE,
    Floats,
    Guarantee,
    confidence_errors,
    question_errors,
)
from agent_economy.study.design import Values
from agent_economy.study.engine import Engine
from agent_economy.study.errors import StoreError
from agent_economy.study.question import Best, Cheapest, Question
from agent_economy.study.teams import compared

FORMAT = 1
"""Format version of study.toml."""

PART_OF_RANGE = 0.02
"""Default delta, as a part of the merit's range."""

MAX_RUNS = 10_000_000
"""Maximum fixed number of runs per configuration."""

MAX_SEED = 2**64 - 1

WITHOUT_RUNS = {"merit", "published", "require", "study", "summary"}
"""Keys of a scenario that do not affect runs; configurations are compared separately."""

HEADER = "# The question of this study. To resume it: agent-economy study --resume FOLDER\n\n"


@dataclass(frozen=True)
class Plan:
    """The question of a study.

    Attributes:
        scenario: The scenario that is varied.
        seed: Seed of all random numbers, 0 to 2^64 - 1.
        question: The question about the configurations.
        confidence: Confidence of the guarantee, and of all intervals together.
        runs: Fixed number of runs per configuration; None to stop when the answer is settled.
        max_runs: Run budget of all configurations together; None for no limit.
        configurations: The values of the varied factors of each configuration.
        engine: Runs the configurations.
        computed_by: The build that computes the runs, or has computed them.
    """

    scenario: Scenario
    seed: int
    question: Question
    confidence: float
    runs: int | None
    max_runs: int | None
    configurations: tuple[Values, ...]
    engine: Engine
    computed_by: Build = field(default_factory=own_build)

    def alone(self, configuration: int) -> Scenario:
        """Return the scenario with the values of one configuration; it has the same runs.

        Raises:
            InputError: If there is no such configuration.
        """
        whole("configuration", configuration, 0, len(self.configurations) - 1)
        values = self.configurations[configuration].items()
        return self.scenario.changed(
            tuple(Override(tuple(path.split(".")), value, "study") for path, value in values)
        )

    def text(self) -> str:
        """Return the text of study.toml."""
        source = self.scenario.source
        question = {
            **self.question.as_dict(self.confidence),
            "max_runs": self.max_runs,
        }
        data = {
            "identity": self.identity,
            "program": self.computed_by.program,
            "engine": self.computed_by.engine,
            "seed": str(self.seed),
            "runs": self.runs,
            "name": Path(source.file).name,
            "changes": [
                {"path": list(each.path), "value": each.value} for each in source.overrides
            ],
            "scenario": source.text,
            "files": {name: digest(data) for name, data in self.files.items()},
        }
        document = {
            "format": FORMAT,
            "question": without_none(question),
            "data": without_none(data),
        }
        return HEADER + tomli_w.dumps(document, multiline_strings=True)

    @cached_property
    def limits(self) -> Floats:
        """The range of what is recorded of each configuration; shape (configurations, 2).

        Raises:
            InputError: If a configuration is invalid.
        """
        if isinstance(self.question, Best):
            return self.engine.merit_limits()
        return np.tile([0.0, 1.0], (len(self.configurations), 1))

    @cached_property
    def costs(self) -> Floats:
        """The cost of each configuration, if the question is about the cheapest.

        Raises:
            InputError: If a configuration is invalid, or what is minimised.
        """
        cost = self.question.cost if isinstance(self.question, Cheapest) else "robots"
        return teams.costs(self.engine, cost)

    @cached_property
    def warnings(self) -> tuple[ScenarioWarning, ...]:
        """Warnings about the configurations, such as teams without room; one for similar ones."""
        if not self.scenario.factors:
            return self.scenario.warnings
        return warnings(self.scenario.source, self.configurations)

    @property
    def files(self) -> dict[str, bytes]:
        """The files that the scenario refers to, by name."""
        files = self.scenario.source.files.items()
        return {name: data for name, data in files if isinstance(data, bytes)}

    @cached_property
    def identity(self) -> str:
        """The hash of all that determines the runs: plans with the same identity share a folder.

        It covers the version of the program, the seed, the configurations in their order, the
        columns of a run, and the scenario except for the keys that affect only scores and
        descriptions. The columns depend on the whole design: they hold the times of as many finds
        as any of its item counts allows. It does not cover the engine: a folder of another build is
        refused, and not passed over for a new one.
        """
        document = self.scenario.to_dict()
        runs = {key: value for key, value in document.items() if key not in WITHOUT_RUNS}
        files = {name: digest(data) for name, data in self.files.items()}
        columns = [(column.name, column.kind) for column in self.engine.columns]
        made_of = [self.seed, self.runs, self.configurations, columns, runs, files]
        parts = [own_build().program, *made_of]
        text = json.dumps(parts, sort_keys=True, default=str)
        return hashlib.sha256(text.encode()).hexdigest()


def make(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario,
    *,
    seed: int = 0,
    delta: float | None = None,
    confidence: float | None = None,
    guarantee: Guarantee | None = None,
    runs: int | None = None,
    max_runs: int | None = None,
) -> Plan:
    """Return the plan of a scenario's study; None selects the scenario's value or the default.

    The question of a scenario with a requirement is the cheapest configuration that meets it,
    unless `delta`, `guarantee` or `runs` select the best by merit.

    Raises:
        InputError: If an argument or a configuration is invalid.
    """
    of_type("scenario", scenario, Scenario, "a Scenario")
    question: dict[str, Any] = {"confidence": confidence, "max_runs": max_runs}
    is_about_merit = (delta, guarantee, runs) != (None, None, None)
    if scenario.requirement is None or is_about_merit:
        question |= {"delta": delta, "guarantee": guarantee or "indifference"}
    plan = draft(scenario, seed=seed, runs=runs, **question)
    limits = plan.limits
    if isinstance(plan.question, Cheapest):
        check_requirement(plan)
    elif delta is None and scenario.delta is None:
        return replace(plan, question=replace(plan.question, delta=default_delta(limits)))
    return plan


def check_requirement(plan: Plan) -> None:
    """Check that every configuration of a plan can be compiled and has a cost, and all conditions.

    Raises:
        InputError: If not; or if a condition always or never holds in all configurations.
    """
    if not isinstance(plan.question, Cheapest):
        return
    found = error_of(lambda: plan.costs)
    found += error_of(lambda: check_conditions(plan.scenario, plan.engine))
    if found:
        raise InputError("\n".join(found))


def check_conditions(scenario: Scenario, engine: Engine) -> None:
    """Check that each condition of a requirement decides something, and any two of them together.

    Raises:
        InputError: If one does not; it lists all.
    """
    requirement = scenario.requirement
    if requirement is None:
        return
    kinds = {column.name: column.kind for column in engine.columns}
    limits = [engine.limits(each) for each in range(len(engine.configurations))]
    found = []
    for number, condition in enumerate(requirement.conditions):
        of_column = [each[condition.column] for each in limits]
        if fault := condition.triviality(of_column, kinds[condition.column]):
            found.append((number, f"{fault}: must be a condition that can hold and can fail"))
    for first, second in requirement.contradictions:
        other = requirement.conditions[first].text
        found.append((second, f"never holds together with {other!r}: change one of them"))
    texts = [condition.text for condition in requirement.conditions]
    lines = [
        f"{with_origin(scenario.source, 'require', 'all', number)} = {texts[number]!r}: {fault}"
        for number, fault in found
    ]
    if lines:
        raise InputError("\n".join(lines))


def check_expressions(scenario: Scenario, question: list[str], seed: int) -> None:
    """Check a question and the expressions of a scenario, before its configurations.

    Args:
        scenario: The scenario.
        question: The errors of the question.
        seed: Seed of the design.

    Raises:
        InputError: If there are errors; it lists all, also those of the conditions.
    """
    where, requirement = scenario.where, scenario.requirement
    found = [*question]
    found += error_of(lambda: where is None or teams.allowed_by(scenario, where))
    if requirement is not None:
        found += error_of(lambda: teams.cost_of(scenario, scenario.cost))
    if found and requirement is not None and is_whole(seed, 0, MAX_SEED):
        configurations = design.points(scenario.factors, scenario.design, seed)
        found += error_of(
            lambda: check_conditions(scenario, Engine(scenario, configurations, seed))
        )
    if found:
        raise InputError("\n".join(found))


def error_of(check: Callable[[], object]) -> list[str]:
    """Return the message of the error that a check finds, if it finds one."""
    try:
        check()
    except InputError as error:
        return [str(error)]
    return []


def default_delta(limits: Floats) -> float:
    """Return the default delta of a study."""
    return PART_OF_RANGE * float(limits[:, 1].max() - limits[:, 0].min()) or 1.0


def draft(  # noqa: PLR0913  (as in make)
    scenario: Scenario,
    *,
    seed: int,
    confidence: float | None,
    runs: int | None,
    max_runs: int | None,
    delta: float | None = None,
    guarantee: Guarantee | None = None,
) -> Plan:
    """Return a plan whose configurations are not checked; without `guarantee`, of a requirement.

    Raises:
        InputError: If an argument is invalid.
    """
    confidence = confidence if confidence is not None else scenario.confidence
    wanted = guarantee or "indifference"

    def question_check() -> None:
        check_question(seed=seed, delta=delta, confidence=confidence, guarantee=wanted, runs=runs)

    check_expressions(scenario, error_of(question_check), seed)
    configurations = compared(scenario, design.points(scenario.factors, scenario.design, seed))
    question: Question
    if guarantee is None and scenario.requirement is not None:
        question = Cheapest(scenario.requirement, scenario.cost)
        min_runs = FIRST_ANALYSIS_RUNS
    else:
        delta = delta if delta is not None else scenario.delta
        question = Best(float(delta if delta is not None else 1.0), wanted)
        min_runs = FIRST_ANALYSIS_RUNS * len(configurations)
    check_max_runs(max_runs, runs, min_runs)
    return Plan(
        scenario=scenario,
        seed=int(seed),
        question=question,
        confidence=float(confidence),
        runs=None if runs is None else int(runs),
        max_runs=None if max_runs is None else int(max_runs),
        configurations=configurations,
        engine=Engine(scenario, configurations, seed),
    )


def check_question(
    *, seed: int, delta: float | None, confidence: float | None, guarantee: str, runs: int | None
) -> None:
    """Check the question of a study; None selects the scenario's value.

    Raises:
        InputError: If an argument is invalid; it lists all errors.
    """
    confidence = MIN_CONFIDENCE if confidence is None else confidence
    errors = question_errors(1.0 if delta is None else delta, confidence, guarantee)
    errors += errors_unless(is_whole(seed, 0, MAX_SEED), "seed", seed, f"0 to {MAX_SEED}")
    is_allowed = runs is None or is_whole(runs, 2, MAX_RUNS)
    errors += errors_unless(is_allowed, "runs", runs, f"a whole number from 2 to {MAX_RUNS}")
    if errors:
        raise InputError("\n".join(errors))


def check_max_runs(max_runs: int | None, runs: int | None, min_runs: int) -> None:
    """Check a run budget: it must allow the first round, and excludes a fixed number of runs.

    Raises:
        InputError: If it is invalid.
    """
    if max_runs is None:
        return
    check(runs is None, "max_runs", max_runs, "left out if runs are given")
    allowed = f"a whole number of {min_runs} or more, the runs of the first round"
    check(is_whole(max_runs, min_runs, 2**62), "max_runs", max_runs, allowed)


def with_confidence(plan: Plan, confidence: float) -> Plan:
    """Return a plan with a higher confidence.

    Raises:
        InputError: If it is lower, or not below 1.
    """
    errors = confidence_errors(confidence)
    if not errors and confidence < plan.confidence:
        errors = [f"confidence = {confidence:g}: must be above the study's {plan.confidence:g}"]
    if errors:
        raise InputError("\n".join(errors))
    return replace(plan, confidence=float(confidence))


def digest(data: bytes) -> str:
    """Return the hash of a file's content."""
    return hashlib.sha256(data).hexdigest()


def read(text: str, file: str, content: Callable[[str], bytes]) -> Plan:
    """Return the plan of a study.toml.

    Args:
        text: Its text.
        file: Its path in error messages.
        content: Returns the content of a file by its digest.

    Raises:
        InputError: If it is not a study.toml, or one of a newer version.
    """
    try:
        document = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        message = f"{file}: is not a study: {error}"
        raise InputError(message) from None
    if document.get("format") != FORMAT:
        message = (
            f"{file}: format = {document.get('format')}: must be {FORMAT}: update this program?"
        )
        raise InputError(message)
    try:
        plan = of_document(document, content)
        if plan.identity == document["data"]["identity"]:
            return plan
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
        if isinstance(error, InputError):
            raise
        message = f"{file}: is damaged ({error!r}): restore it, or use another folder"
        raise InputError(message) from None
    message = (
        f"{file}: [data] was changed, or was written by another version of this program "
        f"({build_of(text)}; this one is {own_build()}), and does not match the stored runs: "
        "restore it, or use another folder"
    )
    raise InputError(message)


def of_document(document: Mapping[str, Any], content: Callable[[str], bytes]) -> Plan:
    """Return the plan of a parsed study.toml; its configurations were checked before."""
    data, question = document["data"], document["question"]
    overrides = tuple(
        Override(tuple(each["path"]), each["value"], "study.toml") for each in data["changes"]
    )
    files = {name: content(known) for name, known in data.get("files", {}).items()}
    best = {key: question[key] for key in ("delta", "guarantee") if key in question}
    return draft(
        Scenario.of(Source(data["name"], data["scenario"], overrides, files)),
        seed=int(data["seed"]),
        confidence=question["confidence"],
        runs=data.get("runs"),
        max_runs=question.get("max_runs"),
        **best,
    )


def build_of(text: str) -> Build:
    """Return the build that has computed the runs of a study.toml; its engine may be unknown."""
    data = tomllib.loads(text).get("data", {})
    return Build(str(data.get("program", "unknown")), data.get("engine"))


def may_replace(folder: Path, existing: str, requested: str) -> bool:
    """Return whether a study.toml may replace another one: both must have the same runs.

    Raises:
        StoreError: If another build has computed the existing runs.
    """
    if not is_same_data(existing, requested):
        return False
    check_build(folder, existing, build_of(requested))
    return True


def check_build(folder: Path, existing: str, build: Build) -> None:
    """Check that the runs of a study.toml are of a build.

    Raises:
        StoreError: If they are of another one.
    """
    if (stored := build_of(existing)) != build:
        message = (
            f"{folder}: its runs were computed by another build of this program ({stored}), this "
            f"one is {build}: install that build to continue the study, or compute all runs in "
            "another folder (--out)"
        )
        raise StoreError(message)


def is_same_data(one: str, other: str) -> bool:
    """Return whether two study.toml have the same runs; their questions may differ."""
    try:
        first, second = tomllib.loads(one), tomllib.loads(other)
        return first.get("format") == second.get("format") and (
            first.get("data", {}).get("identity") == second.get("data", {}).get("identity")
        )
    except (tomllib.TOMLDecodeError, RecursionError, AttributeError):
        return False


def without_none(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table without values of None, which TOML does not have."""
    return {key: value for key, value in table.items() if value is not None}

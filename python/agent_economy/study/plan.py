"""The plan of a study: the configurations that it compares, and the question about them.

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

import tomli_w

from agent_economy._core import InputError
from agent_economy.build import Build, own_build
from agent_economy.runs.python_brains import PARAMETERS, Brains, Controllers
from agent_economy.scenario import Override, Scenario, ScenarioWarning, Source, warnings
from agent_economy.scenario.validation import of_type, whole
from agent_economy.study.agents import StudyAgents, agents_of
from agent_economy.study.arguments import FIRST_ANALYSIS_RUNS, Guarantee, confidence_errors
from agent_economy.study.check.arguments import check_max_runs, raise_all
from agent_economy.study.check.request import StudyRequest
from agent_economy.study.design import Values
from agent_economy.study.engine import Engine
from agent_economy.study.errors import StoreError
from agent_economy.study.questions.best import Best
from agent_economy.study.questions.cheapest import Cheapest
from agent_economy.study.store.kind import check_study

Question = Best | Cheapest

FORMAT = 1
"""Format version of study.toml."""

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
        return self.engine.alone(configuration)

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
            **self.agents,
        }
        document = {
            "format": FORMAT,
            "question": without_none(question),
            "data": without_none(data),
        }
        return HEADER + tomli_w.dumps(document, multiline_strings=True)

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

    @property
    def agents(self) -> dict[str, dict[str, Any]]:
        """The brains and controllers in Python, by parameter."""
        return {
            each.parameter: {"names": each.names, "source": each.source}
            for each in self.engine.agents
        }

    @cached_property
    def identity(self) -> str:
        """The hash of all that determines the runs: plans with the same identity share a folder.

        It covers the version of the program, the seed, the configurations in their order, the
        columns of a run, the agents in Python with the hash of their source, and the scenario
        except for the keys that affect only scores and descriptions. The columns depend on the
        whole design: they hold the times of as many finds as any of its item counts allows. It does
        not cover the engine: a folder of another build is refused, and not passed over for a new
        one.
        """
        document = self.scenario.to_dict()
        runs = {key: value for key, value in document.items() if key not in WITHOUT_RUNS}
        files = {name: digest(data) for name, data in self.files.items()}
        columns = [(column.name, column.kind) for column in self.engine.columns]
        made_of = [self.seed, self.runs, self.configurations, columns, runs, files]
        if self.agents:
            made_of.append(self.agents)
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
    brains: Brains | str | None = None,
    controllers: Controllers | str | None = None,
) -> Plan:
    """Return the plan of a scenario's study; None selects the scenario's value or the default.

    The question of a scenario with a requirement is the cheapest configuration that meets it,
    unless `delta`, `guarantee` or `runs` select the best by merit. `brains` and `controllers` are
    as in `run`.

    Raises:
        InputError: If an argument or a configuration is invalid.
    """
    of_type("scenario", scenario, Scenario, "a Scenario")
    agents = agents_of(brains, controllers, scenario)
    request = StudyRequest(
        scenario, seed, delta, confidence, guarantee, runs, max_runs, agents=agents
    )
    return planned(request, is_new=True)


def planned(request: StudyRequest, *, is_new: bool) -> Plan:
    """Return the plan of a request.

    Raises:
        InputError: As `StudyRequest.checked`.
    """
    scenario, engine = request.scenario, request.checked(is_new=is_new)
    question: Question
    if scenario.requirement is not None and not request.is_about_merit:
        question = Cheapest(scenario.requirement, scenario.cost, request.finer)
    else:
        question = Best(
            request.delta_of(engine, is_new=is_new), request.guarantee or "indifference"
        )
    return Plan(
        scenario=scenario,
        seed=engine.seed,
        question=question,
        confidence=float(request.used_confidence),
        runs=None if request.runs is None else int(request.runs),
        max_runs=None if request.max_runs is None else int(request.max_runs),
        configurations=tuple(engine.configurations),
        engine=engine,
    )


def with_confidence(plan: Plan, confidence: float) -> Plan:
    """Return a plan with a higher confidence.

    Raises:
        InputError: If it is lower, or not below 1.
    """
    errors = confidence_errors(confidence)
    if not errors and confidence < plan.confidence:
        errors = [f"confidence = {confidence:g}: must be above the study's {plan.confidence:g}"]
    raise_all(errors)
    return replace(plan, confidence=float(confidence))


def decided(plan: Plan, *, reached: float | None = None, max_runs: int | None = None) -> Plan:
    """Return a plan that continues until cheaper teams are decided at a smaller tolerance.

    Args:
        plan: A plan of a requirement.
        reached: The tolerance at which it is answered; None for that of the requirement.
        max_runs: Run budget of all configurations together, the runs so far included; None for no
            limit.

    Raises:
        InputError: If the plan is of the best by merit, or the budget is invalid.
    """
    if not isinstance(plan.question, Cheapest):
        message = "decide: needs a requirement; the best by merit has no tolerance"
        raise InputError(message)
    check_max_runs(max_runs, None, FIRST_ANALYSIS_RUNS * len(plan.configurations))
    tolerance = plan.question.requirement.tolerance if reached is None else reached
    return replace(plan, question=plan.question.decided(tolerance), max_runs=max_runs)


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
        InputError: If it is not a study.toml, or that of a selection, or of a newer version.
    """
    check_study(file, text)
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
    request = StudyRequest(
        Scenario.of(Source(data["name"], data["scenario"], overrides, files)),
        seed=int(data["seed"]),
        delta=question.get("delta"),
        confidence=question["confidence"],
        guarantee=question.get("guarantee"),
        runs=data.get("runs"),
        max_runs=question.get("max_runs"),
        finer=question.get("finer"),
        agents=tuple(StudyAgents(each, **data[each]) for each in PARAMETERS if each in data),
    )
    return planned(request, is_new=False)


def build_of(text: str) -> Build:
    """Return the build that has computed the runs of a study.toml; its engine may be unknown."""
    data = tomllib.loads(text).get("data", {})
    return Build(str(data.get("program", "unknown")), data.get("engine"))


def may_replace(folder: Path, existing: str, requested: str) -> bool:
    """Return whether a study.toml may replace another one: both must have the same runs.

    Raises:
        StoreError: If another build has computed the existing runs.
        InputError: If they are those of a selection.
    """
    check_study(str(folder), existing)
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

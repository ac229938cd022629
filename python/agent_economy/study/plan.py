"""What is asked of a study: the configurations that it compares, and how sure it must be.

A plan is kept as `study.toml` in the study's folder, whole: the scenario's text and what was put
over it, so that the folder alone goes on.
"""

import hashlib
import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from agent_economy._core import InputError
from agent_economy.scenario import Override, Scenario, Source
from agent_economy.scenario.validation import check, errors_unless, is_whole, of_kind
from agent_economy.study import design
from agent_economy.study.arguments import (
    FIRST_LOOK,
    LEAST_CONFIDENCE,
    Floats,
    Guarantee,
    question_faults,
)
from agent_economy.study.design import Values
from agent_economy.study.engine import Engine

FORMAT = 1
"""Of study.toml."""

PART_OF_RANGE = 0.02
"""Of the merit's range: the delta of a study that is told none."""

MAX_RUNS = 10_000_000
"""Of each configuration, when their number is fixed beforehand."""

MAX_SEED = 2**64 - 1

WITHOUT_RUNS = {"merit", "published", "study", "summary"}
"""Keys of a scenario on which no run depends: configurations are counted apart."""

HEADER = "# What was asked of this study. Go on: agent-economy study --resume FOLDER\n\n"


@dataclass(frozen=True)
class Plan:
    """What is asked of a study.

    Attributes:
        scenario: What is run.
        seed: Of all random numbers, 0 to 2^64 - 1.
        delta: The difference of mean merits worth finding.
        confidence: Of the guarantee, and of all intervals together.
        guarantee: Which one, as `select_best` has it.
        runs: Of each configuration; None for as few as it takes.
        max_runs: Of all together, after which it stops without a guarantee; None for no end.
        configurations: The values in which each differs from the scenario.
        engine: What runs them.
    """

    scenario: Scenario
    seed: int
    delta: float
    confidence: float
    guarantee: Guarantee
    runs: int | None
    max_runs: int | None
    configurations: tuple[Values, ...]
    engine: Engine

    def alone(self, configuration: int) -> Scenario:
        """Return the scenario with the values of a configuration: its runs are the study's.

        Raises:
            InputError: If there is no such configuration.
        """
        last = len(self.configurations) - 1
        is_there = is_whole(configuration, 0, last)
        check(is_there, "configuration", configuration, f"a whole number from 0 to {last}")
        values = self.configurations[configuration].items()
        return self.scenario.changed(
            tuple(Override(tuple(path.split(".")), value, "study") for path, value in values)
        )

    def text(self) -> str:
        """Return study.toml."""
        source = self.scenario.source
        question = {
            "delta": self.delta,
            "confidence": self.confidence,
            "guarantee": self.guarantee,
            "max_runs": self.max_runs,
        }
        data = {
            "identity": self.identity,
            "program": version("agent-economy"),
            "seed": str(self.seed),
            "runs": self.runs,
            "name": Path(source.file).name,
            "changes": [
                {"path": list(each.path), "value": each.value} for each in source.overrides
            ],
            "scenario": source.text,
            "files": {name: digest(data) for name, data in self.files.items()},
        }
        document = {"format": FORMAT, "question": given(question), "data": given(data)}
        return HEADER + tomli_w.dumps(document, multiline_strings=True)

    @cached_property
    def limits(self) -> Floats:
        """Between which merits the runs of each configuration lie; shape (configurations, 2).

        Raises:
            InputError: If a configuration is not allowed.
        """
        return self.engine.merit_limits()

    @property
    def files(self) -> dict[str, bytes]:
        """The files that the scenario names, by their names."""
        files = self.scenario.source.files.items()
        return {name: data for name, data in files if isinstance(data, bytes)}

    @cached_property
    def identity(self) -> str:
        """Says which runs these are: two plans of one identity can share a folder.

        It covers all on which a run, or the numbers of runs asked for together, depends: the
        program, the seed, the configurations in their order, and the scenario but for what only
        scores and words depend on.
        """
        document = self.scenario.to_dict()
        runs = {key: value for key, value in document.items() if key not in WITHOUT_RUNS}
        files = {name: digest(data) for name, data in self.files.items()}
        parts = [version("agent-economy"), self.seed, self.runs, self.configurations, runs, files]
        text = json.dumps(parts, sort_keys=True, default=str)
        return hashlib.sha256(text.encode()).hexdigest()


def make(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario,
    *,
    seed: int = 0,
    delta: float | None = None,
    confidence: float | None = None,
    guarantee: Guarantee = "indifference",
    runs: int | None = None,
    max_runs: int | None = None,
) -> Plan:
    """Return the plan of a scenario's study; what is not given is the scenario's, or the default.

    Raises:
        InputError: If anything is not allowed.
    """
    plan = draft(
        scenario,
        seed=seed,
        delta=delta,
        confidence=confidence,
        guarantee=guarantee,
        runs=runs,
        max_runs=max_runs,
    )
    limits = plan.limits
    is_told = delta is not None or scenario.delta is not None
    return plan if is_told else replace(plan, delta=usual_delta(limits))


def usual_delta(limits: Floats) -> float:
    """Return the delta of a study that is told none."""
    return PART_OF_RANGE * float(limits[:, 1].max() - limits[:, 0].min()) or 1.0


def draft(  # noqa: PLR0913  (as in make)
    scenario: Scenario,
    *,
    seed: int,
    delta: float | None,
    confidence: float | None,
    guarantee: Guarantee,
    runs: int | None,
    max_runs: int | None,
) -> Plan:
    """Return a plan of which it is not known yet that each configuration is allowed.

    Raises:
        InputError: If anything else is not.
    """
    of_kind("scenario", scenario, Scenario, "a Scenario")
    sure = confidence if confidence is not None else scenario.confidence
    check_question(seed=seed, delta=delta, confidence=sure, guarantee=guarantee, runs=runs)
    configurations = tuple(design.points(scenario.factors, scenario.design, seed))
    check_max_runs(max_runs, runs, FIRST_LOOK * len(configurations))
    wanted = delta if delta is not None else scenario.delta
    return Plan(
        scenario=scenario,
        seed=int(seed),
        delta=float(wanted if wanted is not None else 1.0),
        confidence=float(sure),
        guarantee=guarantee,
        runs=None if runs is None else int(runs),
        max_runs=None if max_runs is None else int(max_runs),
        configurations=configurations,
        engine=Engine(scenario, configurations, seed),
    )


def check_question(
    *, seed: int, delta: float | None, confidence: float | None, guarantee: str, runs: int | None
) -> None:
    """See to what is asked of a scenario's study; None is for what the scenario says.

    Raises:
        InputError: If anything is not allowed; all faults at once.
    """
    sure = LEAST_CONFIDENCE if confidence is None else confidence
    faults = question_faults(1.0 if delta is None else delta, sure, guarantee)
    faults += errors_unless(is_whole(seed, 0, MAX_SEED), "seed", seed, f"0 to {MAX_SEED}")
    is_fixed = runs is None or is_whole(runs, 2, MAX_RUNS)
    faults += errors_unless(is_fixed, "runs", runs, f"a whole number from 2 to {MAX_RUNS}")
    if faults:
        raise InputError("\n".join(faults))


def check_max_runs(max_runs: int | None, runs: int | None, least: int) -> None:
    """Refuse an end before the first look, or one of a number of runs that is fixed.

    Raises:
        InputError: If it is so.
    """
    if max_runs is None:
        return
    check(runs is None, "max_runs", max_runs, "left out where runs are given")
    allowed = f"a whole number of {least} or more, {FIRST_LOOK} of each configuration"
    check(is_whole(max_runs, least, 2**62), "max_runs", max_runs, allowed)


def tightened(plan: Plan, confidence: float) -> Plan:
    """Return a plan that asks for a higher confidence.

    Raises:
        InputError: If it is not higher, or not below 1.
    """
    faults = question_faults(plan.delta, confidence, plan.guarantee)
    if not faults and confidence < plan.confidence:
        faults = [f"confidence = {confidence:g}: must be above the study's {plan.confidence:g}"]
    if faults:
        raise InputError("\n".join(faults))
    return replace(plan, confidence=float(confidence))


def digest(data: bytes) -> str:
    """Return what tells a file's content from any other."""
    return hashlib.sha256(data).hexdigest()


def read(text: str, file: str, content: Callable[[str], bytes]) -> Plan:
    """Return the plan of a study.toml.

    Args:
        text: Its text.
        file: How faults name it.
        content: Gives what is in a file by its digest.

    Raises:
        InputError: If it is none, or of a newer version.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = f"{file}: is not a study: {error}"
        raise InputError(message) from None
    if document.get("format") != FORMAT:
        message = f"{file}: format = {document.get('format')}: must be {FORMAT}; a newer program's?"
        raise InputError(message)
    try:
        found = of_document(document, content)
        if found.identity == document["data"]["identity"]:
            return found
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        message = f"{file}: is damaged ({error!r}): restore it, or start in another folder"
        raise InputError(message) from None
    message = (
        f"{file}: its [data] was changed, or is that of another version of this program "
        f"({document['data'].get('program')}): the runs beside it are others; restore it, or start "
        "in another folder"
    )
    raise InputError(message)


def of_document(document: Mapping[str, Any], content: Callable[[str], bytes]) -> Plan:
    """Return the plan of a parsed study.toml: that its configurations are allowed was seen to."""
    data, question = document["data"], document["question"]
    overrides = tuple(
        Override(tuple(each["path"]), each["value"], "study.toml") for each in data["changes"]
    )
    files = {name: content(known) for name, known in data.get("files", {}).items()}
    return draft(
        Scenario.of(Source(data["name"], data["scenario"], overrides, files)),
        seed=int(data["seed"]),
        delta=question["delta"],
        confidence=question["confidence"],
        guarantee=question["guarantee"],
        runs=data.get("runs"),
        max_runs=question.get("max_runs"),
    )


def is_same_data(one: str, other: str) -> bool:
    """Return whether two study.toml ask for the same runs, if perhaps another question of them."""
    try:
        first, second = tomllib.loads(one), tomllib.loads(other)
    except tomllib.TOMLDecodeError:
        return False
    return first.get("format") == second.get("format") and (
        first.get("data", {}).get("identity") == second.get("data", {}).get("identity")
    )


def given(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table without what is None: TOML has no such value."""
    return {key: value for key, value in table.items() if value is not None}

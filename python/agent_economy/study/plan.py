"""What is asked of a study: the configurations that it compares, and how sure it must be.

A plan is kept as `study.toml` in the study's folder, whole: the scenario's text and what was put
over it, so that the folder alone goes on.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomli_w

from agent_economy._core import InputError
from agent_economy.scenario import Override, Scenario
from agent_economy.study import design
from agent_economy.study.design import Values
from agent_economy.study.engine import Engine
from agent_economy.study.selection import Floats, Guarantee, is_whole, question_faults

FORMAT = 1
"""Of study.toml."""

PART_OF_RANGE = 0.02
"""Of the merit's range: the delta of a study that is told none."""

MAX_RUNS = 10_000_000
"""Of each configuration, when their number is fixed beforehand."""

MAX_SEED = 2**64 - 1

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
        configurations: The values in which each differs from the scenario.
        engine: What runs them.
        limits: Between which merits their runs lie; shape (configurations, 2).
    """

    scenario: Scenario
    seed: int
    delta: float
    confidence: float
    guarantee: Guarantee
    runs: int | None
    configurations: tuple[Values, ...]
    engine: Engine
    limits: Floats

    def text(self) -> str:
        """Return study.toml."""
        source = self.scenario.source
        changes = [
            {"path": list(each.path), "value": each.value, "origin": each.origin}
            for each in source.overrides
        ]
        data: dict[str, Any] = {"seed": str(self.seed), "name": Path(source.file).name}
        if self.runs is not None:
            data["runs"] = self.runs
        data["changes"] = changes
        question = {
            "delta": self.delta,
            "confidence": self.confidence,
            "guarantee": self.guarantee,
        }
        document = {
            "format": FORMAT,
            "question": question,
            "data": {**data, "scenario": source.text},
        }
        return HEADER + tomli_w.dumps(document, multiline_strings=True)


def make(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario,
    *,
    seed: int = 0,
    delta: float | None = None,
    confidence: float | None = None,
    guarantee: Guarantee = "indifference",
    runs: int | None = None,
) -> Plan:
    """Return the plan of a scenario's study; what is not given is the scenario's, or the default.

    Raises:
        InputError: If anything is not allowed.
    """
    sure = confidence if confidence is not None else scenario.confidence
    faults = question_faults(delta if delta is not None else 1.0, sure, guarantee)
    faults += [] if is_whole(seed, 0, MAX_SEED) else [f"seed = {seed!r}: must be 0 to {MAX_SEED}"]
    if runs is not None and not is_whole(runs, 2, MAX_RUNS):
        faults.append(f"runs = {runs!r}: must be a whole number from 2 to {MAX_RUNS}")
    if faults:
        raise InputError("\n".join(faults))
    configurations = tuple(design.points(scenario.factors, scenario.design, seed))
    engine = Engine(scenario, configurations, seed)
    limits = engine.merit_limits()
    span = float(limits[:, 1].max() - limits[:, 0].min())
    given = delta if delta is not None else scenario.delta
    return Plan(
        scenario=scenario,
        seed=seed,
        delta=given if given is not None else PART_OF_RANGE * span or 1.0,
        confidence=sure,
        guarantee=guarantee,
        runs=runs,
        configurations=configurations,
        engine=engine,
        limits=limits,
    )


def tightened(plan: Plan, confidence: float) -> Plan:
    """Return a plan that asks for another confidence.

    Raises:
        InputError: If it is not allowed.
    """
    return make(
        plan.scenario,
        seed=plan.seed,
        delta=plan.delta,
        confidence=confidence,
        guarantee=plan.guarantee,
        runs=plan.runs,
    )


def read(text: str, file: str) -> Plan:
    """Return the plan of a study.toml.

    Raises:
        InputError: If it is none, or of a newer version.
    """
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = f"{file}: is not a study: {error}"
        raise InputError(message) from None
    if document.get("format") != FORMAT:
        message = f"{file}: format = {document.get('format')}: must be {FORMAT}, else it is newer"
        raise InputError(message)
    try:
        return of_document(document)
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        message = f"{file}: is damaged ({error!r}): restore it, or start in another folder"
        raise InputError(message) from None


def of_document(document: Mapping[str, Any]) -> Plan:
    """Return the plan of a parsed study.toml."""
    data, question = document["data"], document["question"]
    overrides = tuple(
        Override(tuple(each["path"]), each["value"], each["origin"]) for each in data["changes"]
    )
    return make(
        Scenario.loads(data["scenario"], data["name"], overrides),
        seed=int(data["seed"]),
        delta=question["delta"],
        confidence=question["confidence"],
        guarantee=question["guarantee"],
        runs=data.get("runs"),
    )


def is_same_data(one: str, other: str) -> bool:
    """Return whether two study.toml ask for the same runs, if perhaps another question of them."""
    try:
        first, second = tomllib.loads(one), tomllib.loads(other)
    except tomllib.TOMLDecodeError:
        return False
    return all(first.get(part) == second.get(part) for part in ("format", "data"))

"""Brains and controllers in Python of a study: where they are defined, and runs with them.

A study stores their names and the hash of their source. Each process that computes runs imports
them by name, and refuses source with another hash.
"""

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import asdict, dataclass
from functools import cached_property, partial
from types import FunctionType
from typing import Any, TypeAlias

import numpy as np

from agent_economy._core import InputError
from agent_economy.api import finished
from agent_economy.runs.batch import Batch
from agent_economy.runs.python_brains import PARAMETERS, Brains, Controllers, unmade
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Scenario, validation
from agent_economy.study.errors import StudyError
from agent_economy.study.run_block import Columns, RunBlock
from agent_economy.study.user_code import load, name_of, reason, source_hash

IN_BATCH = "Batch("

Given: TypeAlias = Brains | Controllers | str
"""Brains or controllers by kind, or the name of such a dict, MODULE:NAME."""


@dataclass(frozen=True)
class StudyAgents:
    """The brains or the controllers of a study.

    Attributes:
        parameter: The parameter that they are given as: "brains" or "controllers".
        names: By kind, what makes them: MODULE:NAME, or Batch(MODULE:NAME) for a function on
            arrays.
        source: Hash of their source.
    """

    parameter: str
    names: Mapping[str, str]
    source: str

    @classmethod
    def of(cls, parameter: str, given: Given, scenario: Scenario) -> "StudyAgents":
        """Return the brains or controllers of a new study.

        Args:
            parameter: "brains" or "controllers".
            given: By kind, classes and functions at the top level of modules; or the name of such a
                dict, MODULE:NAME, whose entries may be anything that makes brains or controllers.
            scenario: The scenario, which has these kinds.

        Raises:
            InputError: If something is neither, or a kind does not exist; it lists all errors.
        """
        agents = by_kind(parameter, given)
        check_kinds(parameter, agents, scenario)
        if isinstance(given, str):
            names = {kind: f"{given}.{kind}" for kind in agents}
        else:
            found = (partial(full_name, f"{parameter}.{kind}", agents[kind]) for kind in agents)
            names = dict(zip(agents, validation.all_of(found), strict=True))
        return cls(parameter, names, source_hash(parameter, modules_of(names, agents)))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what was imported: other processes import it themselves."""
        return asdict(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore the attributes."""
        self.__dict__.update(state)

    def __str__(self) -> str:
        """Return the kinds with their names."""
        return ", ".join(f"{kind} = {name}" for kind, name in self.names.items())

    @cached_property
    def loaded(self) -> dict[str, Any]:
        """What makes them, by kind.

        Raises:
            InputError: If it cannot be imported here, or its source is another one.
        """
        with redirect_stdout(sys.stderr):
            agents = {
                kind: imported(f"{self.parameter}.{kind}", name)
                for kind, name in self.names.items()
            }
        source = source_hash(self.parameter, modules_of(self.names, agents))
        if source != self.source:
            message = (
                f"{self.parameter}: the source of {self} has changed since the study began (its "
                f"hash is {source[:16]}, that of the study {self.source[:16]}): restore it, or "
                "compute all runs in another folder (--out)"
            )
            raise InputError(message)
        return agents


def agents_of(
    brains: Brains | str | None, controllers: Controllers | str | None, scenario: Scenario
) -> tuple[StudyAgents, ...]:
    """Return the brains and the controllers of a new study, of those that are given.

    Raises:
        InputError: As `StudyAgents.of`.
    """
    given: dict[str, Given | None] = {"brains": brains, "controllers": controllers}
    calls = (
        partial(StudyAgents.of, parameter, each, scenario)
        for parameter, each in given.items()
        if each is not None
    )
    return tuple(validation.all_of(calls))


def outcomes(
    agents: Sequence[StudyAgents],
    scenarios: Mapping[int, Scenario],
    seed: int,
    block: RunBlock,
    columns: list[str],
) -> Columns:
    """Return the outcomes of a block of runs with agents in Python, one after the other.

    Args:
        agents: The brains and controllers.
        scenarios: The scenario of each configuration of the block.
        seed: Seed of all random numbers.
        block: The runs.
        columns: Names of the columns.

    Raises:
        StudyError: If a brain or controller raises an error.
        InputError: As `StudyAgents.loaded`.
    """
    table = {name: np.full(block.shape, np.nan) for name in columns}
    given: dict[str, Any] = {each.parameter: each.loaded for each in agents}
    for row, configuration in enumerate(block.configurations):
        create = partial(Simulation, scenarios[configuration], seed, threads=1, **given)
        for place in range(block.runs):
            run = block.first_run + place
            try:
                # What agents print must not mix with an answer for programs.
                with redirect_stdout(sys.stderr):
                    outcome = finished(create, run)
            except (Exception, SystemExit) as error:
                at = f"configuration {configuration}, run {run}"
                raise StudyError(failure(at, error)) from error
            for name, value in outcome.items():
                table[name][row, place] = value
    return table


def by_kind(parameter: str, given: Given) -> Mapping[str, Any]:
    """Return the dict by kinds that a parameter is, or that it names.

    Raises:
        InputError: If there is none.
    """
    allowed = PARAMETERS[parameter].by_kind
    validation.of_type(parameter, given, Mapping | str, f"{allowed}, or MODULE:NAME of one")
    if not isinstance(given, str):
        return given
    named: Mapping[str, Any] = load(parameter, given)
    validation.of_type(f"{parameter}: {given}", named, Mapping, allowed)
    return named


def check_kinds(parameter: str, agents: Mapping[str, Any], scenario: Scenario) -> None:
    """Check that brains or controllers are of kinds of a scenario, and can be made.

    Raises:
        InputError: If not; or if the engine of the scenario has none.
    """
    allowed = f"left out, or the scenario of the metric engine: classic robots have no {parameter}"
    validation.check(scenario.engine == "metric", parameter, list(agents), allowed)
    unmade(parameter, agents, scenario)


def full_name(subject: str, make: Any) -> str:
    """Return the name of what makes the agents of a kind.

    Raises:
        InputError: If it has none.
    """
    if isinstance(make, Batch):
        return f"{IN_BATCH}{name_of(subject, make.function)})"
    return name_of(subject, make)


def imported(subject: str, name: str) -> Any:
    """Return what makes the agents of a kind, by its name.

    Raises:
        InputError: If there is nothing of this name.
    """
    if name.startswith(IN_BATCH):
        return Batch(load(subject, name.removeprefix(IN_BATCH).removesuffix(")")))
    return load(subject, name)


def modules_of(names: Mapping[str, str], agents: Mapping[str, Any]) -> Iterator[str]:
    """Yield the modules that name agents, and those that define them."""
    named = (name.removeprefix(IN_BATCH).partition(":")[0] for name in names.values())
    for module in (*named, *map(module_of, agents.values())):
        if not module.startswith("agent_economy."):  # the build covers it
            yield module


def module_of(make: Any) -> str:
    """Return the module that defines what makes agents."""
    code: Any = make.function if isinstance(make, Batch) else make
    while isinstance(code, partial):
        code = code.func
    code = getattr(code, "__func__", code)  # of a method
    defined = code if isinstance(code, type | FunctionType) else type(code)
    return str(defined.__module__)


def failure(at: str, error: BaseException) -> str:
    """Return why a run failed, with the last line of the user's code."""
    notes = " ".join(getattr(error, "__notes__", ()))
    return f"{at}{', ' + notes if notes else ''}: {reason(error)}"

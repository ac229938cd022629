"""Brains and controllers in Python of a study: where they are defined, and runs with them.

A study stores the names of brains and the hash of their source. Each process that computes runs
imports them by name, and refuses source with another hash.
"""

import sys
from collections.abc import Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cached_property, partial
from types import FunctionType
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.api import finished
from agent_economy.runs.batch import Batch
from agent_economy.runs.python_brains import BY_KIND, Brains, Make, unmade
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Scenario, validation
from agent_economy.study.errors import StudyError
from agent_economy.study.run_block import Columns, RunBlock
from agent_economy.study.user_code import load, name_of, reason, source_hash

IN_BATCH = "Batch("


@dataclass(frozen=True)
class StudyBrains:
    """The brains of a study.

    Attributes:
        names: By kind, what makes its brains: MODULE:NAME, or Batch(MODULE:NAME) for a function on
            arrays.
        source: Hash of their source.
    """

    names: Mapping[str, str]
    source: str

    @classmethod
    def of(cls, brains: Brains | str, scenario: Scenario) -> "StudyBrains":
        """Return the brains of a new study.

        Args:
            brains: By kind, classes and functions at the top level of modules; or the name of such
                a dict, MODULE:NAME, whose entries may be anything that makes brains.
            scenario: The scenario, which has these kinds.

        Raises:
            InputError: If something is neither, or a kind does not exist.
        """
        validation.of_type("brains", brains, Mapping | str, f"{BY_KIND}, or MODULE:NAME of one")
        if isinstance(brains, str):
            given = load("brains", brains)
            validation.of_type(f"brains: {brains}", given, Mapping, BY_KIND)
            names = {kind: f"{brains}.{kind}" for kind in given}
        else:
            given, names = brains, {}
        check_kinds(given, scenario)
        names = names or {kind: full_name(kind, make) for kind, make in given.items()}
        return cls(names, source_hash("brains", modules_of(names, given)))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what was imported: other processes import it themselves."""
        return {"names": self.names, "source": self.source}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore the attributes."""
        self.__dict__.update(state)

    def __str__(self) -> str:
        """Return the kinds with their names."""
        return ", ".join(f"{kind} = {name}" for kind, name in self.names.items())

    @cached_property
    def loaded(self) -> Brains:
        """What makes the brains, by kind.

        Raises:
            InputError: If it cannot be imported here, or its source is another one.
        """
        with redirect_stdout(sys.stderr):
            brains = {kind: imported(f"brains.{kind}", name) for kind, name in self.names.items()}
        source = source_hash("brains", modules_of(self.names, brains))
        if source != self.source:
            message = (
                f"brains: the source of {self} has changed since the study began (its hash is "
                f"{source[:16]}, that of the study {self.source[:16]}): restore it, or compute all "
                "runs in another folder (--out)"
            )
            raise InputError(message)
        return brains

    def outcomes(
        self, scenarios: Mapping[int, Scenario], seed: int, block: RunBlock, columns: list[str]
    ) -> Columns:
        """Return the outcomes of a block of runs, one after the other.

        Args:
            scenarios: The scenario of each configuration of the block.
            seed: Seed of all random numbers.
            block: The runs.
            columns: Names of the columns.

        Raises:
            StudyError: If a brain raises an error.
            InputError: As `loaded`.
        """
        table = {name: np.full(block.shape, np.nan) for name in columns}
        for row, configuration in enumerate(block.configurations):
            scenario, brains = scenarios[configuration], self.loaded
            create = partial(Simulation, scenario, seed, threads=1, brains=brains)
            for place in range(block.runs):
                run = block.first_run + place
                try:
                    # What brains print must not mix with an answer for programs.
                    with redirect_stdout(sys.stderr):
                        outcome = finished(create, run)
                except (Exception, SystemExit) as error:
                    at = f"configuration {configuration}, run {run}"
                    raise StudyError(failure(at, error)) from error
                for name, value in outcome.items():
                    table[name][row, place] = value
        return table


def check_kinds(brains: Brains, scenario: Scenario) -> None:
    """Check that brains are of kinds of a scenario, and can be made.

    Raises:
        InputError: If not; or if the engine of the scenario has no brains.
    """
    allowed = "left out, or the scenario of the metric engine: classic robots have no brains"
    validation.check(scenario.engine == "metric", "brains", list(brains), allowed)
    metric = scenario.metric()
    for each in unmade(brains, scenario):
        _core.body(metric, "brains", each.kind)


def full_name(kind: str, make: Make | Batch) -> str:
    """Return the name of what makes the brains of a kind.

    Raises:
        InputError: If it has none.
    """
    if isinstance(make, Batch):
        return f"{IN_BATCH}{name_of(f'brains.{kind}', make.function)})"
    return name_of(f"brains.{kind}", make)


def imported(subject: str, name: str) -> Make | Batch:
    """Return what makes the brains of a kind, by its name.

    Raises:
        InputError: If there is nothing of this name.
    """
    if name.startswith(IN_BATCH):
        return Batch(load(subject, name.removeprefix(IN_BATCH).removesuffix(")")))
    make: Make | Batch = load(subject, name)
    return make


def modules_of(names: Mapping[str, str], brains: Brains) -> Iterator[str]:
    """Yield the modules that name brains, and those that define them."""
    named = (name.removeprefix(IN_BATCH).partition(":")[0] for name in names.values())
    for module in (*named, *map(module_of, brains.values())):
        if not module.startswith("agent_economy."):  # the build covers it
            yield module


def module_of(make: Make | Batch) -> str:
    """Return the module in which a brain is defined."""
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

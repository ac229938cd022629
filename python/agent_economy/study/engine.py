"""Runs the configurations of a study on the simulator of its scenario."""

import os
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from agent_economy import _core
from agent_economy.scenario import Override, Scenario
from agent_economy.study.agents import StudyAgents, outcomes
from agent_economy.study.arguments import Floats
from agent_economy.study.design import Values
from agent_economy.study.executors import (
    LocalExecutor,
    dask_executor,
    end_unguarded_worker,
    warn,
)
from agent_economy.study.run_block import Columns, Compute, Part, Partwise, RunBlock
from agent_economy.study.store.columns import Column
from agent_economy.study.workers import Workers


@dataclass(frozen=True)
class Engine:
    """The configurations of a study, ready to run; it can be pickled for another process.

    Attributes:
        scenario: The scenario that they vary.
        configurations: The values of the varied factors of each.
        seed: Seed of all random numbers.
        threads: Number of threads; None for one per processor.
        agents: Brains and controllers in Python that replace those of the scenario.
    """

    scenario: Scenario
    configurations: Sequence[Values]
    seed: int
    threads: int | None = None
    agents: tuple[StudyAgents, ...] = ()

    def __getstate__(self) -> dict[str, object]:
        """Leave out compiled configurations: they are compiled again where they are needed."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore the attributes."""
        self.__dict__.update(state)

    def in_processes(self, count: int) -> Workers:
        """Return processes of this machine, one thread each; use as a context manager.

        Each process imports the script that calls this, which must guard its code with
        `if __name__ == "__main__":`.
        """
        end_unguarded_worker()
        return Workers(lambda: LocalExecutor(count), count, replace(self, threads=1))

    def on_dask(self, address: str, on_wait: Callable[[str], None] = warn) -> Workers:
        """Return the workers of a Dask cluster; use as a context manager.

        Args:
            address: Address of its scheduler, such as tcp://HOST:8786.
            on_wait: Called with a sentence, in another thread, while runs wait because the cluster
                has no workers; a warning by default.

        Raises:
            InputError: If no scheduler answers at the address within ten seconds, Dask is not
                installed, or a worker has another build of this program or none.
        """
        made = iter([dask_executor(address, on_wait)])
        return Workers(
            lambda: next(made, None) or dask_executor(address, on_wait), 1, replace(self, threads=1)
        )

    @contextmanager
    def on_this_machine(self) -> Iterator[Compute]:
        """Compute on all processors: in threads, or with agents in Python in processes."""
        if not self.agents:
            yield self
            return
        with self.in_processes(os.cpu_count() or 1) as workers:

            def parts(block: RunBlock) -> Generator[Part]:
                # Here first, where an error is found before any process starts.
                _ = [each.loaded for each in self.agents]
                yield from workers.columns.parts(block)

            yield Partwise(parts)

    def alone(self, configuration: int) -> Scenario:
        """Return the scenario with the values of one configuration; it has the same runs."""
        values = self.configurations[configuration].items()
        return self.scenario.changed(
            tuple(Override(tuple(path.split(".")), value, "study") for path, value in values)
        )

    @cached_property
    def _alone(self) -> dict[int, Scenario]:
        return {}

    @cached_property
    def _made(self) -> dict[int, _core.Configuration]:
        return {}

    def _compiled(self, configuration: int) -> _core.Configuration:
        if configuration not in self._made:
            values = self.configurations[configuration]
            self._made[configuration] = self.scenario.configuration(values)
        return self._made[configuration]

    @property
    def columns(self) -> tuple[Column, ...]:
        """The columns of every run."""
        return tuple(Column(name, kind) for name, kind, _, _ in self._compiled(0).columns)

    def limits(self, configuration: int) -> dict[str, tuple[float, float]]:
        """Return the range of each column of a configuration."""
        return {
            name: (
                -np.inf if lowest is None else lowest,
                np.inf if highest is None else highest,
            )
            for name, _, lowest, highest in self._compiled(configuration).columns
        }

    @cached_property
    def costs(self) -> dict[str, Floats]:
        """The costs of all configurations that are known already, by their expression."""
        return {}

    @cached_property
    def merit_limits(self) -> Floats:
        """Return the range of the merit of each configuration, shape (configurations, 2)."""
        limits = [self.limits(index) for index in range(len(self.configurations))]
        return np.array([self.scenario.merit.bounds(each) for each in limits])

    def __call__(self, block: RunBlock) -> Columns:
        """Return the outcomes of a block of runs."""
        if self.agents:
            return self._with_agents(block)
        compiled = [self._compiled(each) for each in block.configurations]
        return _core.run_block(
            compiled,
            seed=self.seed,
            first_run=block.first_run,
            runs=block.runs,
            threads=self.threads,
        )

    def _with_agents(self, block: RunBlock) -> Columns:
        for each in block.configurations:
            if each not in self._alone:
                self._alone[each] = self.alone(each)
        names = [column.name for column in self.columns]
        return outcomes(self.agents, self._alone, self.seed, block, names)

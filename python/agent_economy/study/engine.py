"""What runs a study's configurations: the simulator that the scenario names."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from agent_economy import _core
from agent_economy.scenario import Scenario
from agent_economy.study.arguments import Floats
from agent_economy.study.design import Values
from agent_economy.study.executors import LocalExecutor, dask_executor
from agent_economy.study.rectangle import Columns, Rectangle
from agent_economy.study.store.columns import Column
from agent_economy.study.workers import Workers


@dataclass(frozen=True)
class Engine:
    """The configurations of a study, ready to run; it can be sent to another process.

    Attributes:
        scenario: What they differ from.
        configurations: The values in which each differs.
        seed: Of all random numbers.
        threads: That it uses; None for as many as there are processors.
    """

    scenario: Scenario
    configurations: Sequence[Values]
    seed: int
    threads: int | None = None

    def __getstate__(self) -> dict[str, object]:
        """Leave out what is compiled: it is made again where it is needed."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    def __setstate__(self, state: dict[str, object]) -> None:
        """Take what another process sent."""
        self.__dict__.update(state)

    def in_processes(self, count: int) -> Workers:
        """Return processes of this machine that compute, one thread each; use it in a `with`."""
        return Workers(lambda: LocalExecutor(count), count, replace(self, threads=1))

    def on_dask(self, address: str) -> Workers:
        """Return a Dask cluster's workers; use it in a `with`.

        Raises:
            InputError: If no scheduler answers at the address, or Dask is not installed.
        """
        executor = dask_executor(address)
        made = iter([executor])
        count = max(1, executor.count)
        return Workers(
            lambda: next(made, None) or dask_executor(address), count, replace(self, threads=1)
        )

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
        """What every run tells."""
        return tuple(Column(name, kind) for name, kind, _, _ in self._compiled(0).columns)

    def limits(self, configuration: int) -> dict[str, tuple[float, float]]:
        """Return between which values each column of a configuration lies."""
        return {
            name: (
                -np.inf if least is None else least,
                np.inf if greatest is None else greatest,
            )
            for name, _, least, greatest in self._compiled(configuration).columns
        }

    def merit_limits(self) -> Floats:
        """Return between which merits the runs of each configuration lie: (configurations, 2)."""
        limits = [self.limits(index) for index in range(len(self.configurations))]
        return np.array([self.scenario.merit.bounds(each) for each in limits])

    def __call__(self, rectangle: Rectangle) -> Columns:
        """Return the outcomes of a rectangle."""
        compiled = [self._compiled(each) for each in rectangle.configurations]
        return _core.run_block(
            compiled,
            seed=self.seed,
            first_run=rectangle.first_run,
            runs=rectangle.runs,
            threads=self.threads,
        )

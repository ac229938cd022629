"""The outcome of a run over time, in bounded memory."""

from collections.abc import Iterator
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from agent_economy.runs.outcome import Columns, table
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario
from agent_economy.types.page import Series

MAX_ROWS = 2000
"""Maximum number of rows; when there are more, every second one is dropped."""

FIRST_INTERVAL = 20
"""Initial steps between two rows without a change of a count."""


class Row(NamedTuple):
    """The outcome at a tick.

    Attributes:
        tick: That tick.
        is_find: Whether an item was found in the step before it.
        values: The values of the compiled run, from which the outcome follows.
        columns: What these values mean.
        scenario: The scenario at the tick.
    """

    tick: int
    is_find: bool
    values: dict[str, float]
    columns: Columns
    scenario: Scenario


class OutcomeSeries:
    """The outcome at each change of a count, and at evenly spaced ticks.

    If counts change so often that there are too many rows, changes and even rows get further apart;
    finds of items are kept, unless they alone are too many.

    Attributes:
        until: The tick to which the outcome is known.
    """

    until: int

    def __init__(self) -> None:
        """Begin without rows."""
        self.until = -1
        self._rows: list[Row] = []
        self._counts: tuple[int, int] | None = None
        # Minimum steps between two changes that are kept, and steps between even rows.
        self._spacing, self._interval = 1, FIRST_INTERVAL
        self._left = 0

    def copy(self) -> "OutcomeSeries":
        """Return a copy."""
        copy = OutcomeSeries()
        copy.until, copy._rows, copy._counts = self.until, list(self._rows), self._counts
        copy._spacing, copy._interval, copy._left = self._spacing, self._interval, self._left
        return copy

    def note(self, simulation: Stepped) -> None:
        """Keep the current outcome, if it is of interest; called after each step.

        It is called more often than anything else: `until` is set by the caller.
        """
        self._left -= 1
        counts = simulation._run.counts  # noqa: SLF001  (ours)
        if self._left <= 0 or counts != self._counts:
            self._keep(simulation, counts)

    def discard_from(self, tick: int) -> None:
        """Forget all rows from a tick on: the run will be another one."""
        self._rows = [row for row in self._rows if row.tick < tick]
        self.until = min(self.until, tick - 1)
        self._counts = None

    def since(self, tick: int) -> Series:
        """Return the rows from a tick on."""
        rows = [row for row in self._rows if row.tick >= tick]
        outcomes = list(outcomes_of(rows))
        columns = list(dict.fromkeys(name for outcome in outcomes for name in outcome))
        return {
            "type": "series",
            "since": tick,
            "columns": columns,
            "rows": [
                {"tick": row.tick, "values": [outcome.get(name) for name in columns]}
                for row, outcome in zip(rows, outcomes, strict=True)
            ],
        }

    def _keep(self, simulation: Stepped, counts: tuple[int, int]) -> None:
        tick, last = simulation.tick, self._rows[-1] if self._rows else None
        is_find = self._counts is None or counts[0] != self._counts[0]
        is_near = last is not None and tick - last.tick < self._spacing
        if is_near and not is_find and self._left > 0:
            return
        self._counts, self._left = counts, self._interval
        run, scenario = simulation._run, simulation.scenario  # noqa: SLF001  (ours)
        columns = last.columns if last and last.scenario is scenario else run.columns
        self._rows.append(Row(tick, is_find, run.outcome() or {}, columns, scenario))
        if len(self._rows) > MAX_ROWS:
            self._thin()

    def _thin(self) -> None:
        self._spacing, self._interval = 2 * self._spacing, 2 * self._interval
        keeps_finds = sum(row.is_find for row in self._rows) <= MAX_ROWS // 2
        self._rows = [
            row for i, row in enumerate(self._rows) if i % 2 == 0 or (keeps_finds and row.is_find)
        ]


def outcomes_of(rows: list[Row]) -> Iterator[dict[str, float]]:
    """Return the numbers of the outcome of each row."""
    for _, group in groupby(rows, lambda row: id(row.scenario)):
        same = list(group)
        columns, merit = same[0].columns, same[0].scenario.merit
        values = {
            name: np.array([row.values.get(name, np.nan) for row in same]) for name, *_ in columns
        }
        for row in table(columns, values, merit, 0).drop_columns("run").to_pylist():
            yield numbers(row)


def numbers(row: dict[str, Any]) -> dict[str, float]:
    """Return the values of an outcome that are numbers."""
    return {
        name: value
        for name, value in row.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }

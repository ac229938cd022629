"""Runs of a scenario, of whatever engine: one, or a table of many."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy.merit import Merit
from agent_economy.scenario import Scenario, loaded

Status = Literal["complete", "incomplete", "quarantined", "running"]

Columns = Sequence[tuple[str, str, float | None, float | None]]
"""What an engine's runs tell: name, kind, least and greatest of each column."""

MINE = ("time_s", "failed")
"""Columns of every engine that a table of runs has in front, or under another name."""


@dataclass(frozen=True)
class Outcome:
    """What a run gave; None where it gave nothing, as for what its engine does not tell.

    Attributes:
        run: Its number.
        status: "complete": all that is sought was found. "incomplete": not so. "quarantined": the
            world had no room for the team or its items, or numbers went beyond all bounds; the run
            gave nothing. "running": of a `Simulation` that is not over; all is as if it ended now.
        time_s: Until the last find; the scenario's cap if the run is not complete.
        complete: Whether all that is sought was found.
        merit: The run's score in the scenario's figure of merit.
        found: Items found, by kind. Of an engine whose items have no kinds: all, as "item".
        missed: Items not found, by kind.
        robots: Team size.
        price: Of the team.
        false_alarms: Finds of nothing.
        collisions: New contacts of two robots, or of a robot with what stands; for the classic
            engine, robot-decisions spent on a shared cell.
        energy_j: Of all robots.
        distance_m: Of all robots.
        robots_stopped: Robots that could not go on: empty or broken.
        row: All of it as `replicate` has it, by column.
    """

    run: int
    status: Status
    time_s: float | None
    complete: bool | None
    merit: float | None
    found: dict[str, int | None]
    missed: dict[str, int | None]
    robots: int | None
    price: float | None
    false_alarms: int | None
    collisions: int | None
    energy_j: float | None
    distance_m: float | None
    robots_stopped: int | None
    row: dict[str, Any] = field(repr=False)

    @classmethod
    def of(cls, row: dict[str, Any], status: Status | None = None) -> "Outcome":
        """Return a row of a table of runs as an outcome."""
        told: dict[str, Any] = {name: row.get(name) for name in cls.__dataclass_fields__}
        told |= {name: by_kind(row, name) for name in ("found", "missed")}
        told |= {"status": status or status_of(row), "row": row}
        return cls(**told)


def run(scenario: Scenario | str | Path, seed: int = 0, run: int = 0) -> Outcome:
    """Run a scenario once; Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of one that ships.
        seed: Of all chance, 0 to 2^64 - 1.
        run: Its number, 0 to 2^63 - 10,000,001; each is another world.

    Returns:
        The same, on any machine, as row `run` of `replicate`.

    Raises:
        InputError: If the scenario is wrong, or an argument out of range; all faults at once.
    """
    scenario = loaded(scenario)
    configuration = scenario.configuration({})
    given = _core.run_one(configuration, seed=seed, run=run)
    values = {name: np.array([value]) for name, value in given.items()}
    return Outcome.of(table(configuration.columns, values, scenario.merit, run).to_pylist()[0])


def replicate(
    scenario: Scenario | str | Path,
    runs: int,
    seed: int = 0,
    threads: int | None = None,
    first_run: int = 0,
) -> pa.Table:
    """Run a scenario many times; Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of one that ships.
        runs: How many, 0 to 10,000,000.
        seed: Of all chance, 0 to 2^64 - 1.
        threads: 1 to 1024; None for as many as there are processors. It changes no result.
        first_run: The number of the first; the others follow.

    Returns:
        A row a run: `run`, `time_s` (of the last find; the cap if not all was found), `complete`
        (whether it was), then what else the engine tells, and `merit`. Of the metric engine that is
        `robots`, `price`, `found` and `missed` (of what is sought), `false_alarms`, `collisions`,
        `energy_j`, `distance_m`, `robots_stopped`, and `found_KIND` and `missed_KIND` of each kind
        of items. Counts are int64, `complete` is a bool. A run that is quarantined (see
        `Outcome.status`) has nulls everywhere but in `run`; what never happened is null.

    Raises:
        InputError: If the scenario is wrong, or an argument out of range; all faults at once.
    """
    scenario = loaded(scenario)
    configuration = scenario.configuration({})
    given = _core.run_block(
        [configuration], seed=seed, first_run=first_run, runs=runs, threads=threads
    )
    values = {name: array[0] for name, array in given.items()}
    return table(configuration.columns, values, scenario.merit, first_run)


def table(
    columns: Columns, values: Mapping[str, NDArray[np.float64]], merit: Merit, first_run: int
) -> pa.Table:
    """Return outcomes as a table; what is not finite is null."""
    time_s, failed = (values[name] for name in MINE)
    others = [(name, kind) for name, kind, _, _ in columns if name not in MINE]
    return pa.table(
        {
            "run": first_run + np.arange(len(time_s), dtype=np.int64),
            "time_s": as_array(time_s, "real"),
            "complete": as_array(1 - failed, "flag"),
            **{name: as_array(values[name], kind) for name, kind in others},
            "merit": as_array(merit.score(values), "real"),
        }
    )


def as_array(values: NDArray[np.float64], kind: str) -> pa.Array:
    """Return a column as Arrow has it."""
    is_missing = ~np.isfinite(values)
    types = {"whole": np.int64, "flag": np.bool_, "real": np.float64}
    return pa.array(np.where(is_missing, 0, values).astype(types[kind]), mask=is_missing)


def status_of(row: Mapping[str, Any]) -> Status:
    """Return how a run ended."""
    if row["complete"] is None:
        return "quarantined"
    return "complete" if row["complete"] else "incomplete"


def by_kind(row: Mapping[str, Any], name: str) -> dict[str, int | None]:
    """Return counts by kind of items, of a name such as "found"."""
    begin = f"{name}_"
    kinds = {key.removeprefix(begin): row[key] for key in row if key.startswith(begin)}
    return kinds or ({"item": row[name]} if name in row and "missed" not in row else {})

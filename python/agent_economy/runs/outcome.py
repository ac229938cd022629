"""What runs give: one, or a table of many."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy.scenario.merit import Merit

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
        status: "complete": all targets were found. "incomplete": not so. "quarantined": the
            world had no room for the team or its items, or numbers went beyond all bounds; the run
            gave nothing. "running": of a `Simulation` that is not over; all is as if it ended now.
        time_s: Until the last find; the scenario's cap if the run is not complete.
        complete: Whether all targets were found.
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


def so_far(
    columns: Columns, told: Mapping[str, float], merit: Merit, run: int, status: Status | None
) -> Outcome:
    """Return what one run has told, by column, as an outcome; if nothing, it is quarantined."""
    values = {name: np.array([told.get(name, np.nan)]) for name, *_ in columns}
    row = table(columns, values, merit, run).to_pylist()[0]
    return Outcome.of(row, status if told else None)


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

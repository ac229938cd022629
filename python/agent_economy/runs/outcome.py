"""Outcomes of runs: a single one, or a table of many."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import arrow
from agent_economy.scenario.merit import Merit

Status = Literal["complete", "incomplete", "quarantined", "running"]

Columns = Sequence[tuple[str, str, float | None, float | None]]
"""The outcome columns of an engine: name, kind, minimum and maximum of each."""

COMMON = ("time_s", "failed")
"""Columns of every engine: a table of runs has them first, `failed` as `complete`."""


@dataclass(frozen=True)
class Outcome:
    """The outcome of a run. Quantities that its engine does not have are None.

    Attributes:
        run: Run number.
        status: "complete": all targets were found, or the condition of the scenario's end was met.
            "incomplete": it was not. "quarantined": the world had no room for the team or its
            items, or a number was not finite; there is no outcome. "running": the outcome of a
            `Simulation` as if it ended at its current step.
        time_s: Time until the run was complete; the time limit if it was not.
        complete: Whether the run was complete.
        merit: The figure of merit of the run.
        found: Items found, by kind; all as "item" if the engine has no item kinds.
        missed: Items not found, by kind.
        robots: Team size.
        price: Price of the team.
        false_alarms: Reported finds without an item.
        collisions: New contacts between two robots, or of a robot with an obstacle; in the classic
            engine, decisions of robots on shared cells.
        energy_j: Energy used by all robots; None if no robot has a battery.
        distance_m: Distance travelled by all robots.
        robots_stopped: Robots that stopped because they were empty or broken.
        row: The complete outcome by column, as in `replicate`, with the time of each find.
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
        fields: dict[str, Any] = {name: row.get(name) for name in cls.__dataclass_fields__}
        fields |= {name: by_kind(row, name) for name in ("found", "missed")}
        fields |= {"status": status or status_of(row), "row": row}
        return cls(**fields)


def outcome_of(
    columns: Columns, values: Mapping[str, float], merit: Merit, run: int, status: Status | None
) -> Outcome:
    """Return the outcome of one run from its columns; it is quarantined if there are none."""
    arrays = {name: np.array([values.get(name, np.nan)]) for name, *_ in columns}
    row = table(columns, arrays, merit, run).to_pylist()[0]
    return Outcome.of(row, status if values else None)


def table(
    columns: Columns, values: Mapping[str, NDArray[np.float64]], merit: Merit, first_run: int
) -> pa.Table:
    """Return outcomes as a table, with null for values that are not finite, or not counted."""
    time_s, failed = (values[name] for name in COMMON)
    others = [(name, kind) for name, kind, _, _ in columns if name not in COMMON]
    # Energy is taken from batteries. Without any, it is not known to be 0.
    nothing = np.full(len(time_s), np.nan)
    are_counted = {name: name != "energy_j" or high != 0 for name, _, _, high in columns}
    return arrow.table(
        {
            "run": first_run + np.arange(len(time_s), dtype=np.int64),
            "time_s": as_array(time_s, "real"),
            "complete": as_array(1 - failed, "flag"),
            **{
                name: as_array(values[name] if are_counted[name] else nothing, kind)
                for name, kind in others
            },
            "merit": as_array(merit.score(values), "real"),
        }
    )


def as_array(values: NDArray[np.float64], kind: str) -> pa.Array:
    """Return a column as an Arrow array of its kind."""
    is_missing = ~np.isfinite(values)
    types = {"whole": np.int64, "flag": np.bool_, "real": np.float64}
    return arrow.column(np.where(is_missing, 0, values).astype(types[kind]), is_missing)


def status_of(row: Mapping[str, Any]) -> Status:
    """Return the status of a run that is over."""
    if row["complete"] is None:
        return "quarantined"
    return "complete" if row["complete"] else "incomplete"


def by_kind(row: Mapping[str, Any], name: str) -> dict[str, int | None]:
    """Return the counts by item kind of a column family such as "found"."""
    counts = {kind: row[f"{name}_{kind}"] for kind in kinds(row)}
    return counts or ({"item": row[name]} if name in row and "missed" not in row else {})


def kinds(columns: Iterable[str]) -> list[str]:
    """Return the item kinds of which an engine has columns."""
    prefix = "missed_"
    return [name.removeprefix(prefix) for name in columns if name.startswith(prefix)]


def find_times(columns: Iterable[str]) -> set[str]:
    """Return those of the columns that are times of finds: found_KIND_1_s and so on.

    Tables for people leave them out, because there may be one for each item.
    """
    names = list(columns)
    any_kind = "|".join(map(re.escape, kinds(names)))
    return {name for name in names if re.fullmatch(f"found_({any_kind})_[0-9]+_s", name)}


def without_items(columns: Iterable[str]) -> set[str]:
    """Return the columns about items if a scenario has goals and no items: they are always zero.

    Tables for people leave them out.
    """
    names = list(columns)
    return {"found", "missed", "false_alarms"} if "goals" in names and not kinds(names) else set()

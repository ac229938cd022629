"""What a run's outcome is called and how it is kept."""

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import pyarrow as pa

Kind: TypeAlias = Literal["whole", "real", "flag"]

OWN = ("configuration", "run", "quarantined")
"""Columns that every block has besides the outcomes."""

MOST = 62
"""Columns that fit the marks of a quarantined run."""

ARROW: dict[Kind, Any] = {"whole": pa.int64(), "real": pa.float64(), "flag": pa.bool_()}


@dataclass(frozen=True)
class Column:
    """A column of outcomes.

    Attributes:
        name: Not one of `OWN`.
        kind: "whole" numbers up to 2^53, "real" numbers, or "flag" (0 or 1).
    """

    name: str
    kind: Kind


def check_names(columns: tuple[Column, ...]) -> None:
    """Refuse columns that a block cannot hold.

    Raises:
        ValueError: If there are none or too many, or a name is taken.
    """
    names = [column.name for column in columns]
    if not 1 <= len(names) <= MOST or len({*names, *OWN}) < len(names) + len(OWN):
        message = f"a block holds 1 to {MOST} columns of different names, none of {OWN}: {names}"
        raise ValueError(message)


def schema(columns: tuple[Column, ...]) -> Any:
    """Return what a block's file holds, the same for every block of a study."""
    return pa.schema(
        [
            pa.field("configuration", pa.int32(), nullable=False),
            pa.field("run", pa.int64(), nullable=False),
            *(pa.field(column.name, ARROW[column.kind]) for column in columns),
            pa.field("quarantined", pa.int64(), nullable=False),
        ]
    )

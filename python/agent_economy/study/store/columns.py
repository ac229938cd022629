"""The columns of outcomes and their types."""

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import pyarrow as pa

Kind: TypeAlias = Literal["whole", "real", "flag"]

OWN = ("configuration", "run", "quarantined")
"""Columns of every block file besides the outcomes."""

SHARED_BIT = 62
"""The bit in `quarantined` that all columns from this number on share; others have their own."""

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
    """Refuse columns that a block file cannot contain.

    Raises:
        ValueError: If there are none, or a name is reserved.
    """
    names = [column.name for column in columns]
    if not names or len({*names, *OWN}) < len(names) + len(OWN):
        message = f"a block has columns of different names, none of {OWN}, not {names}"
        raise ValueError(message)


def bits(columns: tuple[Column, ...]) -> list[tuple[int, Column]]:
    """Return the columns, each with its bit in `quarantined`."""
    return [(min(place, SHARED_BIT), column) for place, column in enumerate(columns)]


def schema(columns: tuple[Column, ...]) -> Any:
    """Return the Arrow schema of a block file, the same for all of a study."""
    return pa.schema(
        [
            pa.field("configuration", pa.int32(), nullable=False),
            pa.field("run", pa.int64(), nullable=False),
            *(pa.field(column.name, ARROW[column.kind]) for column in columns),
            pa.field("quarantined", pa.int64(), nullable=False),
        ]
    )

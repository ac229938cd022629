"""A block's bytes: Parquet, the same for the same outcomes, which it gives back exactly.

Rows are sorted by configuration, then run. Null means never (+inf). A cell that is NaN is null too,
and bit i of the row's `quarantined` says that column i was; so SQL that forgets the quarantined
meets no NaN, and `quarantined <> 0` finds them.
"""

from typing import Any, NoReturn

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from agent_economy.study.rectangle import Columns, Rectangle
from agent_economy.study.store.columns import Column, schema

LEVEL = 1
"""Of zstd: higher ones gain a few percent and take twice the time."""

EXACT = 2.0**53
"""Whole numbers below it are floats exactly."""


def encode(rectangle: Rectangle, columns: tuple[Column, ...], data: Columns) -> memoryview:
    """Return the file of a rectangle whose configurations ascend.

    Raises:
        ValueError: If a value is not of its column's kind.
    """
    configurations, runs = rectangle.shape
    names = np.asarray(rectangle.configurations, dtype=np.int32)
    numbers = np.arange(rectangle.first_run, rectangle.end, dtype=np.int64)
    marks = np.zeros(rectangle.rows, dtype=np.int64)
    cells = [
        cell(column, data[column.name].ravel(), marks, bit) for bit, column in enumerate(columns)
    ]
    arrays = [np.repeat(names, runs), np.tile(numbers, configurations), *cells, marks]
    table = pa.Table.from_arrays([pa.array(each) for each in arrays], schema=schema(columns))
    sink = pa.BufferOutputStream()
    pq.write_table(
        table,
        sink,
        compression="zstd",
        compression_level=LEVEL,
        use_dictionary=[column.name for column in columns if column.kind != "flag"],
        column_encoding={
            "configuration": "DELTA_BINARY_PACKED",
            "run": "DELTA_BINARY_PACKED",
            "quarantined": "DELTA_BINARY_PACKED",
        },
        write_statistics=["configuration", "run"],
        store_schema=False,
    )
    return memoryview(sink.getvalue())


def cell(column: Column, values: NDArray[np.float64], marks: NDArray[np.int64], bit: int) -> Any:
    """Return a column as Arrow has it, and mark its quarantined cells."""
    absent = None
    if not np.isfinite(values).all():
        quarantined = np.isnan(values)
        marks |= quarantined.astype(np.int64) << bit
        absent = quarantined | (values == np.inf)
        values = np.where(absent, 0.0, values)
    if column.kind == "real":
        return pa.array(values, mask=absent)
    check_least_and_greatest(column, values)
    kept = values.astype(np.bool_ if column.kind == "flag" else np.int64)
    if (kept != values).any():
        refuse(column, values[kept != values][0])
    return pa.array(kept, mask=absent)


def check_least_and_greatest(column: Column, values: NDArray[np.float64]) -> None:
    """Refuse what is no whole number that floats tell from the next."""
    for value in (values.min(), values.max()):
        if abs(value) >= EXACT:
            refuse(column, value)


def refuse(column: Column, value: float) -> NoReturn:
    """Say that a column cannot hold a value."""
    message = f"column {column.name} is a {column.kind} and cannot hold {value}"
    raise ValueError(message)


def decode(data: bytes, rectangle: Rectangle, columns: tuple[Column, ...]) -> Columns:
    """Return the outcomes that a file holds.

    Raises:
        pyarrow.ArrowException: If it is not a file of `encode`.
    """
    names = [column.name for column in columns]
    table = pq.read_table(
        pa.BufferReader(data), columns=[*names, "quarantined"], use_threads=rectangle.rows > 2**14
    )
    marks = table["quarantined"].to_numpy()
    any_marked = marks.any()
    outcomes = {}
    for bit, name in enumerate(names):
        values = floats(table[name])
        if any_marked:
            values[(marks >> bit & 1).astype(bool)] = np.nan
        outcomes[name] = values.reshape(rectangle.shape)
    return outcomes


def floats(column: Any) -> NDArray[np.float64]:
    """Return a column of a file as floats that can be written to, null as +inf."""
    if column.null_count:
        values = np.full(len(column), np.inf)
        there = column.is_valid().to_numpy(zero_copy_only=False)
        values[there] = column.drop_null().to_numpy(zero_copy_only=False)
        return values
    return np.array(column.to_numpy(zero_copy_only=False), dtype=np.float64)


def as_read(columns: tuple[Column, ...], data: Columns) -> Columns:
    """Return outcomes as `decode` gives them back: zeros of whole numbers have no sign."""
    return {
        column.name: data[column.name] if column.kind == "real" else data[column.name] + 0.0
        for column in columns
    }

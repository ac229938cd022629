"""The bytes of a block file: Parquet, the same bytes for the same outcomes, and lossless.

Rows are sorted by configuration, then run. Null means never (+inf). A cell that is NaN is null too,
and bit i of the row's `quarantined` marks column i; so SQL queries that ignore quarantined runs
read no NaN, and `quarantined <> 0` finds these runs. The last bit marks all columns from its number
on: their cells of a row are all NaN, or none is.
"""

from itertools import pairwise
from typing import Any, NoReturn

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from agent_economy import arrow
from agent_economy._core import InputError
from agent_economy.study.run_block import Columns, RunBlock
from agent_economy.study.store.columns import SHARED_BIT, Column, bits, schema

LEVEL = 1
"""Compression level of zstd: higher ones save a few percent and take twice the time."""

EXACT = 2.0**53
"""Whole numbers below it have an exact floating-point value."""


def table_of(block: RunBlock, columns: tuple[Column, ...], data: Columns) -> pa.Table:
    """Return the rows of a block.

    Raises:
        InputError: If a value does not fit the type of its column, or NaN is only in some of the
            columns that share a bit.
    """
    check_shared(columns, data)
    configurations, runs = block.shape
    names = np.asarray(block.configurations, dtype=np.int32)
    numbers = np.arange(block.first_run, block.end, dtype=np.int64)
    marks = np.zeros(block.rows, dtype=np.int64)
    cells = [cell(column, data[column.name].ravel(), marks, bit) for bit, column in bits(columns)]
    arrays = [
        arrow.column(np.repeat(names, runs)),
        arrow.column(np.tile(numbers, configurations)),
        *cells,
        arrow.column(marks),
    ]
    return pa.Table.from_arrays(arrays, schema=schema(columns))


def encode(block: RunBlock, columns: tuple[Column, ...], data: Columns) -> memoryview:
    """Return the file of a block with ascending configurations.

    Raises:
        InputError: If a value does not fit the type of its column.
    """
    sink = pa.BufferOutputStream()
    pq.write_table(
        table_of(block, columns, data),
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
    """Return a column as an Arrow array, and mark its quarantined cells."""
    absent = None
    if not np.isfinite(values).all():
        quarantined = np.isnan(values)
        marks |= quarantined.astype(np.int64) << bit
        absent = quarantined | (values == np.inf)
        values = np.where(absent, 0.0, values)
    if column.kind == "real":
        return arrow.column(values, absent)
    check_range(column, values)
    kept = values.astype(np.bool_ if column.kind == "flag" else np.int64)
    if (kept != values).any():
        refuse(column, values[kept != values][0])
    return arrow.column(kept, absent)


def check_shared(columns: tuple[Column, ...], data: Columns) -> None:
    """Refuse runs in which NaN is only in some of the columns that share a bit."""
    names = [column.name for column in columns[SHARED_BIT:]]
    for name, other in pairwise(names):
        if (np.isnan(data[name]) != np.isnan(data[other])).any():
            message = f"column {other} must be NaN in the same runs as {name}"
            raise InputError(message)


def check_range(column: Column, values: NDArray[np.float64]) -> None:
    """Refuse whole numbers without an exact floating-point value."""
    for value in (values.min(), values.max()):
        if abs(value) >= EXACT:
            refuse(column, value)


def refuse(column: Column, value: float) -> NoReturn:
    """Raise the error for a value that does not fit its column."""
    message = f"column {column.name} ({column.kind}) cannot contain {value}"
    raise InputError(message)


def decode(data: bytes, block: RunBlock, columns: tuple[Column, ...]) -> Columns:
    """Return the outcomes in a file.

    Raises:
        pyarrow.ArrowException: If it is not a file of `encode`.
    """
    names = [column.name for column in columns]
    # Not `read_table`: it imports pandas, which takes a second.
    table = pq.ParquetFile(pa.BufferReader(data)).read(
        [*names, "quarantined"], use_threads=block.rows > 2**14
    )
    outcomes = outcomes_of(table, columns)
    return {name: values.reshape(block.shape) for name, values in outcomes.items()}


def outcomes_of(table: pa.Table, columns: tuple[Column, ...]) -> Columns:
    """Return the outcomes of rows, each of shape (rows,)."""
    marks = arrow.numbers(table["quarantined"])
    any_marked = marks.any()
    outcomes = {}
    for bit, column in bits(columns):
        values = arrow.floats(table[column.name], np.inf)
        if any_marked:
            values[(marks >> bit & 1).astype(bool)] = np.nan
        outcomes[column.name] = values
    return outcomes


def as_read(columns: tuple[Column, ...], data: Columns) -> Columns:
    """Return outcomes as `decode` returns them: zeros of whole numbers have no sign."""
    return {
        column.name: data[column.name] if column.kind == "real" else data[column.name] + 0.0
        for column in columns
    }

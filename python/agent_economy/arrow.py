"""Arrow columns from and to NumPy arrays.

pyarrow's `array`, `scalar` and `to_numpy` import pandas where it is installed, which takes
a second per process. These do not.
"""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

Values: TypeAlias = NDArray[Any] | Sequence[str] | pa.Array


def table(columns: Mapping[str, Values]) -> pa.Table:
    """Return columns of the same length as a table."""
    return pa.Table.from_arrays([column(each) for each in columns.values()], list(columns))


def column(values: Values, absent: NDArray[np.bool_] | None = None) -> pa.Array:
    """Return numbers, flags or strings as an Arrow array; only the first two can be absent."""
    if isinstance(values, pa.Array):
        return values
    if not isinstance(values, np.ndarray):
        return strings(values)
    values = np.ascontiguousarray(values)
    data = bits(values) if values.dtype == np.bool_ else pa.py_buffer(values)
    valid = None if absent is None else bits(~absent)
    return pa.Array.from_buffers(pa.from_numpy_dtype(values.dtype), len(values), [valid, data])


def strings(values: Sequence[str]) -> pa.Array:
    """Return strings as an Arrow array."""
    encoded = [each.encode() for each in values]
    ends = np.cumsum([0, *map(len, encoded)], dtype=np.int32)
    data = pa.py_buffer(b"".join(encoded))
    return pa.StringArray.from_buffers(len(encoded), pa.py_buffer(ends), data)


def bits(flags: NDArray[np.bool_]) -> pa.Buffer:
    """Return flags as a buffer, eight per byte."""
    return pa.py_buffer(np.packbits(flags, bitorder="little"))


def numbers(values: pa.Array | pa.ChunkedArray) -> NDArray[Any]:
    """Return a column of numbers without nulls as an array; of flags, 0 and 1."""
    if isinstance(values, pa.ChunkedArray):
        values = values.combine_chunks()
    is_flags = pa.types.is_boolean(values.type)
    return np.from_dlpack(values.cast(pa.uint8()) if is_flags else values)


def floats(values: pa.ChunkedArray, null: float) -> NDArray[np.float64]:
    """Return a column as a writable array, with a number in place of null."""
    filler = column(np.array([null]))[0]
    return numbers(values.cast(pa.float64()).fill_null(filler)).copy()

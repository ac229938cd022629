"""Runs of a block that is not complete yet: stored as they finish, and merged into its file later.

The staging file is a sequence of records: length, SHA-256 and rows (an Arrow record batch). It is
appended to; a process that is killed leaves at most an incomplete last record, which is ignored.
The file is removed when its runs are in block files. A finished study has one only if its question
was changed in the middle of a block: the other question may need these runs again.
"""

import hashlib
import os
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import arrow
from agent_economy._core import InputError
from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import Columns, Gathered, Part, RunBlock
from agent_economy.study.store import folder as files
from agent_economy.study.store import parquet
from agent_economy.study.store.columns import Column, schema
from agent_economy.study.store.coverage import Coverage
from agent_economy.whole_file import sync_folder

STAGE_S = 0.5
"""Maximum time for which finished runs are only in memory, until the next part is finished."""

HEAD = struct.Struct(">Q32s")
"""Length and SHA-256 of a record's rows."""


class Staging:
    """The staged runs of a study's folder, for the process that writes it."""

    def __init__(self, path: Path, columns: tuple[Column, ...], coverage: Coverage) -> None:
        """Read what another process staged; runs that are in block files are dropped.

        Raises:
            StoreError: If the file cannot be read or written.
        """
        self._path = path
        self._columns = columns
        data = files.read_bytes(path)
        self._rows = staged_rows(data or b"", columns, coverage)
        self._waiting: list[Part] = []
        self._since_s = time.monotonic()
        if data is not None:
            self._rewrite()

    @property
    def count(self) -> int:
        """Number of staged runs."""
        return int(self._rows.num_rows)

    def begin(self, gathered: Gathered) -> None:
        """Add the staged runs of a block to it; its other runs will be passed to `add`."""
        self._since_s = time.monotonic()
        are_wanted = are_in(self._rows, gathered.block)
        if are_wanted.any():
            rows = self._rows.filter(arrow.column(are_wanted))
            configurations, runs = keys(rows)
            gathered.put_runs(configurations, runs, parquet.outcomes_of(rows, self._columns))

    def add(self, part: RunBlock, data: Columns) -> None:
        """Stage finished runs; they are on the disk after `STAGE_S`, or `flush`.

        Raises:
            StoreError: If they cannot be written.
            InputError: If a value does not fit the type of its column.
        """
        self._waiting.append((part, data))
        if time.monotonic() - self._since_s > STAGE_S:
            self.flush()

    @contextmanager
    def flushed_if_interrupted(self) -> Iterator[None]:
        """Write the runs that are only in memory if an error or Ctrl-C ends the block."""
        try:
            yield
        except BaseException:
            # What interrupted it is reported, also if the disk is full.
            with suppress(StoreError, InputError):
                self.flush()
            raise

    def flush(self) -> None:
        """Write the runs that are only in memory.

        Raises:
            StoreError, InputError: As `add`.
        """
        if not self._waiting:
            return
        tables = [parquet.table_of(part, self._columns, data) for part, data in self._waiting]
        rows = pa.concat_tables(tables).combine_chunks()
        with files.disk_errors(self._path):
            is_new = not self._path.exists()
            flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC
            descriptor = os.open(self._path, flags, 0o666)
            try:
                append(descriptor, record(rows))
            finally:
                os.close(descriptor)
            if is_new:
                sync_folder(self._path.parent)
        self._rows = pa.concat_tables([self._rows, rows])
        self._waiting.clear()
        self._since_s = time.monotonic()

    def discard(self, block: RunBlock) -> None:
        """Drop the runs of a block whose file is stored now.

        Raises:
            StoreError: If the file cannot be written.
        """
        self._waiting.clear()
        are_stored = are_in(self._rows, block)
        if are_stored.any():
            self._rows = self._rows.filter(arrow.column(~are_stored))
            self._rewrite()

    def _rewrite(self) -> None:
        if self._rows.num_rows:
            files.write_whole(self._path, record(self._rows.combine_chunks()))
            return
        with files.disk_errors(self._path):
            self._path.unlink(missing_ok=True)


def write_all(descriptor: int, data: bytes) -> None:
    """Write every byte: `os.write` may write fewer than requested."""
    left = memoryview(data)
    while left:
        left = left[os.write(descriptor, left) :]


def append(descriptor: int, data: bytes) -> None:
    """Append bytes to a file and wait until they are on the disk; all of them or none."""
    size = os.fstat(descriptor).st_size
    try:
        write_all(descriptor, data)
        os.fsync(descriptor)
    except BaseException:
        # Ctrl-C may come here: they are written again, and must not be there twice.
        os.ftruncate(descriptor, size)
        raise


def record(rows: pa.Table) -> bytes:
    """Return the record of rows that are in one chunk."""
    (batch,) = rows.to_batches()
    body: bytes = batch.serialize().to_pybytes()
    return HEAD.pack(len(body), hashlib.sha256(body).digest()) + body


def staged_rows(data: bytes, columns: tuple[Column, ...], coverage: Coverage) -> pa.Table:
    """Return the rows of a staging file that are not in block files, each run once."""
    kind = schema(columns)
    rows = pa.Table.from_batches(batches(data, kind), kind)
    if not rows.num_rows:
        return rows
    configurations, runs = keys(rows)
    are_new = np.zeros(rows.num_rows, dtype=np.bool_)
    are_new[np.unique(np.stack([configurations, runs]), axis=1, return_index=True)[1]] = True
    return rows.filter(arrow.column(are_new & ~coverage.contains(configurations, runs)))


def batches(data: bytes, kind: pa.Schema) -> Iterator[pa.RecordBatch]:
    """Yield the complete records of a staging file."""
    place = 0
    while place + HEAD.size <= len(data):
        length, digest = HEAD.unpack_from(data, place)
        body = data[place + HEAD.size : place + HEAD.size + length]
        if hashlib.sha256(body).digest() != digest:
            return
        try:
            batch = pa.ipc.read_record_batch(pa.py_buffer(body), kind)
        except (pa.ArrowException, OSError):  # of another program
            return
        yield batch
        place += HEAD.size + length


def are_in(rows: pa.Table, block: RunBlock) -> NDArray[np.bool_]:
    """Return which rows are runs of a block."""
    if not rows.num_rows:  # pyarrow loads pandas to join no chunks.
        return np.zeros(0, dtype=np.bool_)
    configurations, runs = keys(rows)
    are_of = np.isin(configurations, block.configurations)
    return are_of & (runs >= block.first_run) & (runs < block.end)


def keys(rows: pa.Table) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the configuration and the run of each row."""
    return arrow.numbers(rows["configuration"]), arrow.numbers(rows["run"])

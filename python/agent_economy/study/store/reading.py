"""Read-only access to a study's store, without a lock, also while another process writes."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq

from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import Columns, Compute, Gathered, RunBlock
from agent_economy.study.store import folder as files
from agent_economy.study.store.columns import Column
from agent_economy.study.store.coverage import Coverage, split
from agent_economy.study.store.ledger import Answered, BlockFile, Decision, questions, snapshot
from agent_economy.study.store.staging import staged_rows
from agent_economy.study.store.writing import check_files, read_block

if TYPE_CHECKING:
    from duckdb import DuckDBPyConnection, DuckDBPyRelation


PATTERN = {*"*?["}
"""Characters of patterns of DuckDB."""


@dataclass(frozen=True)
class ReadStore:
    """A study's folder for reading; every call returns the current content.

    Attributes:
        folder: The study's folder.
        question: The text of study.toml.
    """

    folder: Path
    question: str

    def columns(self) -> tuple[Column, ...]:
        """Return the columns of every run."""
        return snapshot(self.folder / files.LEDGER)[0]

    def block_files(self) -> list[BlockFile]:
        """Return the block files, by first run and configuration."""
        return snapshot(self.folder / files.LEDGER)[1]

    def decisions(self) -> list[Decision]:
        """Return the decisions, by round."""
        return snapshot(self.folder / files.LEDGER)[2]

    def content(self, digest: str) -> bytes:
        """Return the content of a file that the study needs besides study.toml, by its digest.

        Raises:
            InputError: If it is missing or damaged.
        """
        path = self.folder / files.FILES / digest
        data = files.read_bytes(path)
        if data is None or hashlib.sha256(data).hexdigest() != digest:
            message = f"{path}: is missing or damaged: restore it, or use another folder"
            raise StoreError(message)
        return data

    def stored(self) -> "StoredRuns":
        """Return the runs that are stored now."""
        columns, block_files, _ = snapshot(self.folder / files.LEDGER)
        coverage = Coverage(self.folder, block_files)
        return StoredRuns(self.folder, columns, coverage, questions(self.folder / files.LEDGER))

    def count(self) -> int:
        """Return the number of stored runs, those of an incomplete block included."""
        _, block_files, staged = self._stored()
        return sum(file.block.rows for file in block_files) + int(staged.num_rows)

    def _stored(self) -> tuple[tuple[Column, ...], list[BlockFile], pa.Table]:
        """Return the columns, the block files, and the staged runs that are in none of them."""
        # Read first: runs that move to a block file in between are then in the ledger.
        data = files.read_bytes(self.folder / files.STAGING) or b""
        columns, block_files, _ = snapshot(self.folder / files.LEDGER)
        coverage = Coverage(self.folder, block_files)
        return columns, block_files, staged_rows(data if columns else b"", columns, coverage)

    def runs(self) -> "DuckDBPyRelation":
        """Return the runs as a DuckDB relation with one row per run, for SQL queries.

        Those that were finished of an incomplete block are included.

        Returns:
            `configuration`, `run`, the study's columns (null = never, or quarantined) and
            `quarantined` (whether a value of the run was not a number).

        Raises:
            InputError: If a block file is missing or truncated. Hashes are not compared.
        """
        import duckdb  # noqa: PLC0415  (slow to load)

        _, block_files, staged = self._stored()
        check_files(self.folder, block_files)
        connection = duckdb.connect()
        found = connection.from_arrow(staged)
        if block_files:
            paths = [self.folder / files.BLOCKS / file.name for file in block_files]
            found = parquet_files(connection, paths).union(found)
        return found.project("* REPLACE (quarantined <> 0 AS quarantined)")


@dataclass
class StoredRuns:
    """The runs of a study at the time of reading, with the interface of `Store`; read-only.

    Attributes:
        folder: The study's folder.
        columns: The columns of every run.
        coverage: Which runs are stored.
        questions: The questions that were answered from them.
        computed: Number of runs that were computed.
        pending: Number of runs that are known of the block that is requested.
    """

    folder: Path
    columns: tuple[Column, ...]
    coverage: Coverage
    questions: tuple[Answered, ...] = ()
    computed: int = 0
    pending: int = 0

    def block(self, block: RunBlock, compute: Compute) -> Columns:
        """Return the outcomes of a block of runs, as `Store.block` does.

        Raises:
            StoreError: If a block file is missing or damaged; also any error that `compute` raises.
        """
        gathered = Gathered(block)
        for part in split(block):
            missing = self.coverage.missing(part)
            if missing:
                gathered.put(missing, compute(missing))
                self.computed += missing.rows
            for file, configurations in self.coverage.block_files(part):
                data = read_block(self.folder, file, self.columns)
                gathered.put(file.block, data, configurations)
        return gathered.columns

    def answered(self, question: Answered) -> tuple[Answered, ...]:  # noqa: ARG002  (as Store's)
        """Record nothing; return the questions that were answered."""
        return self.questions

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (as Store's)
        """Record nothing."""


def parquet_files(connection: "DuckDBPyConnection", paths: Sequence[Path]) -> "DuckDBPyRelation":
    """Return the rows of exactly these files, whatever characters their paths have.

    DuckDB reads *, ? and [ as patterns, which fail beside folders with odd names, ~ as the home
    folder, and key=value as a column.
    """
    names = [str(path.absolute()) for path in paths]
    if not all(map(validation.is_text, names)):  # DuckDB opens no path that is not UTF-8.
        tables = [pq.ParquetFile(pa.BufferReader(path.read_bytes())).read() for path in paths]
        return connection.from_arrow(pa.concat_tables(tables))
    if PATTERN & set(names[0]):
        from pyarrow.dataset import dataset  # noqa: PLC0415  (slow to load)
        from pyarrow.fs import LocalFileSystem  # noqa: PLC0415

        return connection.from_arrow(dataset(names, format="parquet", filesystem=LocalFileSystem()))
    return connection.read_parquet(names, hive_partitioning=False)


def read(folder: str | Path) -> ReadStore:
    """Open a study's folder for reading.

    Raises:
        InputError: If it contains no study.
    """
    folder = validation.path("folder", folder)
    question = files.read_bytes(folder / files.QUESTION)
    if question is None:
        message = f"{folder}: contains no study ({files.QUESTION} is missing)"
        raise InputError(message)
    try:
        return ReadStore(folder, question.decode())
    except UnicodeDecodeError:
        message = f"{folder / files.QUESTION}: is not UTF-8 text: restore it, or use another folder"
        raise InputError(message) from None

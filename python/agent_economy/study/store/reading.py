"""A study's store for those who watch: no lock, nothing written, also while another writes."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.study.errors import StoreError
from agent_economy.study.rectangle import Columns, Compute, Rectangle
from agent_economy.study.store import folder as files
from agent_economy.study.store.columns import Column
from agent_economy.study.store.coverage import Coverage, cut
from agent_economy.study.store.ledger import Block, Decision, snapshot
from agent_economy.study.store.writing import Gathered, check_there, read_block

if TYPE_CHECKING:
    from duckdb import DuckDBPyRelation


@dataclass(frozen=True)
class ReadStore:
    """A study's folder, to read; every call sees what is there then.

    Attributes:
        folder: Where.
        asked: The text of study.toml.
    """

    folder: Path
    asked: str

    def columns(self) -> tuple[Column, ...]:
        """Return the columns of every run."""
        return snapshot(self.folder / files.LEDGER)[0]

    def blocks(self) -> list[Block]:
        """Return the blocks so far, by first run and configuration."""
        return snapshot(self.folder / files.LEDGER)[1]

    def decisions(self) -> list[Decision]:
        """Return the decisions so far, by round."""
        return snapshot(self.folder / files.LEDGER)[2]

    def content(self, digest: str) -> bytes:
        """Return what is in a file that the study needs besides study.toml, by its digest.

        Raises:
            InputError: If it is missing, or is another.
        """
        path = self.folder / files.FILES / digest
        data = files.read_bytes(path)
        if data is None or hashlib.sha256(data).hexdigest() != digest:
            message = f"{path}: is missing or damaged: restore it, or start in another folder"
            raise StoreError(message)
        return data

    def stored(self) -> "Stored":
        """Return what is stored now, to look rectangles up in."""
        columns, blocks, _ = snapshot(self.folder / files.LEDGER)
        return Stored(self.folder, columns, Coverage(self.folder, blocks))

    def runs(self) -> "DuckDBPyRelation":
        """Return the runs so far, a row each, to ask in SQL.

        Returns:
            `configuration`, `run`, the study's columns (null = never, or quarantined) and
            `quarantined` (whether a value of the run was no number).

        Raises:
            InputError: If a block is missing or cut short. Hashes are not compared.
        """
        import duckdb  # noqa: PLC0415  (slow to load)

        columns, blocks, _ = snapshot(self.folder / files.LEDGER)
        check_there(self.folder, blocks)
        connection = duckdb.connect()
        if not blocks:
            return connection.sql(f"{empty(columns)} LIMIT 0")
        paths = [str(self.folder / files.BLOCKS / block.name) for block in blocks]
        marked = connection.read_parquet(paths)
        return marked.project("* REPLACE (quarantined <> 0 AS quarantined)")


@dataclass
class Stored:
    """The runs that a study had at some moment, as `Store` gives them; none is kept.

    Attributes:
        folder: Where.
        columns: Of every run.
        coverage: Which runs there are.
        computed: Runs that had to be computed.
    """

    folder: Path
    columns: tuple[Column, ...]
    coverage: Coverage
    computed: int = 0

    def block(self, rectangle: Rectangle, compute: Compute) -> Columns:
        """Return the outcomes of a rectangle, as `Store.block` does.

        Raises:
            StoreError: If a block is missing or damaged; or for what `compute` raises.
        """
        gathered = Gathered(rectangle, self.columns)
        for part in cut(rectangle):
            missing = self.coverage.missing(part)
            if missing:
                gathered.put(missing, compute(missing))
                self.computed += missing.rows
            for block, configurations in self.coverage.blocks(part):
                data = read_block(self.folder, block, self.columns)
                gathered.put(block.rectangle, data, configurations)
        return gathered.columns

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (as Store's)
        """Write nothing down."""


def empty(columns: tuple[Column, ...]) -> str:
    """Return SQL that gives no run, but its columns."""
    types = {"whole": "BIGINT", "real": "DOUBLE", "flag": "BOOLEAN"}
    pairs = [("configuration", "INTEGER"), ("run", "BIGINT")]
    pairs += [(column.name, types[column.kind]) for column in columns]
    pairs += [("quarantined", "BOOLEAN")]
    return "SELECT " + ", ".join(f'NULL::{kind} AS "{name}"' for name, kind in pairs)


def read(folder: str | Path) -> ReadStore:
    """Open a study's folder to read.

    Raises:
        InputError: If it holds no study.
    """
    folder = validation.path("folder", folder)
    asked = files.read_bytes(folder / files.ASKED)
    if asked is None:
        message = f"{folder}: holds no study ({files.ASKED} is not there)"
        raise InputError(message)
    try:
        return ReadStore(folder, asked.decode())
    except UnicodeDecodeError:
        message = f"{folder / files.ASKED}: is not UTF-8 text: restore it, or use another folder"
        raise InputError(message) from None

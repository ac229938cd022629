"""The ledger of a study: which blocks there are, with their hashes, and what was decided.

SQLite in WAL mode: one process writes, any number read meanwhile. A block's entry is waited for
until it is on the disk; a decision's is not, because it follows from the blocks.
"""

import json
import sqlite3
from collections.abc import Iterable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self
from urllib.parse import quote

from agent_economy.study.errors import StoreError
from agent_economy.study.rectangle import Rectangle, numbers, spans
from agent_economy.study.store.columns import Column
from agent_economy.study.store.folder import told

APPLICATION = 0x61676563
"""Says in the file's header whose it is: "agec"."""

VERSION = 1

TABLES = """
BEGIN IMMEDIATE;
CREATE TABLE outcome (place INTEGER PRIMARY KEY, name TEXT NOT NULL, kind TEXT NOT NULL);
CREATE TABLE block (
  name TEXT PRIMARY KEY, first_run INTEGER NOT NULL, runs INTEGER NOT NULL,
  configurations TEXT NOT NULL, bytes INTEGER NOT NULL, sha256 TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE decision (round INTEGER PRIMARY KEY, facts TEXT NOT NULL);
"""


@dataclass(frozen=True)
class Block:
    """A file of outcomes.

    Attributes:
        rectangle: What it holds, configurations ascending.
        bytes: Its length.
        sha256: Of its bytes, in hexadecimal.
    """

    rectangle: Rectangle
    bytes: int
    sha256: str

    @property
    def name(self) -> str:
        """Its file's name: no other block of a study has this first run and configuration."""
        first = self.rectangle.configurations[0]
        return f"{self.rectangle.first_run:012d}-{first:07d}.parquet"


@dataclass(frozen=True)
class Decision:
    """What was decided in a round, as the race wrote it down."""

    round: int
    facts: dict[str, Any]


class Ledger:
    """A study's ledger, open."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        """Use `write` or `read`."""
        self.path = path
        self._connection = connection

    @classmethod
    def write(cls, path: Path, columns: tuple[Column, ...]) -> Self:
        """Open a ledger to write in, made if it is not there.

        Raises:
            StoreError: If it is no ledger, newer than this program, of other columns, or cannot be
                written.
        """
        with told(path, "opened as a ledger"):
            connection = sqlite3.connect(path, timeout=30, isolation_level=None)
            try:
                prepare(connection, path, columns)
            except BaseException:
                connection.close()
                raise
        ledger = cls(path, connection)
        if ledger.columns() != columns:
            has = ", ".join(f"{column.name} ({column.kind})" for column in ledger.columns())
            ledger.close()
            message = f"{path}: was written with other columns ({has}): use another folder"
            raise StoreError(message)
        return ledger

    @classmethod
    def read(cls, path: Path) -> Self:
        """Open a ledger to read.

        Raises:
            StoreError: If it is not there, no ledger, or newer than this program.
        """
        with told(path, "read as a ledger"):
            connection = connect_to_read(path)
            try:
                if not is_empty(connection):
                    check_whose(connection, path)
            except BaseException:
                connection.close()
                raise
        return cls(path, connection)

    def close(self) -> None:
        """Close it."""
        self._connection.close()

    def is_begun(self) -> bool:
        """Return whether it has its tables: a killed process may have left it without."""
        with told(self.path, "read as a ledger"):
            return not is_empty(self._connection)

    def columns(self) -> tuple[Column, ...]:
        """Return the columns of its blocks."""
        rows = self._rows("SELECT name, kind FROM outcome ORDER BY place")
        return tuple(Column(*row) for row in rows)

    def blocks(self) -> list[Block]:
        """Return its blocks, by first run and configuration."""
        question = "SELECT configurations, first_run, runs, bytes, sha256 FROM block ORDER BY name"
        return [
            Block(Rectangle(numbers(configurations), first_run, runs), size, sha256)
            for configurations, first_run, runs, size, sha256 in self._rows(question)
        ]

    def decisions(self) -> list[Decision]:
        """Return its decisions, by round."""
        rows = self._rows("SELECT round, facts FROM decision ORDER BY round")
        return [Decision(number, json.loads(facts)) for number, facts in rows]

    def enter(self, block: Block) -> None:
        """Enter a block whose file is on the disk, and wait until the entry is.

        Raises:
            StoreError: If another of its name is entered, or the entry cannot be written.
        """
        self.check_same(block)
        area = block.rectangle
        values = (area.first_run, area.runs, spans(area.configurations), block.bytes, block.sha256)
        with told(self.path):
            self._connection.execute(
                "INSERT OR IGNORE INTO block VALUES (?, ?, ?, ?, ?, ?)", (block.name, *values)
            )

    def check_same(self, block: Block) -> None:
        """Refuse a block of which another form is entered.

        Raises:
            StoreError: If the same runs gave other outcomes before.
        """
        entered = self._rows("SELECT sha256 FROM block WHERE name = ?", block.name)
        if entered and entered[0] != (block.sha256,):
            message = (
                f"{self.path}: block {block.name} was entered with other bytes: the same runs gave "
                "other outcomes; see that all machines have the same version of this program"
            )
            raise StoreError(message)

    def note(self, decision: Decision) -> None:
        """Write down a round's decision, unless it is there.

        One that differs from what is there begins another history: later rounds are removed.

        Raises:
            StoreError: If it cannot be written.
        """
        facts = json.dumps(decision.facts, sort_keys=True, allow_nan=False)
        number = decision.round
        if self._rows("SELECT facts FROM decision WHERE round = ?", number) == [(facts,)]:
            return
        with told(self.path):
            self._connection.execute("PRAGMA synchronous = NORMAL")
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                self._connection.execute("DELETE FROM decision WHERE round >= ?", (number,))
                self._connection.execute("INSERT INTO decision VALUES (?, ?)", (number, facts))
                self._connection.execute("COMMIT")
            finally:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                self._connection.execute("PRAGMA synchronous = FULL")

    def _rows(self, question: str, *values: object) -> list[tuple[Any, ...]]:
        with told(self.path, "read as a ledger"):
            return self._connection.execute(question, values).fetchall()


def prepare(connection: sqlite3.Connection, path: Path, columns: Iterable[Column]) -> None:
    """Make the tables of a ledger that has none, all at once; check one that has."""
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = FULL")
    if not is_empty(connection):
        check_whose(connection, path)
        return
    connection.executescript(TABLES)
    rows = ((place, column.name, column.kind) for place, column in enumerate(columns))
    connection.executemany("INSERT INTO outcome VALUES (?, ?, ?)", rows)
    connection.execute(f"PRAGMA application_id = {APPLICATION}")
    connection.execute(f"PRAGMA user_version = {VERSION}")
    connection.execute("COMMIT")


def is_empty(connection: sqlite3.Connection) -> bool:
    """Return whether nothing was ever made in a ledger: new, or killed while it was made."""
    tables = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    return tables == 0 and header(connection, "application_id") == 0


def check_whose(connection: sqlite3.Connection, path: Path) -> None:
    """Refuse a file that is not a ledger that this program can read."""
    if header(connection, "application_id") != APPLICATION:
        message = f"{path}: is not a ledger of this program: use another folder"
        raise StoreError(message)
    version = header(connection, "user_version")
    if version > VERSION:
        message = (
            f"{path}: was written by a newer version of this program (ledger {version}, this one "
            f"knows up to {VERSION}): use that version, or another folder"
        )
        raise StoreError(message)


def header(connection: sqlite3.Connection, name: str) -> int:
    """Return a number from a file's header."""
    return int(connection.execute(f"PRAGMA {name}").fetchone()[0])


def connect_to_read(path: Path) -> sqlite3.Connection:
    """Return a connection that cannot write, also where the folder cannot be written in."""
    address = f"file:{quote(str(path.absolute()))}?mode=ro"
    connection = sqlite3.connect(address, uri=True, timeout=30, isolation_level=None)
    try:
        connection.execute("SELECT count(*) FROM sqlite_master")
    except sqlite3.OperationalError:
        connection.close()
        if not path.exists() or path.with_name(f"{path.name}-wal").exists():
            raise
        # Nobody writes, and SQLite may not make the files that it would coordinate readers with.
        return sqlite3.connect(f"{address}&immutable=1", uri=True, isolation_level=None)
    return connection


def snapshot(path: Path) -> tuple[tuple[Column, ...], list[Block], list[Decision]]:
    """Return what a ledger holds now, nothing if the study has not begun.

    Raises:
        StoreError: As `Ledger.read`.
    """
    if not path.exists():
        return (), [], []
    with closing(Ledger.read(path)) as ledger:
        if not ledger.is_begun():
            return (), [], []
        return ledger.columns(), ledger.blocks(), ledger.decisions()

"""The ledger of a study: its block files with their hashes, and the decisions of the race.

SQLite in WAL mode: one process writes while any number read. The entry of a block file is synced to
the disk before the study continues; that of a decision is not, because it follows from the blocks.
"""

import json
import os
import sqlite3
from collections.abc import Iterable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self
from urllib.parse import quote

from agent_economy.regular_file import check_regular
from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import RunBlock, numbers, spans
from agent_economy.study.store.columns import Column
from agent_economy.study.store.folder import disk_errors

APPLICATION = 0x61676563
"""Application id in the file's header: "agec"."""

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

ANSWERED = """
CREATE TABLE IF NOT EXISTS answered (
  number INTEGER PRIMARY KEY, words TEXT NOT NULL UNIQUE, confidence REAL NOT NULL
)
"""
"""The questions that were answered from the runs; ledgers of earlier versions lack the table."""


@dataclass(frozen=True)
class Answered:
    """A question that was answered from the runs.

    Attributes:
        words: The question in words; others differ from it.
        confidence: The confidence of its promise.
    """

    words: str
    confidence: float


@dataclass(frozen=True)
class BlockFile:
    """The file of a block of runs.

    Attributes:
        block: Its runs, configurations ascending.
        bytes: Its length.
        sha256: Hash of its bytes, in hexadecimal.
    """

    block: RunBlock
    bytes: int
    sha256: str

    @property
    def name(self) -> str:
        """Its name: no other block of a study has this first run and configuration."""
        first = self.block.configurations[0]
        return f"{self.block.first_run:012d}-{first:07d}.parquet"


@dataclass(frozen=True)
class Decision:
    """The state of the race after a round, as the race recorded it."""

    round: int
    facts: dict[str, Any]


class Ledger:
    """The open ledger of a study."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        """Use `write` or `read`."""
        self.path = path
        self._connection = connection

    @classmethod
    def write(cls, path: Path, columns: tuple[Column, ...]) -> Self:
        """Open a ledger for writing; it is created if it does not exist.

        Raises:
            StoreError: If it is not a ledger, newer than this program, has other columns, or cannot
                be written.
        """
        with disk_errors(path, "opened as a ledger"):
            check_parts(path)
            connection = connect(path, "rwc")
            try:
                prepare(connection, path, columns)
            except BaseException:
                connection.close()
                raise
        ledger = cls(path, connection)
        if ledger.columns() != columns:
            existing = ", ".join(f"{column.name} ({column.kind})" for column in ledger.columns())
            ledger.close()
            message = f"{path}: was written with other columns ({existing}): use another folder"
            raise StoreError(message)
        return ledger

    @classmethod
    def read(cls, path: Path) -> Self:
        """Open a ledger for reading.

        Raises:
            StoreError: If it does not exist, is not a ledger, or is newer than this program.
        """
        with disk_errors(path, "read as a ledger"):
            connection = connect_to_read(path)
            try:
                if not is_empty(connection):
                    check_header(connection, path)
            except BaseException:
                connection.close()
                raise
        return cls(path, connection)

    def close(self) -> None:
        """Close it."""
        self._connection.close()

    def is_begun(self) -> bool:
        """Return whether it has its tables; a killed process may have left it without."""
        with disk_errors(self.path, "read as a ledger"):
            return not is_empty(self._connection)

    def columns(self) -> tuple[Column, ...]:
        """Return the columns of its block files."""
        rows = self._rows("SELECT name, kind FROM outcome ORDER BY place")
        return tuple(Column(*row) for row in rows)

    def block_files(self) -> list[BlockFile]:
        """Return its block files, by first run and configuration."""
        query = "SELECT configurations, first_run, runs, bytes, sha256 FROM block ORDER BY name"
        return [
            BlockFile(RunBlock(numbers(configurations), first_run, runs), size, sha256)
            for configurations, first_run, runs, size, sha256 in self._rows(query)
        ]

    def decisions(self) -> list[Decision]:
        """Return its decisions, by round."""
        rows = self._rows("SELECT round, facts FROM decision ORDER BY round")
        try:
            return [Decision(number, json.loads(facts)) for number, facts in rows]
        except (ValueError, TypeError, RecursionError):
            message = f"{self.path}: is damaged: restore it, or use another folder"
            raise StoreError(message) from None

    def enter(self, file: BlockFile) -> None:
        """Enter a block file that is on the disk, and wait until the entry is.

        Raises:
            StoreError: If a different one of its name is entered, or the entry cannot be written.
        """
        self.check_same(file)
        block = file.block
        values = (block.first_run, block.runs, spans(block.configurations), file.bytes, file.sha256)
        with disk_errors(self.path):
            self._connection.execute(
                "INSERT OR IGNORE INTO block VALUES (?, ?, ?, ?, ?, ?)", (file.name, *values)
            )

    def check_same(self, file: BlockFile) -> None:
        """Refuse a block file that differs from the one entered under its name.

        Raises:
            StoreError: If the same runs had other outcomes before.
        """
        entered = self._rows("SELECT sha256 FROM block WHERE name = ?", file.name)
        if entered and entered[0] != (file.sha256,):
            message = (
                f"{self.path}: block {file.name} was entered with other bytes: the same runs had "
                "other outcomes; check that all machines have the same version of this program"
            )
            raise StoreError(message)

    def note(self, decision: Decision) -> None:
        """Record the decision of a round, unless it is recorded already.

        If it differs from the recorded one, those of later rounds are removed.

        Raises:
            StoreError: If it cannot be written.
        """
        facts = json.dumps(decision.facts, sort_keys=True, allow_nan=False)
        number = decision.round
        if self._rows("SELECT facts FROM decision WHERE round = ?", number) == [(facts,)]:
            return
        with disk_errors(self.path):
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

    def answered(self, question: Answered) -> tuple[Answered, ...]:
        """Record that a question was answered; return all that were, in their order.

        Raises:
            StoreError: If it cannot be written.
        """
        with disk_errors(self.path):
            self._connection.execute(ANSWERED)
            query = "INSERT OR IGNORE INTO answered (words, confidence) VALUES (?, ?)"
            self._connection.execute(query, (question.words, question.confidence))
        return self.questions()

    def questions(self) -> tuple[Answered, ...]:
        """Return the questions that were answered, in their order."""
        query = "SELECT count(*) FROM sqlite_master WHERE name = 'answered'"
        if self._rows(query) == [(0,)]:
            return ()
        rows = self._rows("SELECT words, confidence FROM answered ORDER BY number")
        return tuple(Answered(*row) for row in rows)

    def _rows(self, query: str, *values: object) -> list[tuple[Any, ...]]:
        with disk_errors(self.path, "read as a ledger"):
            return self._connection.execute(query, values).fetchall()


def prepare(connection: sqlite3.Connection, path: Path, columns: Iterable[Column]) -> None:
    """Create the tables of a new ledger in one transaction; check an existing one."""
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = FULL")
    if not is_empty(connection):
        check_header(connection, path)
        return
    connection.executescript(TABLES)
    rows = ((place, column.name, column.kind) for place, column in enumerate(columns))
    connection.executemany("INSERT INTO outcome VALUES (?, ?, ?)", rows)
    connection.execute(f"PRAGMA application_id = {APPLICATION}")
    connection.execute(f"PRAGMA user_version = {VERSION}")
    connection.execute("COMMIT")


def is_empty(connection: sqlite3.Connection) -> bool:
    """Return whether a ledger has no tables: it is new, or its creation was killed."""
    tables = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    return tables == 0 and header(connection, "application_id") == 0


def check_header(connection: sqlite3.Connection, path: Path) -> None:
    """Refuse a file that is not a ledger or newer than this program."""
    if header(connection, "application_id") != APPLICATION:
        message = f"{path}: is not a ledger of a study: use another folder"
        raise StoreError(message)
    version = header(connection, "user_version")
    if version > VERSION:
        message = (
            f"{path}: was written by a newer version of this program (ledger format {version}, "
            f"supported: up to {VERSION}): use that version, or another folder"
        )
        raise StoreError(message)


def header(connection: sqlite3.Connection, name: str) -> int:
    """Return a number from a file's header."""
    return int(connection.execute(f"PRAGMA {name}").fetchone()[0])


def connect_to_read(path: Path) -> sqlite3.Connection:
    """Return a read-only connection, also for folders that cannot be written."""
    check_parts(path)
    connection = connect(path, "ro")
    try:
        connection.execute("SELECT count(*) FROM sqlite_master")
    except sqlite3.OperationalError:
        connection.close()
        if not path.exists() or path.with_name(f"{path.name}-wal").exists():
            raise
        # No process writes, and SQLite cannot create the files for coordinating with a writer.
        return connect(path, "ro", "&immutable=1")
    return connection


def connect(path: Path, mode: str, more: str = "") -> sqlite3.Connection:
    """Open a file by its URI: SQLite reads a path that begins with `file:` as one."""
    address = f"file:{quote(os.fsencode(path.absolute()))}?mode={mode}{more}"
    return sqlite3.connect(address, uri=True, timeout=30, isolation_level=None)


def check_parts(path: Path) -> None:
    """Refuse a ledger if it, or a file that SQLite keeps next to it, is not a regular file."""
    for ending in ("", "-wal", "-shm", "-journal"):
        check_regular(path.with_name(path.name + ending))


def snapshot(path: Path) -> tuple[tuple[Column, ...], list[BlockFile], list[Decision]]:
    """Return the current content of a ledger; empty if the study has not started.

    Raises:
        StoreError: As `Ledger.read`.
    """
    if not path.exists():
        return (), [], []
    with closing(Ledger.read(path)) as ledger:
        if not ledger.is_begun():
            return (), [], []
        return ledger.columns(), ledger.block_files(), ledger.decisions()


def questions(path: Path) -> tuple[Answered, ...]:
    """Return the questions that were answered from the runs of a ledger, in their order.

    Raises:
        StoreError: As `Ledger.read`.
    """
    if not path.exists():
        return ()
    with closing(Ledger.read(path)) as ledger:
        return ledger.questions()

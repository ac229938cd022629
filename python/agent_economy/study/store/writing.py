"""A study's store: stored runs are read, missing ones are computed and stored."""

import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

import pyarrow as pa

from agent_economy._core import InputError
from agent_economy.regular_file import check_regular
from agent_economy.study.errors import StoreError
from agent_economy.study.run_block import (
    Columns,
    Compute,
    Gathered,
    RunBlock,
    parts_of,
)
from agent_economy.study.store import folder as files
from agent_economy.study.store import parquet
from agent_economy.study.store.columns import Column, check_names
from agent_economy.study.store.coverage import Coverage, split
from agent_economy.study.store.ledger import Answered, BlockFile, Decision, Ledger
from agent_economy.study.store.staging import Staging


def never(existing: str, requested: str) -> bool:  # noqa: ARG001
    """Refuse any change of the question."""
    return False


class Store:
    """The outcomes of a study, in a folder that one process writes at a time.

    Open it with `Store.open` as a context manager and read runs with `block`. The process may be
    killed at any moment.

    Attributes:
        folder: The study's folder.
        columns: The columns of every run.
        rows: Number of runs in block files.
        computed: Number of runs computed since it was opened.
        pending: Number of runs that are known of the block that is requested.
    """

    def __init__(self, folder: Path, columns: tuple[Column, ...], opened: ExitStack) -> None:
        """Use `Store.open`."""
        self.folder = folder
        self.columns = columns
        self.rows = 0
        self.computed = self.pending = 0
        self._opened = opened

    @classmethod
    def open(
        cls,
        folder: Path,
        question: str,
        columns: Sequence[Column],
        *,
        content: Mapping[str, bytes] = MappingProxyType({}),
        may_replace: Callable[[str, str], bool] = never,
    ) -> Self:
        """Open a study's folder; it is created if it does not exist.

        Args:
            folder: The folder; what a killed process left unfinished is removed.
            question: The text of study.toml.
            columns: The columns of every run.
            content: Files that the study needs besides, by their digests.
            may_replace: Whether the existing study.toml (first) may be replaced by the requested
                one (second), because they are different questions about the same runs.

        Raises:
            StoreError: If another process uses the folder, it contains another study or is damaged,
                or it cannot be written.
        """
        check_names(tuple(columns))
        with ExitStack() as opened:
            files.make(folder)
            opened.callback(os.close, files.lock(folder))
            files.remove_unfinished(folder)
            store = cls(folder, tuple(columns), opened)
            files.write_files(folder, content)
            store._begin(question, may_replace)
            store._opened = opened.pop_all()
            return store

    def _begin(self, question: str, may_replace: Callable[[str, str], bool]) -> None:
        path = self.folder / files.LEDGER
        # The question is compared first: another study may have other columns.
        is_begun = path.exists() and path.stat().st_size > 0
        files.write_question(self.folder, question, may_replace, is_begun=is_begun)
        self._ledger = Ledger.write(path, self.columns)
        self._opened.callback(self._ledger.close)
        existing = self._ledger.block_files()
        check_files(self.folder, existing)
        self._coverage = Coverage(self.folder, existing)
        self._staging = Staging(self.folder / files.STAGING, self.columns, self._coverage)
        self.rows = sum(file.block.rows for file in existing)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close it; then another process may open it."""
        self._opened.close()

    def answered(self, question: Answered) -> tuple[Answered, ...]:
        """Record that a question was answered from the runs; return all that were, in order."""
        return self._ledger.answered(question)

    def block(self, block: RunBlock, compute: Compute) -> Columns:
        """Return the outcomes of a block of runs.

        Args:
            block: The runs; they may overlap stored blocks only if the runs are the same.
            compute: Called with the missing parts, one at a time, configurations ascending. If it
                is `Partwise`, what it yields is stored within about a second, also if an error or
                Ctrl-C interrupts the block.

        Returns:
            Every column, shape (configurations, runs), in the order of the block.

        Raises:
            StoreError: If a stored block is missing or damaged, or a new one cannot be written;
                also any error that `compute` raises.
            InputError: If `compute` does not return the store's columns.
        """
        parts = list(split(block))
        for part in parts:
            self._coverage.check(part)
        self.pending = 0
        gathered = Gathered(block)
        for part in parts:
            stored = self._coverage.block_files(part)
            missing = self._coverage.missing(part)
            if missing:
                with self._staging.flushed_if_interrupted():
                    data = self._store(missing, self._complete(missing, compute))
                gathered.put(missing, data)
            for file, configurations in stored:
                data = read_block(self.folder, file, self.columns)
                gathered.put(file.block, data, configurations)
                self.pending += len(configurations) * part.runs
        return gathered.columns

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (the project's word)
        """Record the decision of a round for `watch` and the page.

        Recording it again changes nothing; different facts remove those of later rounds.

        Args:
            round: 0 or more.
            facts: JSON values without NaN and infinity.

        Raises:
            StoreError: If it cannot be written.
        """
        self._ledger.note(Decision(round, facts))

    def _complete(self, block: RunBlock, compute: Compute) -> Columns:
        """Return the outcomes of a block: those that are staged, and the others computed."""
        gathered = Gathered(block)
        self._staging.begin(gathered)
        self.pending += gathered.rows
        for missing in list(gathered.missing()):
            with closing(parts_of(compute, missing)) as parts:
                for part, data in parts:
                    self._check_names(data)
                    gathered.put(part, data)
                    self._staging.add(part, data)
                    self.computed += part.rows
                    self.pending += part.rows
        return gathered.columns

    def _check_names(self, columns: Columns) -> None:
        """Refuse outcomes with other columns than those of the store."""
        names = {column.name for column in self.columns}
        if columns.keys() != names:
            wrong = [f"lack {name}" for name in names - columns.keys()]
            wrong += [f"have {name}" for name in columns.keys() - names]
            message = (
                f"the columns that compute returned {', '.join(sorted(wrong))}: "
                f"must be {', '.join(column.name for column in self.columns)}"
            )
            raise InputError(message)

    def _store(self, block: RunBlock, data: Columns) -> Columns:
        """Write outcomes to the disk and enter them; return them as they will be read."""
        encoded = parquet.encode(block, self.columns, data)
        file = BlockFile(block, len(encoded), hashlib.sha256(encoded).hexdigest())
        self._ledger.check_same(file)
        files.write_whole(self.folder / files.BLOCKS / file.name, encoded)
        self._ledger.enter(file)
        self._coverage.add(file)
        self._staging.discard(block)
        self.rows += block.rows
        return parquet.as_read(self.columns, data)


def read_block(folder: Path, file: BlockFile, columns: tuple[Column, ...]) -> Columns:
    """Return the outcomes in a block file.

    Raises:
        StoreError: If it is missing or damaged.
    """
    path = folder / files.BLOCKS / file.name
    data = files.read_bytes(path)
    if data is None:
        check_files(folder, [file])
    if data is None or hashlib.sha256(data).hexdigest() != file.sha256:
        raise StoreError(damaged(path))
    try:
        return parquet.decode(data, file.block, columns)
    except pa.ArrowException as error:
        message = f"{path}: cannot be read ({error})"
        raise StoreError(message) from error


def check_files(folder: Path, block_files: Sequence[BlockFile]) -> None:
    """Refuse a folder in which block files are missing or truncated.

    Raises:
        StoreError: If there are any; it names all.
    """
    errors = []
    for file in block_files:
        path = folder / files.BLOCKS / file.name
        with files.disk_errors(path, "read"):
            check_regular(path)
        try:
            if path.stat().st_size != file.bytes:
                errors.append(damaged(path))
        except FileNotFoundError:
            errors.append(f"{path}: is missing: restore it, or use another folder")
        except OSError as error:
            errors.append(f"{path}: cannot be read ({error.strerror})")
    if errors:
        raise StoreError("\n".join(errors))


def damaged(path: Path) -> str:
    """Return the error message for a block file that differs from its entry."""
    return f"{path}: is damaged (its hash differs): restore it, or use another folder"

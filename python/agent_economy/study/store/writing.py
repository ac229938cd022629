"""A study's store: what is stored is read, what is not is computed and kept."""

import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

import numpy as np
import pyarrow as pa

from agent_economy.study.errors import StoreError
from agent_economy.study.rectangle import Columns, Compute, Rectangle, check_shape
from agent_economy.study.store import folder as files
from agent_economy.study.store import parquet
from agent_economy.study.store.columns import Column, check_names
from agent_economy.study.store.coverage import Coverage, cut
from agent_economy.study.store.ledger import Block, Decision, Ledger


def never(there: str, asked: str) -> bool:  # noqa: ARG001
    """Refuse any change of what is asked."""
    return False


class Store:
    """The outcomes of a study, in a folder that one process writes at a time.

    Open it with `Store.open`, in a `with`; ask with `block`; it may be killed at any moment.

    Attributes:
        folder: Where.
        columns: Of every run.
        rows: Runs that are stored.
        computed: Runs that had to be computed since it was opened.
    """

    def __init__(self, folder: Path, columns: tuple[Column, ...], opened: ExitStack) -> None:
        """Use `Store.open`."""
        self.folder = folder
        self.columns = columns
        self.rows = 0
        self.computed = 0
        self._opened = opened

    @classmethod
    def open(
        cls,
        folder: Path,
        asked: str,
        columns: Sequence[Column],
        *,
        content: Mapping[str, bytes] = MappingProxyType({}),
        may_replace: Callable[[str, str], bool] = never,
    ) -> Self:
        """Open a study's folder, made if it is not there.

        Args:
            folder: Where; what a killed process left half-done is put right.
            asked: The text of study.toml.
            columns: Of every run.
            content: Files that the study needs besides, by their digests.
            may_replace: Whether the study.toml that is there (first) may become the one asked
                (second): they ask another question about the same runs.

        Raises:
            StoreError: If another process works on the folder, it holds another study, what it
                holds is damaged, or it cannot be written.
        """
        check_names(tuple(columns))
        with ExitStack() as opened:
            files.make(folder)
            opened.callback(os.close, files.lock(folder))
            files.remove_unfinished(folder)
            store = cls(folder, tuple(columns), opened)
            files.keep(folder, content)
            store._begin(asked, may_replace)
            store._opened = opened.pop_all()
            return store

    def _begin(self, asked: str, may_replace: Callable[[str, str], bool]) -> None:
        path = self.folder / files.LEDGER
        # What was asked is compared first: another study may well have other columns.
        is_begun = path.exists() and path.stat().st_size > 0
        files.settle(self.folder, asked, may_replace, is_begun=is_begun)
        self._ledger = Ledger.write(path, self.columns)
        self._opened.callback(self._ledger.close)
        blocks = self._ledger.blocks()
        check_there(self.folder, blocks)
        self._coverage = Coverage(self.folder, blocks)
        self.rows = sum(block.rectangle.rows for block in blocks)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close it; another process may open it then."""
        self._opened.close()

    def block(self, rectangle: Rectangle, compute: Compute) -> Columns:
        """Return the outcomes of a rectangle.

        Args:
            rectangle: Its runs must be the same as any stored ones that they overlap.
            compute: Called with what is not stored, configurations ascending, a block at a time.

        Returns:
            Every column, (configurations, runs), in the rectangle's order.

        Raises:
            StoreError: If a stored block is missing or damaged, or a new one cannot be written; or
                for what `compute` raises.
            ValueError: If `compute` gives no outcomes of the store's columns.
        """
        parts = list(cut(rectangle))
        for part in parts:
            self._coverage.check(part)
        if self._coverage.missing(rectangle) == rectangle and parts == [rectangle]:
            return self._keep(rectangle, compute(rectangle))
        gathered = Gathered(rectangle, self.columns)
        for part in parts:
            stored = self._coverage.blocks(part)
            missing = self._coverage.missing(part)
            if missing:
                gathered.put(missing, self._keep(missing, compute(missing)))
            for block, configurations in stored:
                data = read_block(self.folder, block, self.columns)
                gathered.put(block.rectangle, data, configurations)
        return gathered.columns

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (the project's word)
        """Write down what was decided in a round, for those who watch.

        The same again changes nothing; other facts remove those of later rounds.

        Args:
            round: 0 or more.
            facts: What JSON can hold, without NaN and infinity.

        Raises:
            StoreError: If it cannot be written.
        """
        self._ledger.note(Decision(round, facts))

    def _keep(self, rectangle: Rectangle, given: Columns) -> Columns:
        """Put outcomes on the disk, then enter them; return them as they will be read."""
        if {column.name for column in self.columns} != given.keys():
            message = f"columns {', '.join(given)} are not those of the store"
            raise ValueError(message)
        data = {name: np.asarray(values, dtype=np.float64) for name, values in given.items()}
        check_shape(rectangle, data)
        encoded = parquet.encode(rectangle, self.columns, data)
        block = Block(rectangle, len(encoded), hashlib.sha256(encoded).hexdigest())
        self._ledger.check_same(block)
        files.write_whole(self.folder / files.BLOCKS / block.name, encoded)
        self._ledger.enter(block)
        self._coverage.add(block)
        self.rows += rectangle.rows
        self.computed += rectangle.rows
        return parquet.as_read(self.columns, data)


class Gathered:
    """Outcomes of a rectangle, put together from blocks."""

    def __init__(self, rectangle: Rectangle, columns: tuple[Column, ...]) -> None:
        """Start with none."""
        self._rectangle = rectangle
        self._places = {each: row for row, each in enumerate(rectangle.configurations)}
        self.columns: Columns = {column.name: np.empty(rectangle.shape) for column in columns}

    def put(
        self, area: Rectangle, data: Columns, configurations: Sequence[int] | None = None
    ) -> None:
        """Put in what a block holds, of all its configurations or of some."""
        wanted = area.configurations if configurations is None else configurations
        rows = {each: row for row, each in enumerate(area.configurations)}
        source = span([rows[each] for each in wanted])
        target = span([self._places[each] for each in wanted])
        first = area.first_run - self._rectangle.first_run
        for name, values in data.items():
            self.columns[name][target, first : first + area.runs] = values[source]


def read_block(folder: Path, block: Block, columns: tuple[Column, ...]) -> Columns:
    """Return the outcomes that a study's block holds.

    Raises:
        StoreError: If its file is missing or damaged.
    """
    path = folder / files.BLOCKS / block.name
    data = files.read_bytes(path)
    if data is None:
        check_there(folder, [block])
    if data is None or hashlib.sha256(data).hexdigest() != block.sha256:
        raise StoreError(damaged(path))
    try:
        return parquet.decode(data, block.rectangle, columns)
    except pa.ArrowException as error:
        message = f"{path}: cannot be read ({error})"
        raise StoreError(message) from error


def span(places: list[int]) -> slice | list[int]:
    """Return places as a slice if they are consecutive: numpy copies it several times faster."""
    first, end = places[0], places[0] + len(places)
    return slice(first, end) if places == list(range(first, end)) else places


def check_there(folder: Path, blocks: Sequence[Block]) -> None:
    """Refuse a folder in which files of blocks are missing or cut short.

    Raises:
        StoreError: If there are such; it names all.
    """
    faults = []
    for block in blocks:
        path = folder / files.BLOCKS / block.name
        try:
            if path.stat().st_size != block.bytes:
                faults.append(damaged(path))
        except FileNotFoundError:
            faults.append(f"{path}: is missing: restore it, or use another folder")
        except OSError as error:
            faults.append(f"{path}: cannot be read ({error.strerror})")
    if faults:
        raise StoreError("\n".join(faults))


def damaged(path: Path) -> str:
    """Return what to say of a block that is not as it was entered."""
    return f"{path}: is not as it was written (its hash differs): restore it, or use another folder"

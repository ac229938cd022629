"""Reads the run of a recording from its file alone, up to where the file is truncated."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from errno import EINVAL
from pathlib import Path
from typing import IO, Any, cast

from mcap.exceptions import EndOfFile
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader

from agent_economy._core import InputError
from agent_economy.recording.fields import Entries
from agent_economy.recording.identity import (
    CHANGE,
    RUN,
    Identity,
    read_change,
    read_external,
    read_identity,
    read_run,
)
from agent_economy.regular_file import open_regular
from agent_economy.runs.stepped import Change

MAX_BYTES = 2**30
"""Maximum size of one record, such as an attached map."""


@dataclass(frozen=True)
class Point:
    """A recorded state.

    Attributes:
        tick: Number of steps before it.
        changes: Number of changes of the scenario before it.
        hash: Hash of the state: 64 bits, hexadecimal.
        decisions: Hash of the decisions so far; None if it was not recorded.
    """

    tick: int
    changes: int
    hash: str
    decisions: str | None = None


@dataclass
class Recorded:
    """The contents of a recording.

    Attributes:
        points: The recorded states, in order.
        changes: The changes of the scenario, in order.
        inputs: The external inputs, by tick.
        is_complete: Whether the file has its end, that is, it is not truncated.
    """

    points: list[Point] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    inputs: dict[int, dict[str, Any]] = field(default_factory=dict)
    is_complete: bool = False
    _run: Mapping[str, str] | None = None
    _attached: dict[str, bytes] = field(default_factory=dict)
    _topics: dict[int, str] = field(default_factory=dict)

    def read_all(self, stream: IO[bytes]) -> None:
        """Add the records of a file, up to its end or to where it is truncated."""
        with suppress(EndOfFile):
            for record in stream_records(stream):
                self.add(record)
            self.is_complete = True

    def add(self, record: McapRecord) -> None:
        """Add the contents of a record; most records are for viewers only."""
        match record:
            case Metadata() if record.name == RUN:
                self._run = record.metadata
            case Metadata() if record.name == CHANGE:
                self.changes.append(read_change(record.metadata))
            case Attachment():
                self._attached[record.name] = record.data
            case Channel():
                self._topics[record.id] = record.topic
            case Message():
                self._add_message(self._topics.get(record.channel_id, ""), record.data)

    @property
    def external(self) -> tuple[str, ...]:
        """Names of the robots that had external bodies from the start."""
        return () if self._run is None else read_external(read_run(self._run))

    def identity(self) -> Identity:
        """Return the identity of the run.

        Raises:
            InputError: If it is missing, or contradicts the other contents.
        """
        if self._run is None:
            message = f"is not a recording of a run: it has no metadata {RUN!r}"
            raise InputError(message)
        identity = read_identity(self._run, self._attached)
        changes = max((point.changes for point in self.points), default=0)
        if changes > len(self.changes):
            message = (
                f"is damaged: its states have {changes} changes, but it has {len(self.changes)}"
            )
            raise InputError(message)
        if self.inputs and identity.scenario.engine != "metric":
            message = "is damaged: it has percepts or commands for robots that accept none"
            raise InputError(message)
        return identity

    def _add_message(self, topic: str, data: bytes) -> None:
        if topic == "/run":
            self.points.append(read_point(Entries(f"topic {topic}", json.loads(data))))
        elif topic == "/input":
            self._add_input(Entries(f"topic {topic}", json.loads(data)))

    def _add_input(self, entries: Entries) -> None:
        each = {name: entries.by_name(name) for name in ("percepts", "commands")}
        self.inputs[entries.whole("tick")] = each


def read_point(run: Entries) -> Point:
    """Return a recorded state; old recordings have no hash of the decisions."""
    decisions = run.hash("decisions") if run.has_value("decisions") else None
    return Point(run.whole("tick"), run.whole("changes"), run.text("hash"), decisions)


def stream_records(stream: IO[bytes]) -> Iterator[McapRecord]:
    """Yield the records of a stream.

    Raises:
        EndOfFile: After the last one, if the file is truncated.
    """
    exact = cast("IO[bytes]", ExactStream(stream))  # the reader uses only this method
    yield from StreamReader(exact, validate_crcs=True, record_size_limit=MAX_BYTES).records


def each_record(path: Path) -> Iterator[McapRecord]:
    """Yield the records of a file, up to its end or to where it is truncated.

    Raises:
        InputError: If it cannot be read, or is damaged.
    """
    with file_errors(path), open_regular(path) as stream, suppress(EndOfFile):
        yield from stream_records(stream)


def read(path: Path) -> tuple[Identity, Recorded]:
    """Read the identity and the contents of a recording.

    A truncated file, for example of a killed process, is read up to its end.

    Raises:
        InputError: If it cannot be read, is damaged, or is not a recording of a run.
    """
    recorded = Recorded()
    with file_errors(path), open_regular(path) as stream:
        recorded.read_all(stream)
        identity = recorded.identity()
    return identity, recorded


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Add the name of the file to errors of its contents.

    Raises:
        InputError: If there is such an error.
    """
    try:
        yield
    except InputError as error:
        message = f"{path}: {error}"
        raise InputError(message) from None


@contextmanager
def file_errors(path: Path) -> Iterator[None]:
    """Convert all errors of reading a file to one that names it.

    Raises:
        InputError: If there is such an error.
    """
    try:
        with named(path):
            yield
    except InputError:
        raise
    except OSError as error:
        message = f"{path}: cannot be read: {error.strerror or error}"
        if error.errno == EINVAL:  # an index points to before the start of the file
            message = f"{path}: is damaged: parts are missing"
    # The exceptions that the libraries raise for damaged bytes are not documented.
    except Exception as error:  # noqa: BLE001
        is_missing = isinstance(error, EndOfFile | LookupError)
        why = "parts are missing" if is_missing else str(error) or type(error).__name__
        message = f"{path}: is not an MCAP file, or is damaged: {why}"
    else:
        return
    raise InputError(message)


class ExactStream:
    """A stream that returns exactly the requested number of bytes, or raises `EndOfFile`.

    Otherwise, the reader reports damage if the file is truncated within a number.
    """

    def __init__(self, stream: IO[bytes]) -> None:
        """Wrap a stream at its current position."""
        self._stream = stream

    def read(self, length: int) -> bytes:
        """Return the next `length` bytes.

        Raises:
            EndOfFile: If there are fewer.
        """
        data = self._stream.read(length)
        if len(data) < length:
            raise EndOfFile
        return data

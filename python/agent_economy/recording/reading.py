"""What a recording says of its run: read from the file alone, as far as that goes."""

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
from agent_economy.recording.identity import CHANGE, RUN, Identity, read_change, read_identity
from agent_economy.runs.stepped import Change

MAX_BYTES = 2**30
"""Of one record: an attached map and some more."""


@dataclass(frozen=True)
class Point:
    """A state that was recorded.

    Attributes:
        tick: Steps that had been taken.
        changes: Changes of the scenario until then.
        hash: Of the state, 64 bits, hexadecimal.
    """

    tick: int
    changes: int
    hash: str


@dataclass
class Recorded:
    """What a recording says of its run.

    Attributes:
        points: States, in their order.
        changes: Of the scenario, in their order.
        inputs: What came from outside, by the tick.
        is_whole: Whether the file has its end.
    """

    points: list[Point] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    inputs: dict[int, dict[str, Any]] = field(default_factory=dict)
    is_whole: bool = False
    _run: Mapping[str, str] | None = None
    _attached: dict[str, bytes] = field(default_factory=dict)
    _topics: dict[int, str] = field(default_factory=dict)

    def take_all(self, stream: IO[bytes]) -> None:
        """Add what a file says up to its end, or where it is cut."""
        unbroken = cast("IO[bytes]", Unbroken(stream))  # the reader needs no more of a stream
        reader = StreamReader(unbroken, validate_crcs=True, record_size_limit=MAX_BYTES)
        with suppress(EndOfFile):
            for record in reader.records:
                self.take(record)
            self.is_whole = True

    def take(self, record: McapRecord) -> None:
        """Add what a record says; most say nothing of what is needed here."""
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
                self._take_message(self._topics.get(record.channel_id, ""), record.data)

    def identity(self) -> Identity:
        """Return which run it is.

        Raises:
            InputError: If what was read does not say so.
        """
        if self._run is None:
            message = f"is no recording of a run: it has no metadata {RUN!r}"
            raise InputError(message)
        identity = read_identity(self._run, self._attached)
        most = max((point.changes for point in self.points), default=0)
        if most > len(self.changes):
            message = (
                f"is damaged: it has states after {most} changes, and {len(self.changes)} changes"
            )
            raise InputError(message)
        if self.inputs and identity.scenario.engine != "metric":
            message = "is damaged: it has percepts or commands for robots that take none"
            raise InputError(message)
        return identity

    def _take_message(self, topic: str, data: bytes) -> None:
        if topic == "/run":
            run = Entries(f"topic {topic}", json.loads(data))
            self.points.append(Point(run.whole("tick"), run.whole("changes"), run.text("hash")))
        elif topic == "/input":
            self._take_input(Entries(f"topic {topic}", json.loads(data)))

    def _take_input(self, came: Entries) -> None:
        each = {name: came.by_name(name) for name in ("percepts", "commands")}
        self.inputs[came.whole("tick")] = each


def read(path: Path) -> tuple[Identity, Recorded]:
    """Read which run a recording is of, and what it says of it.

    A file that is cut, as by a process that was killed, is read as far as it goes.

    Raises:
        InputError: If it cannot be read, is damaged, or is no recording of a run of this program.
    """
    recorded = Recorded()
    with told(path), path.open("rb") as stream:
        recorded.take_all(stream)
        identity = recorded.identity()
    return identity, recorded


@contextmanager
def named(path: Path) -> Iterator[None]:
    """Say of which file it is that something in it cannot be taken.

    Raises:
        InputError: If so.
    """
    try:
        yield
    except InputError as error:
        message = f"{path}: {error}"
        raise InputError(message) from None


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Say of which file it is, and what is wrong with it, if it cannot be read.

    Raises:
        InputError: If so.
    """
    try:
        with named(path):
            yield
    except InputError:
        raise
    except OSError as error:
        message = f"{path}: cannot be read: {error.strerror or error}"
        if error.errno == EINVAL:  # an index sent the reader to before the file's beginning
            message = f"{path}: is damaged: parts are missing"
    # What libraries raise for damaged bytes is listed nowhere.
    except Exception as error:  # noqa: BLE001
        is_missing = isinstance(error, EndOfFile | LookupError)
        why = "parts are missing" if is_missing else str(error) or type(error).__name__
        message = f"{path}: is no MCAP file, or damaged: {why}"
    else:
        return
    raise InputError(message)


class Unbroken:
    """A stream that gives all of what is asked for, or says that it is cut.

    The reader takes a cut for damage where it is in the middle of a number.
    """

    def __init__(self, stream: IO[bytes]) -> None:
        """Begin where a stream is."""
        self._stream = stream

    def read(self, length: int) -> bytes:
        """Return so many bytes.

        Raises:
            EndOfFile: If there are fewer.
        """
        data = self._stream.read(length)
        if len(data) < length:
            raise EndOfFile
        return data

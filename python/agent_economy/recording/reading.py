"""Reads the run of a recording from its file alone, up to where it is truncated or damaged."""

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from errno import EINVAL
from pathlib import Path
from typing import IO, Any

from mcap.exceptions import EndOfFile
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata

from agent_economy._core import InputError
from agent_economy.recording.fields import Entries
from agent_economy.recording.identity import (
    CHANGE,
    END,
    RUN,
    Identity,
    read_change,
    read_external,
    read_identity,
    read_run,
)
from agent_economy.recording.records import stream_records
from agent_economy.recording.stops import Stops
from agent_economy.regular_file import open_regular
from agent_economy.runs.external import ExternalBody
from agent_economy.runs.stepped import Change
from agent_economy.whole_file import is_being_written


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

    @property
    def place(self) -> tuple[int, int]:
        """What orders it among the states of a recording."""
        return self.tick, self.changes


@dataclass
class Recorded:
    """The contents of a recording.

    Attributes:
        points: The recorded states, in order.
        changes: The changes of the scenario, in order.
        inputs: The external inputs, by tick.
        is_complete: Whether the whole file has been read: it is neither truncated nor damaged.
        stops: When robots of a drive were stopped.
        damage: Why it is damaged, behind what has been read; None if it is not.
    """

    points: list[Point] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    inputs: dict[int, dict[str, Any]] = field(default_factory=dict)
    is_complete: bool = False
    damage: str | None = None
    stops: Stops = field(default_factory=Stops)
    _run: Mapping[str, str] | None = None
    _end: Mapping[str, str] | None = None
    _attached: dict[str, bytes] = field(default_factory=dict)
    _topics: dict[int, str] = field(default_factory=dict)

    def read_all(self, stream: IO[bytes]) -> None:
        """Add the records of a file, up to its end, or to where it is truncated or damaged.

        Raises:
            InputError: If it is damaged before its first state.
        """
        with suppress(EndOfFile):
            self.damage = read_records(stream, self.add) or self._wrong_end()
            self.is_complete = self.damage is None
        if self.damage is not None and not self.points:
            message = self.damage
            if not message.startswith("is "):
                message = f"is not an MCAP file, or is damaged: {message}"
            raise InputError(message)

    @property
    def damaged_tick(self) -> int | None:
        """The tick of the last state before the damage; None if the file is not damaged."""
        return None if self.damage is None else self.points[-1].tick

    def add(self, record: McapRecord) -> None:
        """Add the contents of a record; most records are for viewers only."""
        match record:
            case Metadata() if record.name == RUN:
                self._run = record.metadata
            case Metadata() if record.name == CHANGE:
                self.changes.append(read_change(record.metadata))
            case Metadata() if record.name == END:
                self._end = record.metadata  # it may be before the last messages
            case Attachment():
                self._attached[record.name] = record.data
            case Channel():
                self._topics[record.id] = record.topic
            case Message():
                self._add_message(self._topics.get(record.channel_id, ""), record.data)

    @property
    def external(self) -> dict[str, ExternalBody]:
        """The bodies that were external from the start, by robot name."""
        return {} if self._run is None else read_external(read_run(self._run))

    def identity(self) -> Identity:
        """Return the identity of the run.

        Raises:
            InputError: If it is missing, or contradicts the other contents.
        """
        if self._run is None:
            message = f"is not a recording of a run: it has no metadata {RUN!r}"
            raise InputError(message)
        identity = read_identity(self._run, self._attached)
        if self.inputs and identity.scenario.engine != "metric":
            message = "is damaged: it has percepts or commands for robots that accept none"
            raise InputError(message)
        return identity

    def _wrong_end(self) -> str | None:
        """Return what is wrong with the end of a whole file; None if nothing is."""
        if self._end is None or not self.points:
            return None
        end, last = Entries(f"metadata {END!r}", self._end), self.points[-1]
        try:
            decisions = end.text("decisions") if "decisions" in end else last.decisions
            states = end.whole("tick"), end.text("hash"), decisions
        except InputError as error:
            return str(error)
        if states != (last.tick, last.hash, last.decisions):
            return f"is damaged: its metadata {END!r} are not those of its last state"
        return None

    def _add_message(self, topic: str, data: bytes) -> None:
        if topic == "/run":
            self._add_point(read_point(Entries(f"topic {topic}", json.loads(data))))
        elif topic == "/input":
            self._add_input(Entries(f"topic {topic}", json.loads(data)))
        else:
            self.stops.add(topic, data)

    def _add_point(self, point: Point) -> None:
        if self.points and point.place <= self.points[-1].place:
            message = "is damaged: its states are not in order"
            raise InputError(message)
        if point.changes > len(self.changes):
            message = (
                f"is damaged: its states have {point.changes} changes, but it has "
                f"{len(self.changes)}"
            )
            raise InputError(message)
        self.points.append(point)

    def _add_input(self, entries: Entries) -> None:
        each = {name: entries.by_name(name) for name in ("percepts", "commands")}
        if "observed" in entries:
            each["observed"] = entries.by_name("observed")
        self.inputs[entries.whole("tick")] = each


def read_point(run: Entries) -> Point:
    """Return a recorded state; old recordings have no hash of the decisions."""
    decisions = run.hash("decisions") if run.has_value("decisions") else None
    return Point(run.whole("tick"), run.whole("changes"), run.text("hash"), decisions)


def read_records(stream: IO[bytes], add: Callable[[McapRecord], None]) -> str | None:
    """Pass on the records of a stream, up to its end or to the first damaged one.

    Returns:
        Why it is damaged; None if it is not.

    Raises:
        EndOfFile: After the last one, if the file is truncated.
    """
    try:
        for record in stream_records(stream):
            add(record)
    except EndOfFile:
        raise
    # The exceptions that the libraries raise for damaged bytes are not documented. A sector of a
    # disk that cannot be read hides nothing before it, either.
    except Exception as error:  # noqa: BLE001
        return str(error) or type(error).__name__
    return None


def read(path: Path) -> tuple[Identity, Recorded]:
    """Read the identity and the contents of a recording.

    A truncated file, for example of a killed process, is read up to its end, a damaged one up to
    the damage.

    Raises:
        InputError: If it cannot be read, is damaged before its first state, or is not a recording
            of a run.
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
    except InputError as error:
        message = str(error)
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
    if is_being_written(path):
        message += "; it is still being written: try again later"
    raise InputError(message)

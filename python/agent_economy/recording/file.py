"""A file in MCAP: messages by topic, metadata, and what is attached.

Source: the specification of MCAP (mcap.dev/spec).
"""

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from google.protobuf.message import Message
from mcap.writer import LIBRARY_IDENTIFIER, Writer
from mcap_protobuf.schema import register_schema

from agent_economy import __version__
from agent_economy._core import InputError

CHUNK_BYTES = 2**20


class RecordingError(InputError):
    """A recording cannot go on, as its disk is full or gone: not what was asked is wrong.

    It is an `InputError` too, so that who calls from Python catches all that a file can be.
    """


class Output:
    """Where a file's bytes go; a fault names the file, and closes it.

    Attributes:
        is_open: Whether more can be written.
    """

    is_open: bool

    def __init__(self, path: Path) -> None:
        """Begin a file in the place of any that was there.

        Raises:
            InputError: If it cannot be written.
        """
        try:
            self._stream = path.open("wb")
        except OSError as error:
            message = f"{path}: cannot be written: {error.strerror or error}"
            raise InputError(message) from None
        self._path, self.is_open = path, True

    def write(self, data: bytes) -> int:
        """Write all bytes, or into the buffer."""
        with self._told():
            return self._stream.write(data)

    def tell(self) -> int:
        """Return how many bytes there are."""
        return self._stream.tell()

    def flush(self) -> None:
        """Hand all to the system."""
        with self._told():
            self._stream.flush()

    def close(self) -> None:
        """Hand all to the system; nothing can be written after that."""
        self.is_open = False
        with self._told():
            self._stream.close()

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self.is_open = False
            with suppress(OSError):
                self._stream.close()
            message = (
                f"{self._path}: cannot be written any further: {error.strerror or error}: make "
                "room, write it elsewhere, or record fewer moments (every = 10, --every 10); what "
                "is there can be taken again with agent-economy replay"
            )
            raise RecordingError(message) from None


class File:
    """A file on its way to the disk; nothing in it depends on when or where it is written."""

    def __init__(self, path: Path) -> None:
        """Begin a file in the place of any that was there.

        Raises:
            InputError: If it cannot be written.
        """
        self._output = Output(path)
        output = cast("IO[bytes]", self._output)  # the writer needs no more of a stream
        self._writer = Writer(output, chunk_size=CHUNK_BYTES)
        self._writer.start(library=f"agent-economy/{__version__} {LIBRARY_IDENTIFIER}")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    @property
    def is_open(self) -> bool:
        """Whether more can be written: it is neither closed nor has its disk refused anything."""
        return self._output.is_open

    def attach(self, name: str, media_type: str, data: bytes) -> None:
        """Attach a file."""
        self._writer.add_attachment(0, 0, name, media_type, data)

    def note(self, name: str, values: Mapping[str, str]) -> None:
        """Add metadata."""
        self._writer.add_metadata(name, dict(values))

    def has(self, topic: str) -> bool:
        """Return whether anything was written on a topic, or declared."""
        return topic in self._channels

    def write(self, topic: str, message: Message, time_ns: int) -> None:
        """Write a message of one of Foxglove's schemas."""
        self.write_parts(topic, type(message), [message], time_ns)

    def write_parts(
        self, topic: str, kind: type[Message], parts: Iterable[Message], time_ns: int
    ) -> None:
        """Write one message whose lists are those of all parts, one after another.

        What is in Python at once is a part; as bytes a message takes a tenth of that room.
        """
        channel = self._channels.get(topic)
        if channel is None:
            name = kind.DESCRIPTOR.full_name
            if name not in self._schemas:
                self._schemas[name] = register_schema(self._writer, kind)
            channel = self._open(topic, "protobuf", self._schemas[name])
        # In Protobuf, bytes of messages one after another are those of the messages merged.
        data = b"".join(part.SerializeToString() for part in parts)
        self._writer.add_message(channel, time_ns, data, time_ns)

    def declare(self, topic: str, schema: str, about: Mapping[str, str] | None = None) -> None:
        """Say what is written on a topic as JSON, once."""
        if topic in self._channels:
            return
        if schema not in self._schemas:
            name, data = json.loads(schema)["title"], schema.encode()
            self._schemas[schema] = self._writer.register_schema(name, "jsonschema", data)
        self._open(topic, "json", self._schemas[schema], about)

    def write_json(self, topic: str, message: object, time_ns: int) -> None:
        """Write JSON on a topic that has been declared; what is not finite is null."""
        try:
            text = json.dumps(message, separators=(",", ":"), allow_nan=False)
        except ValueError:
            text = json.dumps(strict(message), separators=(",", ":"))
        self._writer.add_message(self._channels[topic], time_ns, text.encode(), time_ns)

    def flush(self) -> None:
        """Hand all that is written to the system: it is there even if this process is killed."""
        self._writer.flush()  # type: ignore[no-untyped-call]

    def close(self) -> None:
        """Write the index, and close the file."""
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
        finally:
            if self.is_open:
                self._output.close()

    def _open(
        self, topic: str, encoding: str, schema: int, about: Mapping[str, str] | None = None
    ) -> int:
        channel = self._writer.register_channel(topic, encoding, schema, dict(about or {}))
        self._channels[topic] = channel
        return channel


def strict(value: Any) -> Any:
    """Return a value as JSON has it: arrays are lists, and what is not finite is null."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {str(key): strict(each) for key, each in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, str):
        return [strict(each) for each in value]
    return value

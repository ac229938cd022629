"""An MCAP file: messages by topic, metadata, and attachments.

Source: the specification of MCAP (mcap.dev/spec).
"""

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from io import BufferedWriter
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from google.protobuf.message import Message
from mcap.writer import LIBRARY_IDENTIFIER, Writer
from mcap_protobuf.schema import register_schema

from agent_economy import __version__
from agent_economy._core import InputError
from agent_economy.recording.output import open_replacing

CHUNK_BYTES = 2**20


class RecordingError(InputError):
    """The recording cannot continue because its disk is full or missing.

    It is also an `InputError`, so that one `except` covers all errors of files.
    """


class Output:
    """The stream of a file; an error names the file, and closes it.

    Attributes:
        is_open: Whether the file accepts more bytes.
    """

    is_open: bool

    def __init__(self, file: Path | BufferedWriter) -> None:
        """Create a file, replacing an existing one that is not the recording of a drive.

        Args:
            file: Its path, or an empty file that stays open when this one is closed.

        Raises:
            InputError: If it is one or being written, or cannot be written.
        """
        if isinstance(file, Path):
            self._path, self._stream = file, open_replacing(file)
        else:
            self._path, self._stream = Path(file.name), os.fdopen(os.dup(file.fileno()), "wb")
        self.is_open = True

    def write(self, data: bytes) -> int:
        """Write or buffer all bytes."""
        with self._errors_named():
            return self._stream.write(data)

    def tell(self) -> int:
        """Return the number of bytes written."""
        return self._stream.tell()

    def flush(self) -> None:
        """Flush the buffer to the operating system."""
        with self._errors_named():
            self._stream.flush()

    def close(self) -> None:
        """Flush the buffer and close the file."""
        self.is_open = False
        with self._errors_named():
            self._stream.close()

    @contextmanager
    def _errors_named(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            self.is_open = False
            with suppress(OSError):
                self._stream.close()
            message = (
                f"{self._path}: recording stopped: {error.strerror or error}: free some space, "
                "write to another disk, or record fewer steps (every = 10, --every 10); the steps "
                "recorded so far can be replayed with agent-economy replay"
            )
            raise RecordingError(message) from None


class File:
    """A file that is being written. Its bytes do not depend on when or where it is written."""

    def __init__(self, file: Path | BufferedWriter) -> None:
        """Create a file as `Output` does.

        Raises:
            InputError: If it cannot be written.
        """
        self._output = Output(file)
        output = cast("IO[bytes]", self._output)  # the writer uses only these methods
        # Chunks and attachments have checksums of their own; metadata have none.
        self._writer = Writer(output, chunk_size=CHUNK_BYTES, enable_data_crcs=True)
        self._writer.start(library=f"agent-economy/{__version__} {LIBRARY_IDENTIFIER}")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

    @property
    def is_open(self) -> bool:
        """Whether the file accepts more messages: it is not closed, and no write has failed."""
        return self._output.is_open

    def attach(self, name: str, media_type: str, data: bytes) -> None:
        """Attach a file."""
        self._writer.add_attachment(0, 0, name, media_type, data)

    def note(self, name: str, values: Mapping[str, str]) -> None:
        """Add metadata."""
        self._writer.add_metadata(name, dict(values))

    def has(self, topic: str) -> bool:
        """Return whether a topic has been declared or written."""
        return topic in self._channels

    def write(self, topic: str, message: Message, time_ns: int) -> None:
        """Write a message with a Foxglove schema."""
        self.write_parts(topic, type(message), [message], time_ns)

    def write_parts(
        self, topic: str, kind: type[Message], parts: Iterable[Message], time_ns: int
    ) -> None:
        """Write one message that consists of all parts, with their lists concatenated.

        Only one part at a time is a Python object; serialised, it takes a tenth of the memory.
        """
        channel = self._channels.get(topic)
        if channel is None:
            name = kind.DESCRIPTOR.full_name
            if name not in self._schemas:
                self._schemas[name] = register_schema(self._writer, kind)
            channel = self._open(topic, "protobuf", self._schemas[name])
        # In Protobuf, concatenated bytes of messages are the bytes of the merged message.
        data = b"".join(part.SerializeToString() for part in parts)
        self._writer.add_message(channel, time_ns, data, time_ns)

    def declare(self, topic: str, schema: str, about: Mapping[str, str] | None = None) -> None:
        """Declare a topic with JSON messages, unless it is declared already."""
        if topic in self._channels:
            return
        if schema not in self._schemas:
            name, data = json.loads(schema)["title"], schema.encode()
            self._schemas[schema] = self._writer.register_schema(name, "jsonschema", data)
        self._open(topic, "json", self._schemas[schema], about)

    def write_json(self, topic: str, message: object, time_ns: int) -> None:
        """Write JSON to a declared topic, with null for numbers that are not finite."""
        try:
            text = json.dumps(message, separators=(",", ":"), allow_nan=False)
        except ValueError:
            text = json.dumps(strict(message), separators=(",", ":"))
        self._writer.add_message(self._channels[topic], time_ns, text.encode(), time_ns)

    def flush(self) -> None:
        """Flush all messages to the operating system; they survive a kill of this process."""
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
    """Return a value for JSON: arrays become lists, numbers that are not finite become null."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {str(key): strict(each) for key, each in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, str):
        return [strict(each) for each in value]
    return value

"""A file in MCAP: messages by topic, metadata, and what is attached.

Source: the specification of MCAP (mcap.dev/spec).
"""

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import Message
from mcap.writer import LIBRARY_IDENTIFIER, Writer
from mcap_protobuf.schema import register_schema

from agent_economy import __version__
from agent_economy._core import InputError

CHUNK_BYTES = 2**20


class File:
    """A file on its way to the disk; nothing in it depends on when or where it is written."""

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
        self._writer = Writer(self._stream, chunk_size=CHUNK_BYTES)
        self._writer.start(library=f"agent-economy/{__version__} {LIBRARY_IDENTIFIER}")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}

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
        with self._stream:
            self._writer.finish()  # type: ignore[no-untyped-call]

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

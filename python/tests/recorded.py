"""Recordings, read by the protobuf decoder of MCAP's makers from what the file itself declares."""

import json
from collections import defaultdict
from pathlib import Path
from typing import Any, NamedTuple

from mcap.reader import make_reader
from mcap.records import Attachment, Metadata
from mcap_protobuf.decoder import DecoderFactory

SECOND_NS = 1_000_000_000


class Message(NamedTuple):
    """A message and when it was written."""

    time_ns: int
    content: Any


class Contents(NamedTuple):
    """All that is in a file."""

    topics: dict[str, list[Message]]
    schemas: dict[str, Any]
    metadata: list[Metadata]
    attachments: list[Attachment]


def contents(path: Path) -> Contents:
    """Return all that is in a file that has its end."""
    topics: dict[str, list[Message]] = defaultdict(list)
    schemas: dict[str, Any] = {}
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message in reader.iter_messages():
            assert schema is not None
            schemas[channel.topic] = schema
            if channel.message_encoding == "json":
                content = json.loads(message.data)
            else:
                decode = DecoderFactory().decoder_for(channel.message_encoding, schema)
                assert decode is not None
                content = decode(message.data)
            topics[channel.topic].append(Message(message.log_time, content))
        return Contents(
            topics, schemas, list(reader.iter_metadata()), list(reader.iter_attachments())
        )

"""Reads the records of an MCAP file in order, up to its end or to the first damaged one.

The library's reader skips records of kinds that it does not know, such as the zeros that a file
system leaves behind a file after a power failure, and attachments with a wrong checksum.

Source: the specification of MCAP (mcap.dev/spec).
"""

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import IO, cast

from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile, InvalidMagic, RecordLengthLimitExceeded
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    DataEnd,
    Header,
    McapRecord,
    Message,
    MessageIndex,
    Metadata,
    Schema,
)
from mcap.stream_reader import breakup_chunk

MAGIC = b"\x89MCAP0\r\n"
"""First and last bytes of an MCAP file."""

MAX_BYTES = 2**30
"""Maximum size of one record, such as an attached map."""

HEAD = struct.Struct("<BQ")
"""The kind of a record, and its length."""

CRC_BYTES = 4

IN_SUMMARY = {
    Opcode.SCHEMA,
    Opcode.CHANNEL,
    Opcode.CHUNK_INDEX,
    Opcode.ATTACHMENT_INDEX,
    Opcode.METADATA_INDEX,
    Opcode.STATISTICS,
    Opcode.SUMMARY_OFFSET,
    Opcode.FOOTER,
}


class DamageError(Exception):
    """A record is damaged; the message is why."""


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


def stream_records(stream: IO[bytes]) -> Iterator[McapRecord]:
    """Yield the records of a stream, without those of its index.

    Raises:
        EndOfFile: After the last one, if the file is truncated.
        Exception: After the last one before the first that is damaged. The exceptions that the
            library raises for damaged bytes are not documented.
    """
    exact = ExactStream(stream)
    if (start := exact.read(len(MAGIC))) != MAGIC:
        raise InvalidMagic(start)
    yield from _data_records(exact)
    opcode = None
    while opcode != Opcode.FOOTER:
        opcode, _, _ = _next_record(exact)
        _check(opcode in IN_SUMMARY, f"its index has a record of kind {opcode}")
    _check(exact.read(len(MAGIC)) == MAGIC, "its last bytes are not those of an MCAP file")


def _data_records(exact: ExactStream) -> Iterator[McapRecord]:
    """Yield the records before the index."""
    before, crc = None, zlib.crc32(MAGIC)
    while before != Opcode.DATA_END:
        opcode, head, content = _next_record(exact)
        is_first, is_header = before is None, opcode == Opcode.HEADER
        _check(is_first == is_header, f"a record of kind {opcode} is at a wrong place")
        if opcode == Opcode.MESSAGE_INDEX:
            _check(before in (Opcode.CHUNK, Opcode.MESSAGE_INDEX), "an index without a chunk")
        yield from _parsed(opcode, content, crc)
        crc = zlib.crc32(content, zlib.crc32(head, crc))
        before = opcode


def _next_record(exact: ExactStream) -> tuple[int, bytes, bytes]:
    """Return the kind, the head and the content of a record."""
    opcode, length = HEAD.unpack(head := exact.read(HEAD.size))
    if length > MAX_BYTES:
        raise RecordLengthLimitExceeded(opcode, length, MAX_BYTES)
    _check(opcode in Opcode.__members__.values(), f"a record has the unknown kind {opcode}")
    return opcode, head, exact.read(length)


def _parsed(opcode: int, content: bytes, crc: int) -> list[McapRecord]:
    """Return the records in a record, all or none; `crc` is the checksum of what is before it."""
    parser = PARSERS.get(opcode)
    _check(parser is not None, f"a record of kind {opcode} is at a wrong place")
    try:
        stream = ReadDataStream(cast("IO[bytes]", ExactStream(BytesIO(content))))
        record = cast("Parser", parser)(stream, len(content))
        if isinstance(record, Chunk):
            return breakup_chunk(record, validate_crc=True)
    except EndOfFile:
        message = "parts of a record are missing"
        raise DamageError(message) from None
    if isinstance(record, Attachment):
        _check_crc(content[-CRC_BYTES:], zlib.crc32(content[:-CRC_BYTES]))
    if isinstance(record, DataEnd):
        _check_crc(struct.pack("<I", record.data_section_crc), crc)
    if isinstance(record, MessageIndex):
        rest = len(content) - stream.count
        _check(rest == 0, "an index of messages has a wrong length")
    return [record]


def _check_crc(stored: bytes, computed: int) -> None:
    """Check a checksum; 0 stands for none."""
    value = int.from_bytes(stored, "little")
    _check(value in (0, computed), "a checksum differs")


def _check(holds: object, why: str) -> None:
    if not holds:
        raise DamageError(why)


Parser = Callable[[ReadDataStream, int], McapRecord]

PARSERS: dict[int, Parser] = {
    Opcode.HEADER: lambda stream, _: Header.read(stream),
    Opcode.SCHEMA: lambda stream, _: Schema.read(stream),
    Opcode.CHANNEL: lambda stream, _: Channel.read(stream),
    Opcode.MESSAGE: Message.read,
    Opcode.CHUNK: lambda stream, _: Chunk.read(stream),
    Opcode.MESSAGE_INDEX: lambda stream, _: MessageIndex.read(stream),
    Opcode.ATTACHMENT: lambda stream, _: Attachment.read(stream),
    Opcode.METADATA: lambda stream, _: Metadata.read(stream),
    Opcode.DATA_END: lambda stream, _: DataEnd.read(stream),
}
"""Parsers of the records before the index."""

"""Summaries of recordings, read from the start and end of each file, however large it is."""

import os
import struct
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Metadata
from mcap.stream_reader import StreamReader

from agent_economy._core import InputError
from agent_economy.recording.fields import Entries
from agent_economy.recording.foxglove import SECOND_NS
from agent_economy.recording.identity import END, RUN, read_build, read_run
from agent_economy.recording.reading import file_errors
from agent_economy.recording.records import HEAD, MAGIC, MAX_BYTES, ExactStream
from agent_economy.regular_file import open_regular
from agent_economy.whole_file import is_being_written

CHUNK_TIMES = struct.Struct("<2Q")
"""The first and the last time in a chunk, with which it begins."""


@dataclass(frozen=True)
class RecordingSummary:
    """The summary of a recording.

    Attributes:
        scenario: Name of the file that the scenario was read from.
        seed: Seed of all random numbers.
        run: Run number.
        program: The version of the program that recorded it.
        engine: Its engine, as in `Build`; None if it is unknown.
        steps: Number of steps; None if the file is truncated, or damaged at its end, because that
            requires reading it all.
        length_s: Simulated time of the steps; None as for `steps`. Of a file that is being written,
            that of its whole chunks.
        is_being_written: Whether a program is still writing it.
    """

    scenario: str
    seed: int
    run: int
    program: str
    engine: str | None
    steps: int | None
    length_s: float | None
    is_being_written: bool = False


def summarise(path: Path) -> RecordingSummary:
    """Read the summary of a recording.

    Raises:
        InputError: If it cannot be read, is damaged at its beginning, or is not a recording of a
            run.
    """
    with file_errors(path), open_regular(path) as stream:
        run = beginning(stream)
        end = ending_if_whole(stream)
        is_unfinished = end is None and is_being_written(path)
        if end is None and not is_unfinished:
            end = ending_if_whole(stream)  # It may have been completed between the two.
        steps, length_s = end or (None, length_so_far(stream) if is_unfinished else None)
        return RecordingSummary(
            run.text("scenario"),
            run.whole("seed"),
            run.whole("run"),
            *read_build(run),
            steps,
            length_s,
            is_unfinished,
        )


def beginning(stream: IO[bytes]) -> Entries:
    """Return the entries that identify the run, which are the first of a recording.

    Raises:
        InputError: If it is not a recording of a run, or has another format.
    """
    exact = cast("IO[bytes]", ExactStream(stream))  # the reader uses only this method
    records = StreamReader(exact, record_size_limit=MAX_BYTES).records
    next(records)  # the header
    first = next(records)
    if not isinstance(first, Metadata) or first.name != RUN:
        message = f"is not a recording of a run: it does not begin with metadata {RUN!r}"
        raise InputError(message)
    return read_run(first.metadata)


def ending_if_whole(stream: IO[bytes]) -> tuple[int, float] | None:
    """Return as `ending`; None also for a damaged end, which hides nothing before it."""
    with suppress(Exception):
        return ending(stream)
    return None


def length_so_far(stream: IO[bytes]) -> float:
    """Return the simulated time of the whole chunks of a file; of each only the head is read."""
    size, end_ns = stream.seek(0, os.SEEK_END), 0
    stream.seek(len(MAGIC))
    while len(head := stream.read(HEAD.size)) == HEAD.size:
        kind, length = HEAD.unpack(head)
        begin = stream.tell()
        if begin + length > size:
            break
        if kind == Opcode.CHUNK and length >= CHUNK_TIMES.size:
            end_ns = max(end_ns, *CHUNK_TIMES.unpack(stream.read(CHUNK_TIMES.size)))
        stream.seek(begin + length)
    return end_ns / SECOND_NS


def ending(stream: IO[bytes]) -> tuple[int, float] | None:
    """Return the number of steps and the simulated time; None if the file is truncated.

    Raises:
        Exception: If the index is damaged; those of the library are not documented.
    """
    stream.seek(-len(MAGIC), os.SEEK_END)
    if stream.read() != MAGIC:
        return None
    stream.seek(0)
    summary = SeekingReader(stream, record_size_limit=MAX_BYTES).get_summary()
    places = (
        [each.offset for each in summary.metadata_indexes if each.name == END] if summary else []
    )
    if not (summary and summary.statistics and places):
        return None
    stream.seek(places[-1])
    end = next(StreamReader(stream, skip_magic=True, record_size_limit=MAX_BYTES).records)
    if not isinstance(end, Metadata):
        message = f"is damaged: its index refers to another record as metadata {END!r}"
        raise InputError(message)
    tick = Entries(f"metadata {END!r}", end.metadata).whole("tick")
    return tick, summary.statistics.message_end_time / SECOND_NS

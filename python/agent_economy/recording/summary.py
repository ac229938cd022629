"""Summaries of recordings, read from the start and end of each file, however large it is."""

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

from mcap.reader import SeekingReader
from mcap.records import Metadata
from mcap.stream_reader import StreamReader

from agent_economy._core import InputError
from agent_economy.recording.fields import Entries
from agent_economy.recording.foxglove import SECOND_NS
from agent_economy.recording.identity import END, RUN, read_build, read_run
from agent_economy.recording.reading import file_errors
from agent_economy.recording.records import MAGIC, MAX_BYTES, ExactStream
from agent_economy.regular_file import open_regular


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
        length_s: Simulated time of the steps; None as for `steps`.
    """

    scenario: str
    seed: int
    run: int
    program: str
    engine: str | None
    steps: int | None
    length_s: float | None


def summarise(path: Path) -> RecordingSummary:
    """Read the summary of a recording.

    Raises:
        InputError: If it cannot be read, is damaged at its beginning, or is not a recording of a
            run.
    """
    with file_errors(path), open_regular(path) as stream:
        run = beginning(stream)
        end = None
        with suppress(Exception):  # Damage at the end hides nothing before it.
            end = ending(stream)
        return RecordingSummary(
            run.text("scenario"),
            run.whole("seed"),
            run.whole("run"),
            *read_build(run),
            *(end or (None, None)),
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

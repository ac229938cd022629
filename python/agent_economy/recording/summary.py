"""What a recording is of, from its two ends: for lists of many, however large each is."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

from mcap.reader import SeekingReader
from mcap.records import Metadata
from mcap.stream_reader import StreamReader

from agent_economy._core import InputError
from agent_economy.recording.fields import Entries
from agent_economy.recording.foxglove import SECOND_NS
from agent_economy.recording.identity import END, RUN, read_run
from agent_economy.recording.reading import MAX_BYTES, Unbroken, told

MAGIC = b"\x89MCAP0\r\n"
"""What files in MCAP begin and end with."""


@dataclass(frozen=True)
class RecordingSummary:
    """What a recording is of.

    Attributes:
        scenario: The name of the file that the scenario was read from.
        seed: Of all chance.
        run: Its number.
        program: The version that recorded it.
        steps: How long it is; None if the file is cut, so that this takes reading it all.
        length_s: The same in the world.
    """

    scenario: str
    seed: int
    run: int
    program: str
    steps: int | None
    length_s: float | None


def summarise(path: Path) -> RecordingSummary:
    """Read what a recording is of, without what is between its ends.

    Raises:
        InputError: If it cannot be read, is damaged, or is no recording of a run of this format.
    """
    with told(path), path.open("rb") as stream:
        run = beginning(stream)
        end = ending(stream)
        return RecordingSummary(
            run.text("scenario"),
            run.whole("seed"),
            run.whole("run"),
            run.text("program"),
            *(end or (None, None)),
        )


def beginning(stream: IO[bytes]) -> Entries:
    """Return which run it is, which is written before all else.

    Raises:
        InputError: If it is no recording of a run, or of another format.
    """
    unbroken = cast("IO[bytes]", Unbroken(stream))  # the reader needs no more of a stream
    records = StreamReader(unbroken, record_size_limit=MAX_BYTES).records
    next(records)  # the header
    first = next(records)
    if not isinstance(first, Metadata) or first.name != RUN:
        message = f"is no recording of a run: it does not begin with metadata {RUN!r}"
        raise InputError(message)
    return read_run(first.metadata)


def ending(stream: IO[bytes]) -> tuple[int, float] | None:
    """Return how many steps there are, and seconds in the world; None if the file is cut."""
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
        message = f"is damaged: its index says of another record that it is metadata {END!r}"
        raise InputError(message)
    tick = Entries(f"metadata {END!r}", end.metadata).whole("tick")
    return tick, summary.statistics.message_end_time / SECOND_NS

"""The log: every line that a robot receives or sends, with its time."""

import json
import os
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from agent_economy._core import InputError
from agent_economy.live.clock import now_s
from agent_economy.recording.output import make_empty
from agent_economy.regular_file import descriptor_of

MAX_ENTRIES = 100_000
"""Number of entries in memory; older ones are dropped."""

Entry = dict[str, Any]
"""An entry: `t_s`, `robot`, `port`, `event`, and what belongs to the event, such as `line`."""


class Log:
    """Entries in memory, and as JSON lines in a file."""

    def __init__(self, file: Path | None = None) -> None:
        """Create an empty log; `file` is replaced.

        Raises:
            InputError: If the file cannot be written.
        """
        self._entries: deque[Entry] = deque(maxlen=MAX_ENTRIES)
        self._file = opened(file) if file else None

    def add(self, event: str, robot: int | None, port: str | None, **facts: Any) -> None:
        """Add an entry with the current time."""
        entry = {"t_s": now_s(), "robot": robot, "port": port, "event": event, **facts}
        self._entries.append(entry)
        if self._file and not self._file.closed:  # connections are lost after the end
            self._file.write(json.dumps(entry) + "\n")

    def entries(
        self, event: str | None = None, robot: int | None = None, port: str | None = None
    ) -> list[Entry]:
        """Return the entries in memory, by time: all, or those of an event, a robot or a port."""
        return list(self._matching({"event": event, "robot": robot, "port": port}))

    def _matching(self, wanted: Entry) -> Iterator[Entry]:
        keys = {key: value for key, value in wanted.items() if value is not None}
        for entry in self._entries:
            if keys.items() <= entry.items():
                yield entry

    def close(self) -> None:
        """Close the file."""
        if self._file:
            self._file.close()


def opened(file: Path) -> IO[str]:
    """Open a file for writing, so that each line is in it at once.

    Raises:
        InputError: If it cannot be written, is being written, or is the recording of a drive.
    """
    try:
        descriptor = descriptor_of(file, os.O_RDWR | os.O_CREAT)
        stream = os.fdopen(descriptor, "w", buffering=1, encoding="utf-8")
        try:
            make_empty(file, descriptor)
        except BaseException:
            stream.close()
            raise
    except OSError as error:
        message = f"{file}: the log cannot be written: {error.strerror}"
        raise InputError(message) from None
    return stream

"""Splits a stream of bytes into lines."""

MAX_LINE_BYTES = 256
"""Longer lines are malformed; what has been received of them is dropped."""

MAX_LINES = 20
"""Lines that are taken of one port at once: of more, the newest."""


class LineSplitter:
    """Collects bytes and returns complete lines: ended by LF, CR or CR LF, in any pieces.

    Its work is bounded however much arrives at once: of many bytes, only the last ones are split.
    A line that grows beyond `MAX_LINE_BYTES` is dropped up to its end, so that a robot that sends
    no line ends takes no memory.
    """

    def __init__(self, max_lines: int = MAX_LINES) -> None:
        """Start at the beginning of a line; `max_lines` are returned at most."""
        self._max_lines = max_lines
        self._rest = b""
        self._is_dropping = False

    def feed(self, data: bytes) -> list[bytes]:
        """Return the newest non-empty lines that are complete now, without their ends, in order."""
        max_bytes = self._max_lines * (MAX_LINE_BYTES + 1)
        if len(data) > max_bytes:
            self.skip()
            data = data[-max_bytes:]
        parts = (self._rest + data).replace(b"\r", b"\n").split(b"\n")
        self._rest = parts.pop()
        if parts and self._is_dropping:
            parts, self._is_dropping = parts[1:], False
        if len(self._rest) > MAX_LINE_BYTES:
            self.skip()
        lines = [line for line in parts if line and len(line) <= MAX_LINE_BYTES]
        return lines[-self._max_lines :]

    def skip(self) -> None:
        """Drop everything up to the next line end: bytes between are missing."""
        self._rest, self._is_dropping = b"", True

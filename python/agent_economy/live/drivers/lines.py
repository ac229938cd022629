"""Splits a stream of bytes into lines."""

MAX_LINE_BYTES = 4096
"""Longer lines are malformed; what has been received of them is dropped."""


class LineSplitter:
    """Collects bytes and returns complete lines: ended by LF, CR or CR LF, in any pieces.

    A line that grows beyond `MAX_LINE_BYTES` is dropped up to its end, so that a robot that sends
    no line ends takes no memory.
    """

    def __init__(self) -> None:
        """Start at the beginning of a line."""
        self._rest = b""
        self._is_dropping = False

    def feed(self, data: bytes) -> list[bytes]:
        """Return the non-empty lines that are complete now, without their ends, in order."""
        parts = (self._rest + data).replace(b"\r", b"\n").split(b"\n")
        self._rest = parts.pop()
        if parts and self._is_dropping:
            parts, self._is_dropping = parts[1:], False
        if len(self._rest) > MAX_LINE_BYTES:
            self._rest, self._is_dropping = b"", True
        return [line for line in parts if line and len(line) <= MAX_LINE_BYTES]

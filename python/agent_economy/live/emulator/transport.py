"""What happens to a line between its sender and its receiver: lost, late, twice, garbled, cut."""

from collections.abc import Mapping
from typing import Any

import numpy as np

Piece = tuple[float, bytes]
"""A part of a line, and the time in seconds after which it arrives."""

FIRST, LAST = 33, 255
"""The range of random bytes: no line ends."""


def pieces(
    data: bytes, end: bytes, faults: Mapping[str, Any], random: np.random.Generator
) -> list[Piece]:
    """Return the parts in which a line arrives under the faults of its port.

    Args:
        data: The line without its end.
        end: Its end.
        faults: The active faults of the port.
        random: Decides which lines are affected.
    """
    if "stall" in faults or "cut" in faults or happens("drop", faults, random):
        return []
    if happens("garble", faults, random):
        data = garbled(data, random)
    line = data + end
    delay_s = faults.get("delay", 0.0)
    copies = 2 if happens("duplicate", faults, random) else 1
    if "half" not in faults:
        return [(delay_s, line)] * copies
    middle = max(1, len(data) // 2)
    rest_s = faults["half"]
    rest = [] if rest_s is None or not line[middle:] else [(delay_s + rest_s, line[middle:])]
    return [(delay_s, line[:middle]), *rest] * copies


def happens(name: str, faults: Mapping[str, Any], random: np.random.Generator) -> bool:
    """Return whether a fault that affects a share of the lines affects this one."""
    return name in faults and bool(random.random() < faults[name])


def garbled(data: bytes, random: np.random.Generator) -> bytes:
    """Return random bytes of the same length, without line ends."""
    return bytes(random.integers(FIRST, LAST + 1, size=max(2, len(data)), dtype=np.uint8))

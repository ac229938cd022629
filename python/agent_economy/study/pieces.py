"""Compute a rectangle in this process, a piece at a time."""

import math
import time
from collections.abc import Callable

import numpy as np

from agent_economy.study.rectangle import Columns, Compute, Rectangle

FIRST_PIECE_ROWS, MOST_PIECE_ROWS = 64, 20_000
"""Runs that are computed together in this process: first, and at most."""

PIECE_S = 0.5
"""What a piece should take."""


def in_pieces(compute: Compute, on_piece: Callable[[int], None]) -> Compute:
    """Return what computes a rectangle a piece at a time.

    Between two pieces Ctrl-C is heard, and `on_piece` is told the runs that are computed.
    """
    rows = FIRST_PIECE_ROWS

    def pieces(rectangle: Rectangle) -> Columns:
        nonlocal rows
        width, first, parts = len(rectangle.configurations), rectangle.first_run, []
        while first < rectangle.end:
            runs = min(max(1, rows // width), rectangle.end - first)
            begin = time.monotonic()
            parts.append(compute(Rectangle(rectangle.configurations, first, runs)))
            took_s = max(time.monotonic() - begin, 1e-6)
            rows = min(MOST_PIECE_ROWS, math.ceil(runs * width * PIECE_S / took_s))
            first += runs
            if first < rectangle.end:
                on_piece((first - rectangle.first_run) * width)
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in parts[0]}

    return pieces

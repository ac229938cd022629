"""Compute a rectangle in this process, a piece at a time."""

import os
import time
from collections.abc import Callable

import numpy as np

from agent_economy.study.rectangle import Columns, Compute, Rectangle

FEWEST_ROWS, MOST_ROWS = 8 * (os.cpu_count() or 1), 20_000
"""Runs of a piece: the first has the fewest, with which no processor waits long for another."""

PIECE_S = 0.5
"""What a piece should take."""


def in_pieces(compute: Compute, on_piece: Callable[[int], None]) -> Compute:
    """Return what computes a rectangle a piece at a time.

    Between two pieces Ctrl-C is heard, and `on_piece` is told the runs that are computed.
    """
    rows = FEWEST_ROWS

    def pieces(rectangle: Rectangle) -> Columns:
        nonlocal rows
        width, first, parts = len(rectangle.configurations), rectangle.first_run, []
        while first < rectangle.end:
            runs = min(max(1, rows // width), rectangle.end - first)
            begin = time.monotonic()
            parts.append(compute(Rectangle(rectangle.configurations, first, runs)))
            took_s = max(time.monotonic() - begin, 1e-6)
            rows = min(MOST_ROWS, max(FEWEST_ROWS, round(runs * width * PIECE_S / took_s)))
            first += runs
            if first < rectangle.end:
                on_piece((first - rectangle.first_run) * width)
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in parts[0]}

    return pieces

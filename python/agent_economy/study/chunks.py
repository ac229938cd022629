"""Compute a block of runs in this process, in chunks."""

import os
import time
from collections.abc import Callable

import numpy as np

from agent_economy.study.run_block import Columns, Compute, RunBlock

MIN_ROWS, MAX_ROWS = 8 * (os.cpu_count() or 1), 20_000
"""Runs of a chunk: the first has the minimum, so that no processor waits long for another."""

CHUNK_S = 0.5
"""Intended duration of a chunk."""


def in_chunks(compute: Compute, on_chunk: Callable[[int], None]) -> Compute:
    """Return a function that computes a block in chunks.

    Between two chunks Ctrl-C is handled, and `on_chunk` is called with the number of runs computed.
    """
    rows = MIN_ROWS

    def chunked(block: RunBlock) -> Columns:
        nonlocal rows
        width, first, parts = len(block.configurations), block.first_run, []
        while first < block.end:
            runs = min(max(1, rows // width), block.end - first)
            start = time.monotonic()
            parts.append(compute(RunBlock(block.configurations, first, runs)))
            duration_s = max(time.monotonic() - start, 1e-6)
            rows = min(MAX_ROWS, max(MIN_ROWS, round(runs * width * CHUNK_S / duration_s)))
            first += runs
            if first < block.end:
                on_chunk((first - block.first_run) * width)
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in parts[0]}

    return chunked

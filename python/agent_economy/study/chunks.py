"""Compute a block of runs in this process, in chunks that are short enough to be stored one by one.

A chunk has a few runs of many configurations: its duration is then the same again for the next
runs, however different the configurations are. Configurations are divided too if one run of each
takes too long.
"""

import os
import time
from collections.abc import Generator, Iterator, Sequence
from itertools import islice
from math import ceil

from agent_economy.study.run_block import Compute, Part, Partwise, RunBlock, outcomes

MIN_ROWS = os.cpu_count() or 1
"""Minimum number of runs of a chunk, so that no processor is idle."""

CHUNK_S = 0.5
"""Intended duration of a chunk."""


def in_chunks(compute: Compute) -> Partwise:
    """Return a function that computes a block in chunks; between two, Ctrl-C is handled."""
    durations = Durations()

    def parts(block: RunBlock) -> Generator[Part]:
        first = block.first_run
        while first < block.end:
            runs = durations.runs(block.configurations, block.end - first)
            for group in durations.groups(block.configurations, runs):
                part = RunBlock(group, first, runs)
                start = time.monotonic()
                columns = outcomes(compute, part)
                durations.add(part, time.monotonic() - start)
                yield part, columns
            first += runs

    return Partwise(parts)


class Durations:
    """The durations of runs per configuration, measured in chunks, and the chunks that follow."""

    def __init__(self) -> None:
        """Start without measurements."""
        self._run_s: dict[int, float] = {}
        self._last_s = 0.0

    def add(self, part: RunBlock, duration_s: float) -> None:
        """Add a chunk."""
        self._last_s = duration_s / part.rows
        self._run_s.update(dict.fromkeys(part.configurations, self._last_s))

    def runs(self, configurations: Sequence[int], max_runs: int) -> int:
        """Return how many runs of all configurations one pass of chunks computes."""
        min_runs = ceil(MIN_ROWS / len(configurations))
        if any(each not in self._run_s for each in configurations):
            return min(max_runs, min_runs)
        pass_s = sum(self._run_s[each] for each in configurations)
        return min(max_runs, max(min_runs, int(CHUNK_S / max(pass_s, 1e-9))))

    def groups(self, configurations: Sequence[int], runs: int) -> Iterator[tuple[int, ...]]:
        """Yield the configurations of each chunk of a pass; each is measured before the next."""
        first, size = 0, 0
        while first < len(configurations):
            size = self._size(islice(configurations, first, None), runs, size)
            yield tuple(configurations[first : first + size])
            first += size

    def _size(self, configurations: Iterator[int], runs: int, last_size: int) -> int:
        """Return the number of configurations of a chunk.

        Unmeasured ones are assumed to take as long as the last, and at most double a chunk's size.
        """
        min_size, size, total_s = ceil(MIN_ROWS / runs), 0, 0.0
        for size, each in enumerate(configurations, start=1):
            total_s += runs * self._run_s.get(each, self._last_s)
            is_full = total_s > CHUNK_S or (each not in self._run_s and size > 2 * last_size)
            if is_full and size > min_size:
                return size - 1
        return size

"""Where the runs of a selection are: in a folder, or in memory only."""

from contextlib import closing
from typing import Any

from agent_economy.study.run_block import Columns, Compute, Gathered, RunBlock, parts_of


class Unstored:
    """Runs that are not kept, with the interface of `Store`.

    Attributes:
        computed: Number of runs that were computed.
        pending: Number of runs that are known of the block that is requested.
    """

    computed = pending = 0

    def block(self, block: RunBlock, compute: Compute) -> Columns:
        """Return the outcomes of a block of runs, all of them computed."""
        self.pending = 0
        gathered = Gathered(block)
        with closing(parts_of(compute, block)) as parts:
            for part, data in parts:
                gathered.put(part, data)
                self.computed += part.rows
                self.pending += part.rows
        return gathered.columns

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (as Store's)
        """Record nothing."""

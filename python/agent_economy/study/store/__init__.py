"""The store of a study's outcomes: a killed study loses no stored run and repeats none.

A folder contains `study.toml` (the question), `ledger.sqlite` (the block files and the decisions)
and `blocks/*.parquet` (outcomes; never changed once they have their names). A block is written
under a temporary name, synced, renamed, and then entered in the ledger. Files that are not in the
ledger are ignored, so `Store.open` can resume from a kill at any moment: the study is repeated from
its beginning, and stored runs are read instead of computed. Finished runs of an incomplete block
are in `staging.runs`.
"""

from agent_economy.study.run_block import Columns, Compute, RunBlock
from agent_economy.study.store.columns import Column
from agent_economy.study.store.ledger import BlockFile, Decision
from agent_economy.study.store.reading import ReadStore, StoredRuns, read
from agent_economy.study.store.writing import Store

__all__ = [
    "BlockFile",
    "Column",
    "Columns",
    "Compute",
    "Decision",
    "ReadStore",
    "RunBlock",
    "Store",
    "StoredRuns",
    "read",
]

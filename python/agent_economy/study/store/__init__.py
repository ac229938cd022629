"""Where a study keeps what it computed: nothing is lost when it is killed, nothing done twice.

A folder holds `study.toml` (what was asked), `ledger.sqlite` (which blocks there are, and what was
decided) and `blocks/*.parquet` (outcomes; never changed once they have their names). A block is
written under another name, put on the disk, renamed, and then entered in the ledger; what is not
in the ledger does not count, so a kill at any moment leaves a folder from which `Store.open` goes
on. A study goes on by asking again from its beginning: what is stored is read.
"""

from agent_economy.study.rectangle import Columns, Compute, Rectangle
from agent_economy.study.store.columns import Column
from agent_economy.study.store.ledger import Block, Decision
from agent_economy.study.store.reading import ReadStore, Stored, read
from agent_economy.study.store.writing import Store

__all__ = [
    "Block",
    "Column",
    "Columns",
    "Compute",
    "Decision",
    "ReadStore",
    "Rectangle",
    "Store",
    "Stored",
    "read",
]

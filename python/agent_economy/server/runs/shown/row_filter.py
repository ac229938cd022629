"""A filter of the rows of a table: hidden kinds of rows, and words that rows contain."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from agent_economy.types.page import Filter


class RowFilter(NamedTuple):
    """A filter of the rows of a table, as a page has chosen it.

    Attributes:
        name: The name of the table, with which the keys of its choices begin.
        words: The search words, in lower case; rows contain all of them.
        hidden: The ids of the kinds of rows that are hidden.
    """

    name: str
    words: tuple[str, ...]
    hidden: frozenset[str]

    def passes(self, kind: str, cells: Iterable[str]) -> bool:
        """Return whether a row of a kind passes, by the contents of its cells."""
        if kind in self.hidden:
            return False
        if not self.words:
            return True
        whole = " ".join(cells).lower()
        return all(word in whole for word in self.words)

    def offered(
        self, label: str, labels: Mapping[str, str], kinds: Iterable[str], passed: int
    ) -> Filter:
        """Return the filter as it is sent.

        Args:
            label: The label of the search field.
            labels: The label of each kind of rows.
            kinds: The kind of each row, filtered out or not.
            passed: The number of rows that pass.
        """
        counts = Counter(kinds)
        return {
            "label": label,
            "words_key": words_key(self.name),
            "hidden_key": hidden_key(self.name),
            "kinds": [
                {"id": kind, "label": of, "count": counts[kind], "is_on": kind not in self.hidden}
                for kind, of in labels.items()
                if counts[kind]
            ],
            "passed": (passed, counts.total()),
        }


def words_key(name: str) -> str:
    """Return the key of the choice of the search words."""
    return f"{name}-words"


def hidden_key(name: str) -> str:
    """Return the key of the choice of the hidden kinds."""
    return f"{name}-hidden"


def row_filter(name: str, choices: Mapping[str, str]) -> RowFilter:
    """Return the filter of a table that a page has chosen."""
    hidden = frozenset(choices.get(hidden_key(name), "").split(","))
    words = choices.get(words_key(name), "").lower().split()
    return RowFilter(name, tuple(words), hidden)

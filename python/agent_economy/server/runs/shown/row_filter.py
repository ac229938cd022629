"""A filter of the rows of a table: hidden kinds of rows, and words that rows contain."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from agent_economy.types.page import Filter


class RowFilter(NamedTuple):
    """A filter of the rows of a table, as a page has chosen it.

    Attributes:
        name: The name of the table, with which the keys of its choices begin.
        text: The text that was entered; rows contain all its words.
        hidden: The ids of the kinds of rows that are hidden.
    """

    name: str
    text: str
    hidden: frozenset[str]

    def shows(self, kind: str, texts: Iterable[str]) -> bool:
        """Return whether a row of a kind passes, by the texts that it consists of."""
        if kind in self.hidden:
            return False
        words = self.text.lower().split()
        if not words:
            return True
        whole = " ".join(texts).lower()
        return all(word in whole for word in words)

    def offered(
        self, label: str, labels: Mapping[str, str], kinds: Iterable[str], passed: int
    ) -> Filter:
        """Return the filter as it is sent.

        Args:
            label: The label of the field for the text.
            labels: The label of each kind of rows.
            kinds: The kind of each row, filtered out or not.
            passed: The number of rows that pass.
        """
        counts = Counter(kinds)
        return {
            "label": label,
            "text_key": text_key(self.name),
            "hidden_key": hidden_key(self.name),
            "kinds": [
                {"id": kind, "label": of, "count": counts[kind], "is_on": kind not in self.hidden}
                for kind, of in labels.items()
                if counts[kind]
            ],
            "passed": (passed, counts.total()),
        }


def text_key(name: str) -> str:
    """Return the key of the choice of the text."""
    return f"{name}-text"


def hidden_key(name: str) -> str:
    """Return the key of the choice of the hidden kinds."""
    return f"{name}-hidden"


def row_filter(name: str, choices: Mapping[str, str]) -> RowFilter:
    """Return the filter of a table that a page has chosen."""
    hidden = frozenset(choices.get(hidden_key(name), "").split(","))
    return RowFilter(name, choices.get(text_key(name), ""), hidden)

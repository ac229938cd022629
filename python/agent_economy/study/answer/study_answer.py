"""What an answer shows of itself, whatever its question."""

from collections.abc import Sequence
from html import escape
from typing import Any

Verdict = tuple[str, str, str, str]
"""What to send, how it does, what does as well, and what was not looked for."""


class StudyAnswer:
    """The answer of a study."""

    verdict: Verdict
    results: Sequence[Any]

    def __repr__(self) -> str:
        """Return the verdict and the number of runs."""
        return f"{type(self).__name__}({' '.join(self.verdict)!r}, {self.runs:,} runs)"

    def _repr_html_(self) -> str:
        """Return the verdict for notebooks."""
        first, second, third, fourth = map(escape, self.verdict)
        return f"<b>{first}</b><br>{second}<br>{third}<br><small>{fourth}</small>"

    @property
    def runs(self) -> int:
        """Number of runs of all configurations together."""
        return sum(result.runs for result in self.results)

"""Errors and warnings about a fleet file and its scenario, each with its line."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from agent_economy._core import Document, InputError
from agent_economy.scenario import ScenarioWarning

if TYPE_CHECKING:
    from agent_economy._core import ErrorDetails

Path = Sequence[str | int]
"""Keys of tables and indices of lists, from the root."""

MAX_LISTED = 12
"""Maximum number of names in a message."""


class Findings:
    """Collects errors and warnings about documents.

    Attributes:
        errors: All errors, as `InputError.errors` has them.
        warnings: All warnings.
    """

    def __init__(self) -> None:
        """Start without any."""
        self.errors: list[ErrorDetails] = []
        self.warnings: list[ScenarioWarning] = []

    def error(
        self, document: Document, path: Path, allowed: str, names: Iterable[str] = ()
    ) -> None:
        """Add the error that a value is not what is allowed, or missing.

        Args:
            document: The document of the value.
            path: Its path.
            allowed: To follow "must be" or "expected".
            names: The nearest of these is suggested.
        """
        self.errors.append(document.error(list(path), allowed, list(names)))

    def unknown_key(
        self, document: Document, path: Path, allowed: str, names: Iterable[str]
    ) -> None:
        """Add the error that the last key of a path is not what is allowed."""
        self.errors.append(document.unknown_key(list(path), allowed, list(names)))

    def warn(self, document: Document, path: Path, effect: str) -> None:
        """Add a warning about a value, with its effect and what to do."""
        self.warnings.append(ScenarioWarning(**document.warning(list(path), effect)))

    def has_error_at(self, document: Document, path: Path) -> bool:
        """Return whether there is an error at a path or below it, such as one of the schema."""
        at = document.error(list(path), "", [])["path"]
        inner = (f"{at}.", f"{at}[")
        return any(each["path"] == at or each["path"].startswith(inner) for each in self.errors)

    def exception(self) -> InputError:
        """Return all errors in one exception."""
        exception = InputError("\n".join(each["message"] for each in self.errors))
        exception.errors = self.errors
        return exception


def listed(names: Sequence[str]) -> str:
    """Return names for a message: "a, b and 7 more"."""
    if len(names) <= MAX_LISTED:
        return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
    return f"{', '.join(names[:MAX_LISTED])} and {len(names) - MAX_LISTED} more"

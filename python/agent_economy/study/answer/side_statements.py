"""Side statements of an answer: one that cannot be made is left out, and never costs the answer."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class Omission:
    """A side statement that was left out, by its field of the answer, and the reason."""

    statement: str
    reason: str


class NotStatedError(Exception):
    """A side statement cannot be made of the runs of a study; its text is the reason."""


@dataclass
class SideStatements:
    """Makes side statements, and collects those that are left out."""

    omissions: list[Omission] = field(default_factory=list)

    def make(self, statement: str, function: Callable[[], T]) -> T | None:
        """Return what a function returns; None if it fails, or the result is not strict JSON."""
        try:
            made = function()
            json.dumps(made, default=asdict, allow_nan=False)
        except NotStatedError as error:
            self.omissions.append(Omission(statement, str(error)))
        except Exception as error:  # noqa: BLE001  (the answer does not depend on it)
            self.omissions.append(Omission(statement, f"{type(error).__name__}: {error}"))
        else:
            return made
        return None

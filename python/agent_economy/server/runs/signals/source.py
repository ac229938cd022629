"""A source of signals: numbers of one kind that a run has at each step."""

from collections.abc import Sequence
from typing import Any, Protocol

from agent_economy.types.page import SignalOffer

Values = list[float | None]


class Source(Protocol):
    """Numbers of a run; one for each run that is sampled."""

    def step(self, simulation: Any, paths: Sequence[str]) -> None:
        """Note a step, before the values of any step are requested."""

    def values(self, simulation: Any, paths: Sequence[str]) -> Values:
        """Return the numbers at some paths at the current step; None where there is none."""


class Stateless:
    """A source whose values follow from the current step."""

    def step(self, simulation: Any, paths: Sequence[str]) -> None:
        """Do nothing."""


def offered(name: str, label: str, unit: str = "", of: str = "") -> SignalOffer:
    """Return what pages display of a signal that they can request."""
    return {"id": name, "label": label, "unit": unit, "of": of}


def number(value: object) -> float | None:
    """Return a finite number as such, a truth value as 0 or 1; otherwise None."""
    if isinstance(value, bool | int | float) and abs(value) < float("inf"):
        return float(value)
    return None


def owner_of(path: str, names: Sequence[str]) -> tuple[str, str] | None:
    """Return which of some names a path begins with, and the rest; None if with none."""
    # KIND/INDEX has one slash.
    *parts, rest = path.split("/", 2)
    name = "/".join(parts)
    return (name, rest) if len(parts) == 2 and name in names else None  # noqa: PLR2004

"""Conditions on the outcome of a mission in words."""

import re
from collections.abc import Callable

import numpy as np

from agent_economy.scenario import Condition
from agent_economy.scenario.requirement import COMPARISONS

MINUTE_S = 60

COUNTS = {
    "collisions": ("collision", "collisions"),
    "false_alarms": ("false alarm", "false alarms"),
    "expired": ("goal expired", "goals expired"),
    "found": ("target found", "targets found"),
    "goals_refused": ("goal refused", "goals refused"),
    "leases_lapsed": ("lease lapsed", "leases lapsed"),
    "messages_dropped": ("message dropped", "messages dropped"),
    "messages_sent": ("message sent", "messages sent"),
    "missed": ("target missed", "targets missed"),
    "robots": ("robot", "robots"),
    "robots_stopped": ("robot stopped", "robots stopped"),
    "served": ("goal served", "goals served"),
    "served_twice": ("goal served twice", "goals served twice"),
}
"""What columns of whole numbers count: one of them, and several."""

KINDS = {"found": "found", "missed": "missed"}
"""Beginnings of columns that count items of a kind, such as `found_parcel`."""

AMOUNTS: dict[str, Callable[[str], str]] = {
    "distance_m": lambda amount: f"{amount} m driven",
    "energy_j": lambda amount: f"{amount} J of energy",
    "price": lambda amount: f"a price of {amount}",
}
"""Columns of amounts, with the words for a bounded amount."""

BOUNDS = {"<=": "at most", ">=": "at least"}

COUNT_BOUNDS = {**BOUNDS, "<": "fewer than", ">": "more than", "==": "exactly"}


def in_words(condition: Condition) -> str:
    """Return a condition in words: "success within 20 minutes"; as code if there are no words."""
    column, comparison, value = condition.column, condition.comparison, condition.value
    found = None
    if column == "failed":
        holds_at_0, holds_at_1 = (COMPARISONS[comparison](np.array(at), value) for at in (0, 1))
        found = "success" if holds_at_0 and not holds_at_1 else None
    elif subject := timed(condition):
        found = in_time(subject, comparison, value)
    elif column in AMOUNTS:
        bound = BOUNDS.get(comparison)
        found = bound and AMOUNTS[column](f"{bound} {value:,.10g}")
    elif nouns := counted(column):
        found = count(nouns, comparison, value)
    return found or f"`{condition.text}`"


def timed(condition: Condition) -> str | None:
    """Return the event that has the time of a condition; None if it is not about a time."""
    if condition.column == "time_s":
        return "success"
    find = re.fullmatch(r"found_(.+)_(\d+)_s", condition.column)
    if find is None:
        return None
    number, kind = int(find[2]), find[1].replace("_", " ")
    return f"{number} {kind if number == 1 else kind + 's'} found"


def in_time(event: str, comparison: str, seconds: float) -> str | None:
    """Return words for an upper limit of a time; None for another comparison."""
    bound = {"<=": "within", "<": "in less than"}.get(comparison)
    return bound and f"{event} {bound} {duration(seconds)}"


def counted(column: str) -> tuple[str, str] | None:
    """Return what a column counts: one of them, and several; None if it counts nothing."""
    first, _, kind = column.partition("_")
    if column in COUNTS or first not in KINDS:
        return COUNTS.get(column)
    name = kind.replace("_", " ")
    return f"{name} {KINDS[first]}", f"{name}s {KINDS[first]}"


def count(nouns: tuple[str, str], comparison: str, value: float) -> str | None:
    """Return words for a limit of a count; None if it has none."""
    one, several = nouns
    if (comparison, value) in {("<=", 0.0), ("==", 0.0), ("<", 1.0)}:
        return f"no {several}"
    bound = COUNT_BOUNDS.get(comparison)
    if bound is None or not value.is_integer():
        return None
    return f"{bound} {value:,.10g} {one if value == 1 else several}"


def duration(seconds: float) -> str:
    """Return a duration as people write it: "90 s", "20 minutes"."""
    minutes = seconds / MINUTE_S
    is_written = minutes > 1 and minutes.is_integer()
    return f"{minutes:g} minutes" if is_written else f"{seconds:,.10g} s"

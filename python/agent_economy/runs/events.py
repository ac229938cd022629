"""What happens in a run of the metric engine, in words."""

from collections.abc import Callable
from typing import Any, NamedTuple

from agent_economy.runs.simulation import STATUSES

BROKEN, FAILED_ACT = "broken", ", failed"
OWNERSHIP_LOST = "lost: no majority of controllers votes for an owner"


class Event(NamedTuple):
    """Something that happened in a step.

    Attributes:
        tick: The number of steps before its own.
        kind: Its kind, as pages filter it: the first word of those in `WORDS`.
        of: The name of the item, goal, robot, controller or vehicle that it happened to.
        text: What happened.
        agent: The name of the robot or controller that did it; empty if there is none.
    """

    tick: int
    kind: str
    of: str
    text: str
    agent: str


def in_words(tick: int, kind: str, of: str, value: Any) -> Event:
    """Return an event of `_core.EventReader.drain`, in words."""
    return Event(tick, *WORDS[kind](of, value))


Words = tuple[str, str, str, str]
"""The fields of an event after its tick."""


def detected(of: str, value: tuple[float, str]) -> Words:
    """Return the words for an item that was found."""
    return "found", of, f"found by {value[1]}", value[1]


def acted(of: str, value: Any) -> Words:
    """Return the words for an act on an item or a place."""
    act, item, at, is_success = value
    result = "" if is_success else FAILED_ACT
    return "acted", of, f"{act} {item or 'nothing'} at ({at[0]:.1f}, {at[1]:.1f}){result}", of


def status(of: str, value: int) -> Words:
    """Return the words for the new status of a robot."""
    name = str(STATUSES[value])
    if name == BROKEN:
        return "failed", of, name, of
    return "stopped", of, "battery empty" if name == "empty" else name, of


def awarded(of: str, value: tuple[str, str]) -> Words:
    """Return the words for an award."""
    controller, robot = value
    return "awarded", of, f"awarded to {robot} by {controller}", robot


def marked(of: str, value: tuple[int, str | None]) -> Words:
    """Return the words for a mark."""
    number, verdict = value
    return "marked", of, f"mark {number}: {verdict or 'unverified'}", of


def stated(of: str, value: tuple[bool, float | None]) -> Words:
    """Return the words for the statement of a controller about its lane."""
    is_clear, risk = value
    with_risk = "" if risk is None else f", risk {risk:.3g}"
    return "declared", of, f"{'declared clear' if is_clear else 'given up'}{with_risk}", of


def sent(of: str, value: Any) -> Words:
    """Return the words for a message."""
    about, goal, receiver = value
    of_goal = "" if goal is None else f" of {goal}"
    return "sent", of, f"{about}{of_goal} to {receiver or 'all'}", of


def unserved(reason: str) -> str:
    """Return that a goal is not served, and why."""
    return OWNERSHIP_LOST if reason == "ownership_lost" else f"no robot can serve it: {reason}"


WORDS: dict[str, Callable[[str, Any], Words]] = {
    "detected": detected,
    "served": lambda of, robot: ("served", of, f"served by {robot}", robot),
    "acted": acted,
    "destroyed": lambda of, item: ("failed", of, f"destroyed by {item}", of),
    "passed": lambda of, _: ("passed", of, "passed the lane", ""),
    "collided": lambda of, total: ("collided", of, f"collision, {total} in total", of),
    "status": status,
    "issued": lambda of, _: ("issued", of, "issued", ""),
    "expired": lambda of, _: ("failed", of, "expired", ""),
    "unserved": lambda of, reason: ("failed", of, unserved(reason), ""),
    "awarded": awarded,
    "lost": lambda of, by: ("failed", of, OWNERSHIP_LOST, by),
    "failed": lambda of, _: ("failed", of, "has failed", of),
    "marked": marked,
    "stated": stated,
    "sent": sent,
}
"""Words by the kinds of the compiled part."""

"""Events of a drive in words."""

import math
from collections.abc import Mapping
from typing import Any


def sentence(event: Mapping[str, Any]) -> str:
    """Return an event in words; empty for events without news for a person."""
    match event["type"]:
        case "plan":
            names = ", ".join(robot["name"] for robot in event["plan"]["robots"])
            return f"Driving {names}; recording to {event['record']}"
        case "event":
            return robot_sentence(event)
        case "goal":
            return goal_sentence(event)
        case "radio":
            return radio_sentence(event)
        case "end":
            return f"Ended: {event['reason']}.{confirmation(event)}{lateness(event)}"
        case _:
            return str(event.get("message", ""))


def goal_sentence(event: Mapping[str, Any]) -> str:
    """Return the verdict on a waypoint, which has a number, or on a goal, which has a name."""
    what = "waypoint" if event["goal"].isdecimal() else "goal"
    reason = f": {reason_of(event['unserved'])}" if event.get("unserved") else ""
    return f"{event['robot']}: {what} {event['goal']}: {event['verdict']}{reason}{server(event)}"


def reason_of(unserved: str) -> str:
    """Return why a waypoint or goal is not served, in words."""
    if unserved == "position":
        return "the position is not known well enough"
    return unserved.replace("_", " ")


def radio_sentence(event: Mapping[str, Any]) -> str:
    """Return whether a robot sends to its team, in words."""
    if event["is_silent"]:
        return f"{event['robot']}: silent for 10 s: others take over its waypoint"
    return f"{event['robot']}: sends to its team again"


def server(event: Mapping[str, Any]) -> str:
    """Return which robot serves a shared waypoint, if another one does."""
    by = event.get("served_by")
    return f" by {by}" if by not in (None, event["robot"]) else ""


def confirmation(event: Mapping[str, Any]) -> str:
    """Return which robots are known to be stationary."""
    if not event["unconfirmed"]:
        return f" All robots stand: {_slower_than(event)}."
    return f" Not confirmed as stationary: {', '.join(event['unconfirmed'])}."


def _slower_than(event: Mapping[str, Any]) -> str:
    """Return the fastest motion that would go unseen, rounded up: an upper limit remains one."""
    return f"slower than {math.ceil(100.0 * event['unseen_speed_m_s'] - 1e-9) / 100.0:.2f} m/s"


def lateness(event: Mapping[str, Any]) -> str:
    """Return how late the brains were in a drive; empty if they never were.

    They are late too if each step takes a little longer than it may: the run then falls behind.
    """
    if not event["was_late"]:
        return ""
    return (
        f" Late steps of the brains: {event['late_steps']}; the run was behind the clock by "
        f"{event['max_behind_s']:.2f} s at most, and by {event['behind_s']:.2f} s at the end."
    )


def robot_sentence(event: Mapping[str, Any]) -> str:
    """Return the state of a robot in words, with the reasons."""
    name = event["robot"]
    if event["action"] == "move":
        return f"{name}: moves" + reasons(event, "warnings", "with a warning")
    if event["is_armed"]:
        return f"{name}: stopped" + reasons(event, "faults", "because of")
    state = "stopped"
    if event["is_confirmed"]:
        state = f"stopped (standstill confirmed: {_slower_than(event)})"
    why = reasons(event, "faults", "because of") or reasons(event, "latched", "since")
    return f"{name}: {state}, not armed{why}"


def reasons(event: Mapping[str, Any], kind: str, word: str) -> str:
    """Return faults of an event, the gravest first, each with its reason."""
    texts = [named(each.replace("_", " "), event["reasons"][each]) for each in event[kind]]
    return f" {word} {', '.join(texts)}" if texts else ""


def named(name: str, reason: str) -> str:
    """Return a fault with its reason, which may begin with its name; the name is not repeated."""
    rest = reason.removeprefix(name)
    if rest == reason or (rest and rest[0] not in ": "):
        return f"{name} ({reason})"
    detail = rest.lstrip(": ")
    return f"{name} ({detail})" if detail else name

"""The faults that can be switched on for a port of a robot while the emulator runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from agent_economy._core import InputError
from agent_economy.live.emulator.settings import Rule, number
from agent_economy.scenario import validation

PORTS = ("motors", "compass", "gps", "sonar")
"""The ports of a robot, in the order of their numbers."""

SENDING = ("compass", "gps", "sonar")
"""The ports on which a robot sends lines."""

SHARE = number(0, 1)
SECONDS = number(0, 3600, "seconds")
NONE = Rule("omitted: this fault takes no value", lambda value: value is None)


def whole(low: int, high: int) -> Rule:
    """Return the rule of a whole number in a range, ends included."""
    allowed = f"a whole number from {low} to {high}"
    return Rule(allowed, lambda value: validation.is_whole(value, low, high))


@dataclass(frozen=True)
class Fault:
    """A fault.

    Attributes:
        defaults: The ports that can have it, each with the value that it has without one.
        rule: What is allowed as its value.
        meaning: What it does.
    """

    defaults: Mapping[str, Any]
    rule: Rule
    meaning: str


def on_each(ports: tuple[str, ...], default: Any) -> dict[str, Any]:
    """Return the same default for some ports."""
    return dict.fromkeys(ports, default)


FAULTS: Mapping[str, Fault] = {
    "drop": Fault(on_each(PORTS, 0.5), SHARE, "This share of the lines is lost."),
    "delay": Fault(on_each(PORTS, 1.0), SECONDS, "Each line is late by this time."),
    "duplicate": Fault(on_each(PORTS, 1.0), SHARE, "This share of the lines comes twice."),
    "garble": Fault(on_each(PORTS, 1.0), SHARE, "This share of the lines is random bytes."),
    "half": Fault(
        on_each(PORTS, None),
        Rule(
            "a number from 0 to 3600 (seconds), or null for never",
            lambda value: value is None or SECONDS.check(value),
        ),
        "Half of each line comes at once, the rest after this time.",
    ),
    "stall": Fault(on_each(PORTS, None), NONE, "Connections stay open; nothing is sent or read."),
    "cut": Fault(
        on_each(PORTS, None),
        NONE,
        "The link is half open: connections stay open, and no packet gets through (Linux only).",
    ),
    "close": Fault(on_each(PORTS, None), NONE, "All connections are closed once."),
    "refuse": Fault(on_each(PORTS, None), NONE, "New connections are refused."),
    "freeze": Fault(on_each(SENDING, None), NONE, "The same line is repeated."),
    "jump": Fault(
        {"compass": 90.0, "gps": 50.0, "sonar": 2.0},
        number(-1e6, 1e6, "degrees; metres"),
        "The value is off by this: degrees, metres to the north, metres of range.",
    ),
    "nan": Fault(on_each(SENDING, None), NONE, "Every number is NaN."),
    "short": Fault({"gps": 3, "sonar": 3}, whole(1, 6), "Only this number of values is sent."),
    "seven": Fault({"sonar": None}, NONE, "A seventh range is sent."),
    "one_digit": Fault({"compass": 5}, whole(0, 9), "Each heading is this one digit."),
    "runaway": Fault(
        {"motors": 0.3},
        number(-10, 10, "m/s"),
        "The robot drives at this speed when it should be at rest.",
    ),
    "ignore_stop": Fault({"motors": None}, NONE, "Stop lines have no effect."),
    "obey_nothing": Fault({"motors": None, "compass": None}, NONE, "No line has an effect."),
}
"""All faults, by name."""


class ActiveFaults(dict[str, Any]):
    """The active faults of one port: their values, by name."""

    def switch(self, port: str, name: str, value: Any, *, on: bool) -> None:
        """Switch a fault on, with a value or the default of the port, or off.

        Raises:
            InputError: If the port cannot have it, or the value is not allowed.
        """
        fault = fault_of(port, name)
        if not on:
            self.pop(name, None)
            return
        value = fault.defaults[port] if value is None else value
        validation.check(fault.rule.check(value), f"{name}: value", value, fault.rule.allowed)
        self[name] = value


def fault_of(port: str, name: Any) -> Fault:
    """Return a fault that a port can have.

    Raises:
        InputError: If it cannot have it.
    """
    possible = [each for each in FAULTS if port in FAULTS[each].defaults]
    if name not in possible:
        near = get_close_matches(str(name), possible, 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        message = f"fault {name!r}: port {port} can have one of {', '.join(possible)}{hint}"
        raise InputError(message)
    return FAULTS[name]

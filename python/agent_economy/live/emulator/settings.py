"""The settings of the emulator, which can change while it runs: names, defaults, allowed values."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from difflib import get_close_matches
from typing import Any

from agent_economy._core import InputError
from agent_economy.scenario import validation

MAX_RATE_HZ = 20.0
"""Maximum rate of lines: one per step of the simulation."""


@dataclass(frozen=True)
class Rule:
    """What is allowed for a value: in words that complete "must be ...", and as a check."""

    allowed: str
    check: Callable[[Any], bool]


def number(low: float, high: float, unit: str = "", word: str | None = None) -> Rule:
    """Return the rule of a number in a range, ends included, or of one word in its place."""

    def check(value: Any) -> bool:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return (is_number and low <= value <= high) or (word is not None and value == word)

    or_word = f', or "{word}"' if word else ""
    return Rule(f"a number from {low:.12g} to {high:.12g}{unit and f' ({unit})'}{or_word}", check)


def one_of(*words: str) -> Rule:
    """Return the rule of one of some words."""
    listed = ", ".join(f'"{word}"' for word in words)
    return Rule(f"one of {listed}", lambda value: isinstance(value, str) and value in words)


RATE = number(0, MAX_RATE_HZ, "hertz; 0 for no lines")


NO_ECHO = Rule(
    'a number from -1000000 to 1000000, "inf", or "range"',
    lambda value: value in ("inf", math.inf) or number(-1e6, 1e6, "", "range").check(value),
)


def setting(default: object, rule: Rule, meaning: str) -> Any:
    """Return a field of the settings with its rule and its meaning."""
    return field(default=default, metadata={"rule": rule, "meaning": meaning})


@dataclass(frozen=True)
class Settings:
    """All settings. The thesis leaves most of these values open; the defaults are guesses."""

    compass_hz: float = setting(10.0, RATE, "Compass lines per second.")
    gps_hz: float = setting(1.0, RATE, "GPS lines per second.")
    sonar_hz: float = setting(5.0, RATE, "Sonar lines per second.")
    line_end: str = setting("lf", one_of("lf", "crlf", "cr"), "End of each line that is sent.")
    compass_offset_deg: float = setting(
        10.0, number(-180, 180, "degrees"), "Mounting offset: added to each heading that is sent."
    )
    compass_noise_deg: float | str = setting(
        "scenario",
        number(0, 180, "degrees", "scenario"),
        "Standard deviation of the compass; by default that of the scenario.",
    )
    heading_frame: str = setting(
        "raw",
        one_of("raw", "corrected"),
        "Frame of desired headings: that of the raw compass, or the one without its offset.",
    )
    turn_rate_deg_s: float = setting(
        30.0, number(1, 360, "degrees per second"), "Maximum turn rate of the coprocessor."
    )
    turn_tolerance_deg: float = setting(
        2.0, number(0.1, 45, "degrees"), "The coprocessor stops within this angle."
    )
    gps_noise_m: float | str = setting(
        "scenario",
        number(0, 1000, "metres", "scenario"),
        "Standard deviation of a fix along each axis; by default that of the scenario.",
    )
    gps_drift_m: float = setting(
        0.2,
        number(0, 1000, "metres"),
        "Standard deviation of the slow error of a fix along each axis.",
    )
    gps_drift_s: float = setting(
        60.0,
        number(0.1, 1e6, "seconds"),
        "Time after which the slow error of a fix is independent of what it was.",
    )
    gps_digits: int = setting(
        4,
        Rule("a whole number from 0 to 8", lambda value: validation.is_whole(value, 0, 8)),
        "Decimal places of the minutes: the quantisation of a fix.",
    )
    gps_longitude_letter: str = setting(
        "sent", one_of("sent", "omitted"), "The hemisphere of the longitude at the end of a fix."
    )
    range_unit_m: float = setting(
        0.3048, number(0.001, 10, "metres"), "Unit of the ranges: 0.3048 for feet, 1 for metres."
    )
    no_echo: float | str = setting(
        99.0,
        NO_ECHO,
        "Value of a sonar without an echo, in its unit, or range for its maximum range.",
    )
    forward_m_s_per_unit: float = setting(
        0.02, number(1e-4, 1, "m/s"), "Speed of a track per unit above 150."
    )
    reverse_m_s_per_unit: float = setting(
        0.02, number(1e-4, 1, "m/s"), "Speed of a track per unit below 150."
    )
    lag_s: float = setting(
        0.25,
        number(0, 10, "seconds"),
        "Time constant with which speed and turn rate follow the motor lines.",
    )
    delay_s: float = setting(
        0.05, number(0, 10, "seconds"), "Time until a motor line begins to have its effect."
    )
    gain: float = setting(1.0, number(0, 2), "Factor on speed and turn rate.")
    gain_left_right: float = setting(
        1.03,
        number(0.1, 10),
        "Ratio of the gain of the left track to that of the right one; their mean is gain.",
    )
    track_width_m: float = setting(0.5, number(0.05, 5, "metres"), "Distance between the tracks.")
    turn_slip: float = setting(0.0, number(0, 1), "Share of the turn rate lost by slipping.")
    deadman_s: float = setting(
        0.0,
        number(0, 3600, "seconds"),
        "The tracks stop after this time without a motor line; 0 for never, as in 2002.",
    )
    motor_connections: str = setting(
        "many", one_of("many", "one"), "Whether the motor port takes several connections at a time."
    )

    def changed(self, values: Mapping[str, Any], where: str = "") -> "Settings":
        """Return a copy with other values; `where` begins each error, such as "--set ".

        Raises:
            InputError: If a name is unknown or a value is not allowed. It lists all errors.
        """
        errors = [error for name in values for error in _errors(name, values[name], where)]
        if errors:
            raise InputError("\n".join(errors))
        return replace(self, **values)


def rules() -> dict[str, Rule]:
    """Return the rule of each setting, by name."""
    return {each.name: each.metadata["rule"] for each in fields(Settings)}


REPLACED = {
    "left_gain": "gain and gain_left_right",
    "right_gain": "gain and gain_left_right",
    "slip": "gain",
}
"""Settings of earlier versions, and what replaces them."""


def _errors(name: str, value: Any, where: str) -> list[str]:
    known = rules()
    if name not in known:
        near = get_close_matches(name, known, 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        hint = f"; {REPLACED[name]} replaced it" if name in REPLACED else hint
        return [f"{where}{name} is not a setting: expected one of {', '.join(known)}{hint}"]
    rule = known[name]
    return validation.errors_unless(rule.check(value), f"{where}{name}", value, rule.allowed)

"""Times: a setpoint expires before the inputs that it is based on are stale."""

from collections.abc import Iterable, Mapping
from typing import Any

from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
from agent_economy.live.fleet_file.schema import MAX_LATENESS_S, SETPOINT_LIFETIME_S

LIFETIME = ("setpoint_lifetime_s",)
LATENESS = ("max_lateness_s",)


def lifetime_s(given: Mapping[str, Any]) -> float:
    """Return the time for which a setpoint is valid."""
    return float(given.get("setpoint_lifetime_s", SETPOINT_LIFETIME_S))


def lateness_s(given: Mapping[str, Any]) -> float:
    """Return the lateness of the loop at which all robots stop."""
    return float(given.get("max_lateness_s", MAX_LATENESS_S))


def check_lifetime(
    findings: Findings,
    fleet: Document,
    entries: Iterable[Entry],
    kinds: Mapping[str, ScenarioKind],
) -> None:
    """Report a lifetime of setpoints that is too long for an input or too short for a brain.

    Nothing is reported if a time of the whole fleet is not valid by itself.
    """
    if findings.has_error_at(fleet, LIFETIME) or findings.has_error_at(fleet, LATENESS):
        return
    given = fleet.values()
    lifetime = lifetime_s(given)
    default = "" if LIFETIME[0] in given else f"; without it, it is {lifetime}"
    longest, reason = _longest(given, entries)
    if lifetime > longest:
        allowed = f"a number of at most {longest} (seconds), {reason}{default}"
        findings.error(fleet, LIFETIME, allowed)
    for name, kind in kinds.items():
        period_s = kind.brain_period_s
        if lifetime < period_s:
            allowed = (
                f"a number of at least {period_s:g} (seconds), the time between two steps of the "
                f"brain of {name}{default}"
            )
            findings.error(fleet, LIFETIME, allowed)


def _longest(given: Mapping[str, Any], entries: Iterable[Entry]) -> tuple[float, str]:
    """Return the maximum of the lifetime, and its reason."""
    limits = [(lateness_s(given), "max_lateness_s")]
    for entry in entries:
        ages = entry.max_age_s.items()
        limits += [(age, f'max_age_s.{port} of "{entry.name}"') for port, age in ages]
    return min(limits)

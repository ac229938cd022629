"""Warnings about fleets: what is allowed, and dangerous or probably not meant."""

import json
from collections.abc import Iterable

from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, listed
from agent_economy.live.fleet_file.leg_warnings import warn_of_exits, warn_of_walls
from agent_economy.live.fleet_file.scenario_kind import (
    DEFAULT_WITHIN_M,
    ScenarioKind,
    ScenarioWorld,
)
from agent_economy.live.fleet_file.sensors import position_noise_m
from agent_economy.live.fleet_file.sources import virtual_by_default
from agent_economy.live.fleet_file.team import simulated
from agent_economy.scenario import ScenarioWarning

MIN_DEVIATIONS = 2
"""A waypoint has to be reached within this number of standard deviations of positions, or more."""


def fleet_warnings(
    fleet: Document, world: ScenarioWorld, entries: Iterable[Entry]
) -> tuple[ScenarioWarning, ...]:
    """Return the warnings about a fleet without errors; not those of its scenario."""
    findings = Findings()
    entries = list(entries)
    lacking = simulated((entry.name for entry in entries), world.scenario.robots)
    if lacking:
        effect = f"the scenario's team also has {listed(lacking)}, which the loop simulates"
        findings.warn(fleet, ("robots",), effect)
        for entry in entries:
            _warn_of_silence(findings, fleet, entry)
    for entry in entries:
        _warn_of_robot(findings, fleet, entry)
        _warn_of_virtual(findings, fleet, entry, world.kind(entry.kind))
        _warn_of_place(findings, fleet, entry, world)
        warn_of_exits(findings, fleet, entry, world.kind(entry.kind))
    for name in sorted({entry.kind for entry in entries}):
        kind = world.kind(name)
        _warn_of_waypoints(findings, kind)
        warn_of_walls(findings, fleet, [each for each in entries if each.kind == name], kind)
    return tuple(findings.warnings)


def _warn_of_robot(findings: Findings, fleet: Document, entry: Entry) -> None:
    given = entry.given.get("settings", {})
    settings = entry.driver.settings.items()
    guesses = [
        key if setting.default is None else f"{key} = {setting.default}"
        for key, setting in settings
        if setting.is_guess and key not in given
    ]
    if guesses:
        effect = f"guesses are used for what is not set: {listed(guesses)}; measure and set them"
        findings.warn(fleet, (*entry.path, "settings"), effect)
    if entry.deadman_s is None:
        effect = (
            "the robot drives on if this computer or the link fails, because it has no timer that "
            "stops it; keep a person at its own switch"
        )
        findings.warn(fleet, (*entry.path, "deadman_s"), effect)


def _warn_of_silence(findings: Findings, fleet: Document, entry: Entry) -> None:
    """Warn of a robot that simulated ones keep clear of everywhere once it is silent."""
    if entry.fence_m is None:
        effect = (
            "without a fence, simulated robots regard ever more of the world as taken while the "
            "robot sends no positions"
        )
        findings.warn(fleet, (*entry.path, "fence_m"), effect)


def _warn_of_virtual(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Warn of sensors that detect nothing real, unless the file states it."""
    names = virtual_by_default(entry, kind)
    if names:
        are = "are" if names[1:] else "is"
        effect = (
            f"{listed(names)} {are} virtual, because {entry.driver.name} has no input for "
            f"{'them' if names[1:] else 'it'}: only what the scenario has is detected, around "
            'where the robot is believed to be; set "virtual" to confirm it'
        )
        findings.warn(fleet, (*entry.path, "sensors"), effect)


def _warn_of_place(findings: Findings, fleet: Document, entry: Entry, world: ScenarioWorld) -> None:
    """Warn of settings that contradict the origin of the scenario."""
    origin = world.origin or {}
    latitude_deg, longitude_deg = origin["latitude_deg"], origin["longitude_deg"]
    found = entry.driver.contradictions(entry.settings, latitude_deg, longitude_deg)
    for key, effect in found:
        is_given = key in entry.given.get("settings", {})
        default = "" if is_given else f"without it, it is {json.dumps(entry.settings[key])}; "
        findings.warn(fleet, (*entry.path, "settings", key), default + effect)


def _warn_of_waypoints(findings: Findings, kind: ScenarioKind) -> None:
    min_m = MIN_DEVIATIONS * position_noise_m(kind)
    for path, behaviour in kind.behaviours():
        is_short = behaviour.get("within_m", DEFAULT_WITHIN_M) < min_m
        if behaviour["kind"] == "correct" and is_short:
            effect = (
                f"less than twice the standard deviation of positions, {min_m:g} m: the robot "
                "may circle around its waypoints"
            )
            findings.warn(kind.of.document, (*path, "within_m"), effect)

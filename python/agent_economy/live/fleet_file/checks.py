"""All checks of robots whose values are valid, each by itself."""

from agent_economy._core import Document
from agent_economy.live.fleet_file.area import check_area, check_room
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings
from agent_economy.live.fleet_file.network import check_network
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind, ScenarioWorld
from agent_economy.live.fleet_file.sensors import check_sensors
from agent_economy.live.fleet_file.sources import check_sources
from agent_economy.live.fleet_file.timing import check_lifetime


def check_entries(
    findings: Findings, fleet: Document, world: ScenarioWorld, entries: list[Entry]
) -> None:
    """Report everything that is wrong with several values together."""
    kinds = {each.kind: world.kind(each.kind) for each in entries}
    for kind in kinds.values():
        _check_drive(findings, kind)
        check_room(findings, kind)
    check_network(findings, fleet, entries)
    check_lifetime(findings, fleet, entries, kinds)
    for entry in entries:
        check_sources(findings, fleet, entry, kinds[entry.kind])
    # Robots of a kind may differ in drivers and sources: each combination is reported once, for
    # its first robot.
    for entry in {_combination(each): each for each in reversed(entries)}.values():
        check_sensors(findings, fleet, entry, kinds[entry.kind])
    for entry in entries:
        _check_speed(findings, fleet, entry, kinds[entry.kind])
        check_area(findings, fleet, entry, kinds[entry.kind])


def _combination(entry: Entry) -> tuple[str, str, tuple[tuple[str, str], ...]]:
    return entry.kind, entry.driver.name, tuple(sorted(entry.sensors.items()))


def _check_drive(findings: Findings, kind: ScenarioKind) -> None:
    if "max_turn_rate_deg_s" not in kind.drive:
        allowed = "a number above 0 (degrees per second): no real robot turns instantly"
        findings.error(kind.of.document, kind.path("drive", "max_turn_rate_deg_s"), allowed)


def _check_speed(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    if entry.manual_speed_m_s(kind.max_speed_m_s) > kind.max_speed_m_s:
        path = (*entry.path, "manual_speed_m_s")
        allowed = (
            f"a number from 0 to {kind.max_speed_m_s:g} (m/s), the maximum speed of {kind.name}"
        )
        findings.error(fleet, path, allowed)

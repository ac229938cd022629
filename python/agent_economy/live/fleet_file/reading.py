"""Finds the scenario of a fleet, and reads the robots of the file."""

from contextlib import suppress
from pathlib import Path

from agent_economy import _core
from agent_economy._core import Document, InputError
from agent_economy.live.fleet_file.entry import Entry, entry_of
from agent_economy.live.fleet_file.findings import Findings
from agent_economy.live.fleet_file.scenario_kind import ScenarioWorld
from agent_economy.live.fleet_file.sources import BareKind, check_sources
from agent_economy.live.fleet_file.team import check_names, robot_of
from agent_economy.scenario import Override, Scenario, Source, bundled
from agent_economy.scenario.source import MAX_BYTES, decode, read_file

SCENARIO = ("scenario",)


def find_scenario(
    findings: Findings, fleet: Document, folder: Path, overrides: tuple[Override, ...]
) -> Scenario | None:
    """Return the scenario of a fleet; None after an error.

    Args:
        findings: Receives the errors, also those of the scenario.
        fleet: The fleet file.
        folder: Its folder.
        overrides: Values that replace those of the scenario.
    """
    name = fleet.values().get("scenario")
    if not isinstance(name, str) or not name:
        return None
    known = bundled.scenarios()
    file = folder / name if _is_file(folder / name) else known.get(name)
    if file is None:
        allowed = "the name of a bundled scenario, or the path of a scenario relative to this file"
        findings.error(fleet, SCENARIO, allowed, known)
        return None
    try:
        return Scenario.load(file, overrides)
    except InputError as error:
        findings.errors += error.errors
        if error.errors:
            check_sources_of_invalid(findings, fleet, Source(str(file), text_of(file), overrides))
        else:
            findings.error(fleet, SCENARIO, f"a scenario that can be read: {error}")
    return None


def check_sources_of_invalid(findings: Findings, fleet: Document, source: Source) -> None:
    """Report what is wrong with the sensors of robots although their scenario has errors, too."""
    robots = fleet.values().get("robots")
    # What is wrong there has been reported; anything may be missing.
    with suppress(InputError, AttributeError, KeyError, TypeError):
        kinds = _core.read_filled(source.complete())["robots"]
        counts = {name: int(each["count"]) for name, each in kinds.items()}
        for name, given in sorted((robots or {}).items()):
            robot = robot_of(name, counts)
            if robot is not None and not findings.has_error_at(fleet, ("robots", name)):
                entry = entry_of(*robot, given)
                check_sources(findings, fleet, entry, BareKind(robot[0], kinds[robot[0]]))


def text_of(file: Path) -> str:
    """Return the text of a scenario that has been read before."""
    data = read_file(file, MAX_BYTES)
    return "" if isinstance(data, str) else decode(file, data)


def metric_world(findings: Findings, fleet: Document, scenario: Scenario) -> ScenarioWorld | None:
    """Return the world of a scenario, after checks that it can be a real place.

    Returns:
        None if the scenario has no such world, after an error.
    """
    if scenario.engine != "metric":
        findings.error(
            fleet, SCENARIO, f"a scenario of the metric engine, not of {scenario.engine}"
        )
        return None
    world = ScenarioWorld(scenario)
    if world.world.get("periodic", False):
        allowed = "false, because real robots leave the world at its border"
        findings.error(world.document, ("world", "periodic"), allowed)
    if world.origin is None:
        allowed = (
            "the geographic origin of the world, with latitude_deg and longitude_deg of the "
            "point [0, 0]"
        )
        findings.error(world.document, ("world", "origin"), allowed)
    return world


def read_entries(findings: Findings, fleet: Document, world: ScenarioWorld) -> list[Entry]:
    """Return the robots of a fleet that the scenario has and whose values are valid, by name.

    Robots that the scenario or the fleet lacks are reported.
    """
    robots = fleet.values().get("robots")
    if not isinstance(robots, dict):
        return []
    counts = world.scenario.robots
    check_names(findings, fleet, robots, counts)
    entries = []
    for name, given in sorted(robots.items()):
        robot = robot_of(name, counts)
        if robot is not None and not findings.has_error_at(fleet, ("robots", name)):
            entries.append(entry_of(*robot, given))
    return entries


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    # A name that is too long for the file system.
    except OSError:
        return False

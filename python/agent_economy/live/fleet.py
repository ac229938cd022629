"""Fleets: the real robots that a scenario's brains drive, read from TOML and checked as a whole."""

import json
from dataclasses import dataclass, field
from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path

from agent_economy._core import Document, InputError
from agent_economy.live.fleet_file.checks import check_entries
from agent_economy.live.fleet_file.findings import Findings
from agent_economy.live.fleet_file.planning import fleet_plan
from agent_economy.live.fleet_file.reading import find_scenario, metric_world, read_entries
from agent_economy.live.fleet_file.schema import fleet_schema
from agent_economy.live.fleet_file.warnings import fleet_warnings
from agent_economy.live.plan import FleetPlan, Point
from agent_economy.scenario import Override, Scenario, ScenarioWarning, validation
from agent_economy.scenario.source import MAX_BYTES, decode, read_file


@dataclass(frozen=True)
class Fleet:
    """Real robots, and the scenario whose brains drive them.

    Attributes:
        file: The name of the fleet file.
        text: Its text.
        scenario: Its scenario.
        plan: Its robots with their addresses, limits and inputs.
        waypoints_m: The waypoints of robots at the start, by name, as far as the file has some.
        warnings: What is allowed, and dangerous or probably not meant; not those of the scenario.
    """

    file: str
    text: str = field(repr=False)
    scenario: Scenario
    plan: FleetPlan
    waypoints_m: dict[str, tuple[Point, ...]]
    warnings: tuple[ScenarioWarning, ...]


def fleets() -> dict[str, Path]:
    """Return the file of each bundled fleet, by name, in alphabetical order."""
    folder = Path(str(files("agent_economy") / "fleets"))
    return {file.stem: file for file in sorted(folder.glob("*.toml"))}


def load(file: str | Path, overrides: tuple[Override, ...] = ()) -> Fleet:
    """Read a fleet from a file, or a bundled one by its name, such as "bender".

    Args:
        file: The file.
        overrides: Values that replace those of its scenario.

    Raises:
        InputError: If the file cannot be read, or it or its scenario has errors; the message lists
            all of them.
    """
    path = validation.path("file", file)
    if not path.is_file():
        path = fleets().get(str(file), path)
    data = read_file(path, MAX_BYTES)
    if isinstance(data, str):
        near = get_close_matches(path.name, fleets(), 1)
        advice = f"; did you mean {near[0]}?" if near else ""
        message = f"{path}: cannot be read: {data}{advice}"
        raise InputError(message)
    try:
        text = decode(path, data)
    except ValueError as error:
        raise InputError(str(error)) from None
    return loads(text, str(path), overrides)


def loads(text: str, file: str = "fleet.toml", overrides: tuple[Override, ...] = ()) -> Fleet:
    """Read a fleet from TOML text; errors name it `file`.

    Raises:
        InputError: If it or its scenario has errors; the message lists all of them.
    """
    document = Document(file, text)
    findings = Findings()
    findings.errors += document.errors(json.dumps(fleet_schema()))
    scenario = find_scenario(findings, document, Path(file).parent, overrides)
    world = None if scenario is None else metric_world(findings, document, scenario)
    entries = [] if world is None else read_entries(findings, document, world)
    if world is not None:
        check_entries(findings, document, world, entries)
    if world is None or findings.errors:
        raise findings.exception()
    waypoints_m = {each.name: each.waypoints_m for each in entries if each.waypoints_m is not None}
    warnings = fleet_warnings(document, world, entries)
    plan = fleet_plan(document, world, entries, warnings)
    return Fleet(file, text, world.scenario, plan, waypoints_m, warnings)


def is_fleet_file(file: Path) -> bool:
    """Return whether a file is meant to be a fleet, not a scenario, as far as it can be read."""
    data = read_file(file, MAX_BYTES)
    if isinstance(data, str):
        return False
    try:
        values = Document(str(file), decode(file, data)).values()
    # An InputError is a ValueError, too.
    except ValueError:
        return False
    return "engine" not in values and ("scenario" in values or _has_driver(values.get("robots")))


def _has_driver(robots: object) -> bool:
    tables = robots.values() if isinstance(robots, dict) else ()
    return any(isinstance(each, dict) and "driver" in each for each in tables)

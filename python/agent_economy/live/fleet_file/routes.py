"""The straight ways that the robots of a fleet go, from their start or waypoint to waypoint."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, islice, pairwise
from typing import Any

from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Path
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
from agent_economy.live.legs import Leg
from agent_economy.live.plan import Point

Listed = tuple[Path, Point, bool]
"""A waypoint with its path, and whether it is one of the fleet file."""

MAX_SHARED = 2000
"""Maximum number of ways between shared waypoints that are checked."""


@dataclass(frozen=True)
class Way:
    """A straight way to a waypoint.

    Attributes:
        leg: Where it begins and ends.
        path: The path of its waypoint: in the fleet file, or in the scenario.
        is_own: Whether the waypoint is one of the fleet file.
    """

    leg: Leg
    path: Path
    is_own: bool = False


def ways_of(entry: Entry, kind: ScenarioKind) -> Iterator[Way]:
    """Yield the ways that a robot goes in its order; none to the first without a fixed start."""
    ordered: list[Listed] = []
    for path, behaviour in kind.behaviours():
        found = [(each, point, False) for each, point in _listed(path, behaviour)]
        if behaviour["kind"] == "correct":
            ordered += found
        elif behaviour["kind"] == "navigate" and not _is_shared(behaviour):
            yield from _chain(entry, kind, _assigned(found, behaviour, entry.index))
    for index, point in enumerate(entry.waypoints_m or ()):
        ordered.append(((*entry.path, "waypoints_m", index), point, True))
    yield from _chain(entry, kind, ordered)


def shared_ways(entry: Entry, kind: ScenarioKind) -> Iterator[Way]:
    """Yield the ways that a robot may go: between its start and each two shared waypoints."""
    return islice(_shared_ways(entry, kind), MAX_SHARED)


def _shared_ways(entry: Entry, kind: ScenarioKind) -> Iterator[Way]:
    start_m = kind.start_m(entry.index)
    for path, behaviour in kind.behaviours():
        if behaviour["kind"] != "navigate" or not _is_shared(behaviour):
            continue
        found = list(_listed(path, behaviour))
        if start_m is not None:
            yield from (Way((start_m, point), each) for each, point in found)
        pairs = combinations(found, 2)
        yield from (Way((before, point), each) for (_, before), (each, point) in pairs)


def _chain(entry: Entry, kind: ScenarioKind, waypoints: Sequence[Listed]) -> Iterator[Way]:
    start_m = kind.start_m(entry.index)
    if start_m is not None:
        waypoints = [((), start_m, False), *waypoints]
    for (_, before, _), (path, point, is_own) in pairwise(waypoints):
        yield Way((before, point), path, is_own)


def _listed(path: Path, behaviour: Mapping[str, Any]) -> Iterator[tuple[Path, Point]]:
    for index, (x, y) in enumerate(behaviour.get("waypoints_m", [])):
        yield (*path, "waypoints_m", index), (float(x), float(y))


def _is_shared(behaviour: Mapping[str, Any]) -> bool:
    return bool(behaviour.get("assignment") == "shared")


def _assigned(found: list[Listed], behaviour: Mapping[str, Any], index: int) -> list[Listed]:
    if found and behaviour.get("assignment", "all") == "one_each":
        return [found[index % len(found)]]
    return found


def shown(point: Point) -> str:
    """Return a point for a message."""
    return f"[{point[0]:g}, {point[1]:g}]"


def rounded(point: Point) -> Point:
    """Return a point in whole centimetres."""
    return round(point[0], 2), round(point[1], 2)

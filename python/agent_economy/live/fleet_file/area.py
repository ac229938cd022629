"""Fences and waypoints: a fence is in the world, and contains what its robot is to do.

A robot goes straight from waypoint to waypoint, as far as walls let it.
"""

from collections.abc import Sequence

from agent_economy import _core
from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, Path
from agent_economy.live.fleet_file.routes import rounded, shown, ways_of
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
from agent_economy.live.legs import exit_of, is_within
from agent_economy.live.plan import Point


def check_area(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Report a fence that is no area of the world, and places that are outside of it."""
    if entry.waypoints_m and not kind.takes_orders:
        allowed = f"omitted, because the brain of {kind.name} has no behaviour correct"
        findings.error(fleet, (*entry.path, "waypoints_m"), allowed)
    for index, point in enumerate(entry.waypoints_m or ()):
        if not kind.of.contains(point):
            at: Path = (*entry.path, "waypoints_m", index)
            findings.error(fleet, at, f"a point of the world, {_world(kind)}")
        else:
            _check_room(findings, fleet, (*entry.path, "waypoints_m", index), point, kind)
    fence = entry.fence_m
    if fence is None:
        return
    path = (*entry.path, "fence_m")
    for index, corner in enumerate(fence):
        if not kind.of.contains(corner):
            findings.error(fleet, (*path, index), f"a point of the world, {_world(kind)}")
    wrong = _core.polygon_error(fence)
    if wrong is not None:
        findings.error(fleet, path, wrong)
    else:
        _check_inside(findings, fleet, entry, kind)
        _check_ways(findings, fleet, entry, kind)


def check_room(findings: Findings, kind: ScenarioKind) -> None:
    """Report waypoints of a kind's brain at which its robots would touch a wall."""
    for path, point in kind.waypoints():
        _check_room(findings, kind.of.document, path, point, kind)


def _check_inside(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Report the start and the waypoints of a robot that are outside of its fence."""
    path = (*entry.path, "fence_m")
    start = kind.start_m(entry.index)
    for point in _outside(entry, [] if start is None else [start]).values():
        where = f"{shown(point)}, where {entry.name} starts in the scenario"
        findings.error(fleet, path, f"the corners of an area with {where}")
    for point in _outside(entry, kind.waypoints_m()).values():
        where = f"the waypoint {shown(point)} of the scenario's brain"
        findings.error(fleet, path, f"the corners of an area with {where}")
    for index, point in _outside(entry, entry.waypoints_m or ()).items():
        if kind.of.contains(point):
            at: Path = (*entry.path, "waypoints_m", index)
            findings.error(fleet, at, "a point inside the fence of the robot, fence_m")


def _check_ways(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Report ways out of a fence; those from and to places outside of it are reported already."""
    fence = entry.fence_m or ()
    for way in ways_of(entry, kind):
        left_m = exit_of(way.leg, fence)
        if left_m is None or not all(is_within(end, fence) for end in way.leg):
            continue
        leg = f"the leg from {shown(way.leg[0])} to {shown(way.leg[1])}"
        where = f"leaves the fence at {shown(rounded(left_m))}"
        if way.is_own:
            allowed = f"a waypoint that is reached inside the fence: {leg} {where}"
            findings.error(fleet, way.path, allowed)
        else:
            allowed = f"the corners of an area with {leg}, a waypoint of the scenario's brain"
            findings.error(fleet, (*entry.path, "fence_m"), f"{allowed}: it {where}")


def _check_room(
    findings: Findings, document: Document, path: Path, point: Point, kind: ScenarioKind
) -> None:
    radius_m = kind.radius_m
    near = None if radius_m is None else kind.of.indexed_walls.near(point, radius_m)
    if near is not None:
        wall, distance_m = near
        where = f"{distance_m:.2g} m from" if distance_m else "inside"
        allowed = (
            f"a point at least {radius_m:g} m, the radius of the robot, from each obstacle: it is "
            f"{where} {wall.name}"
        )
        findings.error(document, path, allowed)


def _outside(entry: Entry, points: Sequence[Point]) -> dict[int, Point]:
    """Return the points that are outside of the fence of a robot, by index."""
    are_in = _core.polygon_contains(entry.fence_m or (), points)
    return {index: points[index] for index, is_in in enumerate(are_in) if not is_in}


def _world(kind: ScenarioKind) -> str:
    width_m, height_m = kind.of.world["size_m"]
    return f"from [0, 0] to [{width_m:g}, {height_m:g}]"

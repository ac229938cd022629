"""Fences and waypoints: a fence is in the world, and contains what its robot is to do."""

from collections.abc import Sequence

from agent_economy import _core
from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, Path
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
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


def _check_inside(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Report the start and the waypoints of a robot that are outside of its fence."""
    path = (*entry.path, "fence_m")
    start = kind.start_m(entry.index)
    for point in _outside(entry, [] if start is None else [start]).values():
        where = f"{_shown(point)}, where {entry.name} starts in the scenario"
        findings.error(fleet, path, f"the corners of an area with {where}")
    for point in _outside(entry, kind.waypoints_m()).values():
        where = f"the waypoint {_shown(point)} of the scenario's brain"
        findings.error(fleet, path, f"the corners of an area with {where}")
    for index, point in _outside(entry, entry.waypoints_m or ()).items():
        if kind.of.contains(point):
            at: Path = (*entry.path, "waypoints_m", index)
            findings.error(fleet, at, "a point inside the fence of the robot, fence_m")


def _outside(entry: Entry, points: Sequence[Point]) -> dict[int, Point]:
    """Return the points that are outside of the fence of a robot, by index."""
    are_in = _core.polygon_contains(entry.fence_m or (), points)
    return {index: points[index] for index, is_in in enumerate(are_in) if not is_in}


def _world(kind: ScenarioKind) -> str:
    width_m, height_m = kind.of.world["size_m"]
    return f"from [0, 0] to [{width_m:g}, {height_m:g}]"


def _shown(point: Point) -> str:
    return f"[{point[0]:g}, {point[1]:g}]"

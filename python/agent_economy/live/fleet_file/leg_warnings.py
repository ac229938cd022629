"""Warnings about straight ways that robots may be unable to go, one line for all of a list."""

from collections.abc import Iterable

from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, Path
from agent_economy.live.fleet_file.routes import rounded, shared_ways, shown, ways_of
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
from agent_economy.live.legs import Leg, exit_of
from agent_economy.live.plan import Wall


def warn_of_exits(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Warn if a robot may leave its fence between waypoints that a team shares.

    Which of the ways it goes is not known before; a way that it goes for certain is an error.
    """
    if entry.fence_m is None:
        return
    ways = list(shared_ways(entry, kind))
    exits = [(way.leg, exit_of(way.leg, entry.fence_m)) for way in ways]
    found = [(leg, left_m) for leg, left_m in exits if left_m is not None]
    if found:
        leg, left_m = found[0]
        effect = (
            f"{len(found)} of the {len(ways)} straight ways between shared waypoints leave the "
            f"fence, as from {_ends(leg)} at {shown(rounded(left_m))}; a robot that goes one is "
            "stopped"
        )
        findings.warn(fleet, (*entry.path, "fence_m"), effect)


def warn_of_walls(
    findings: Findings, fleet: Document, entries: Iterable[Entry], kind: ScenarioKind
) -> None:
    """Warn if robots of a kind cannot go straight on: once for each list of waypoints."""
    radius_m = kind.radius_m
    if radius_m is None or not kind.of.walls:
        return
    lists: dict[tuple[bool, Path], dict[Leg, Wall | None]] = {}
    for entry in entries:
        for way in (*ways_of(entry, kind), *shared_ways(entry, kind)):
            legs = lists.setdefault((way.is_own, tuple(way.path[:-1])), {})
            if way.leg not in legs:
                crossed = kind.of.indexed_walls.crossed(way.leg, radius_m)
                legs[way.leg] = crossed and crossed[0]
    for (is_own, path), legs in lists.items():
        if any(legs.values()):
            findings.warn(fleet if is_own else kind.of.document, path, _effect(legs))


def _effect(legs: dict[Leg, Wall | None]) -> str:
    """Return the effect of walls on the ways of a list, one of which crosses a wall at least."""
    crossing = {leg: wall for leg, wall in legs.items() if wall is not None}
    leg, wall = next(iter(crossing.items()))
    if len(crossing) == 1:
        return (
            f"the straight way from {_ends(leg)} crosses {wall.name}: the robot has to find a way "
            "around"
        )
    return (
        f"{len(crossing)} of {len(legs)} straight ways cross obstacles, as from {_ends(leg)} "
        f"({wall.name}): the robots have to find ways around"
    )


def _ends(leg: Leg) -> str:
    return f"{shown(leg[0])} to {shown(leg[1])}"

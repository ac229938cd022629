"""The plan of a fleet without errors."""

import math
from collections.abc import Iterable

from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind, ScenarioWorld
from agent_economy.live.fleet_file.sensors import input_plan
from agent_economy.live.fleet_file.sources import scans_of, sources_of
from agent_economy.live.fleet_file.timing import lateness_s, lifetime_s
from agent_economy.live.fleet_file.walls import for_plan
from agent_economy.live.plan import FleetPlan, Origin, RobotPlan
from agent_economy.scenario import ScenarioWarning

REPEAT_S = 0.2
"""Maximum time between two motor lines of the same motion."""

LINES_PER_DEADMAN = 3
"""Motor lines within the time after which a robot stops by itself: two may be lost."""


def fleet_plan(
    fleet: Document,
    world: ScenarioWorld,
    entries: Iterable[Entry],
    warnings: Iterable[ScenarioWarning],
) -> FleetPlan:
    """Return the plan of a fleet."""
    given = fleet.values()
    width_m, height_m = world.world["size_m"]
    return FleetPlan(
        origin=Origin(**(world.origin or {})),
        robots=tuple(_robot(each, world.kind(each.kind)) for each in entries),
        period_s=world.step_s,
        setpoint_lifetime_s=lifetime_s(given),
        max_lateness_s=lateness_s(given),
        warnings=tuple(map(str, warnings)),
        size_m=(float(width_m), float(height_m)),
        walls=for_plan(world.walls),
    )


def _robot(entry: Entry, kind: ScenarioKind) -> RobotPlan:
    ports = entry.driver.ports
    inputs = [input_plan(port, entry, kind) for port in ports if port.quantity]
    deadman_s = entry.deadman_s
    return RobotPlan(
        name=entry.name,
        driver=entry.driver.name,
        host=entry.host,
        ports=entry.ports,
        settings=entry.settings,
        inputs=tuple(inputs),
        max_speed_m_s=kind.max_speed_m_s,
        max_turn_rate_rad_s=math.radians(kind.drive["max_turn_rate_deg_s"]),
        manual_speed_m_s=entry.manual_speed_m_s(kind.max_speed_m_s),
        min_battery=entry.min_battery,
        fence_m=entry.fence_m,
        deadman_s=deadman_s,
        takes_orders=kind.takes_orders,
        radius_m=kind.radius_m,
        sensors=sources_of(entry, kind),
        scans=scans_of(entry, kind),
        repeat_s=REPEAT_S if deadman_s is None else min(REPEAT_S, deadman_s / LINES_PER_DEADMAN),
    )

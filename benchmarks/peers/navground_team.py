"""The sensing team on navground: `FIELD.json lidar`, `FIELD.json HL` or `FIELD.json ORCA`.

Its sensors and its behaviours do not go together: those that avoid each other know exactly what is
within range and cast no rays, and the one that may have a ring of rays drives straight on.
"""

import math
import random
import sys

from navground import core, sim

from measure import NOISE_M, RADIUS_M, RANGE_M, RAYS, SPEED_M_S, STEP_S, Field, Run, field, report

WORKS = {
    "lidar": "16 rays with noise, C++; no brain: straight to waypoints; collisions",
    "HL": "no rays: exact geometry within 3 m; its behaviour HL; collisions",
    "ORCA": "no rays: exact geometry within 3 m; its behaviour ORCA; collisions",
}


def main() -> None:
    """Measure the work that the command names."""
    work = sys.argv[2]
    stands = field()

    def start() -> Run:
        team = world(stands, work)
        return lambda steps: team.run(steps, STEP_S)

    report("navground", WORKS[work], len(stands.robots), start)


def world(stands: Field, work: str) -> sim.World:
    """Return walls, pillars, and robots that drive from waypoint to waypoint."""
    made = sim.World()
    for start, end in stands.walls():
        made.add_wall(core.LineSegment(start, end))
    for x, y, radius_m in stands.pillars:
        made.add_obstacle(core.Disc((x, y), radius_m))
    chance = random.Random(1)  # noqa: S311 (no secret)
    for x, y, heading_rad in stands.robots:
        agent = robot(work, [waypoint(stands, chance) for _ in range(20)])
        agent.pose = core.Pose2((x, y), heading_rad)
        made.add_agent(agent)
    return made


def waypoint(stands: Field, chance: random.Random) -> tuple[float, float]:
    """Return a place on the field."""
    return chance.uniform(1, stands.side_m - 1), chance.uniform(1, stands.side_m - 1)


def robot(work: str, waypoints: list[tuple[float, float]]) -> sim.Agent:
    """Return a robot with what the work asks for."""
    drive = core.kinematics.TwoWheelsDifferentialDriveKinematics(
        max_speed=SPEED_M_S, wheel_axis=1.5 * RADIUS_M
    )
    behavior = core.Behavior.make_type("Dummy" if work == "lidar" else work)
    behavior.kinematics = drive
    behavior.radius = RADIUS_M
    behavior.optimal_speed = SPEED_M_S
    behavior.horizon = RANGE_M
    if work == "lidar":
        behavior.environment_state_type = "Sensing"
    task = sim.tasks.WaypointsTask(waypoints=waypoints, loop=True, tolerance=0.5)
    return sim.Agent(RADIUS_M, behavior, drive, task, [sensor(work)], STEP_S)


def sensor(work: str) -> sim.StateEstimation:
    """Return a ring of rays, or exact knowledge of what is near."""
    if work != "lidar":
        return sim.state_estimations.BoundedStateEstimation(RANGE_M, update_static_obstacles=True)
    return sim.state_estimations.LidarStateEstimation(
        range=RANGE_M,
        start_angle=0.0,
        field_of_view=math.tau * (RAYS - 1) / RAYS,
        resolution=RAYS,
        error_std_dev=NOISE_M,
    )


if __name__ == "__main__":
    main()

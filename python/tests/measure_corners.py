"""Measures how often robots touch corners between two rays, and how far they drive.

Random worlds of slanted boxes and thin walls, range sensors with few and many rays, several speeds,
and scans that are lost or late.
"""

import argparse
import math
import statistics
from itertools import product
from random import Random
from typing import NamedTuple

from metric import world

from agent_economy import Scenario, run

WORLD = world("""
clock.time_limit_s = 50
world = {{ size_m = [16, 12], obstacles = [{obstacles}] }}
items.mine = {{ target = false, count = 1 }}
[robots.rover]
count = 1
radius_m = {radius_m}
[robots.rover.drive]
max_speed_m_s = {speed_m_s}
max_acceleration_m_s2 = {braking}
max_turn_rate_deg_s = 120
[robots.rover.sensors]
laser = {{ kind = "range", rays = {rays}, range_m = 8, rate_hz = {rate_hz}{faults} }}
[robots.rover.brain]
rate_hz = 10
behaviours = [{{ kind = "cruise" }}, {{ kind = "{way}" }}]
""")

RAYS = [16, 24, 36, 48, 72, 90, 120, 180, 360]
SPEEDS_M_S = [1.0, 1.5, 2.0]
SCANS = {
    "10 Hz": (10, ""),
    "1 Hz": (1, ""),
    "dropout 0.7": (10, ", dropout_probability = 0.7"),
    "latency 0.5 s": (10, ", latency_s = 0.5"),
}


class Row(NamedTuple):
    """The contacts of a run, and the distance driven."""

    contacts: int
    distance_m: float


def slanted(random: Random, length_m: float, width_m: float) -> str:
    """Return a rectangle at a random place and angle as an obstacle of a scenario."""
    x, y, angle = random.uniform(1, 15), random.uniform(1, 11), random.uniform(0, math.pi)
    ahead, aside = math.cos(angle), math.sin(angle)
    corners = [
        (-length_m, -width_m),
        (length_m, -width_m),
        (length_m, width_m),
        (-length_m, width_m),
    ]
    polygon = [
        [x + (along * ahead - across * aside) / 2, y + (along * aside + across * ahead) / 2]
        for along, across in corners
    ]
    return f"{{ polygon_m = {polygon} }}"


def scenario(rays: int, speed_m_s: float, scans: str, number: int) -> Scenario:
    """Return a random world; the same for the same number."""
    random = Random(number)  # noqa: S311
    boxes = [slanted(random, random.uniform(0.3, 2), random.uniform(0.3, 2)) for _ in range(6)]
    walls = [slanted(random, random.uniform(0.5, 4), 0.1) for _ in range(6)]
    rate_hz, faults = SCANS[scans]
    text = WORLD.format(
        obstacles=", ".join(boxes + walls),
        radius_m=random.choice([0.2, 0.3]),
        braking=random.choice([1.0, 3.0]),
        way=random.choice(["avoid", "random_bounce"]),
        speed_m_s=speed_m_s,
        rays=rays,
        rate_hz=rate_hz,
        faults=faults,
    )
    return Scenario.loads(text)


def measured(rays: int, speed_m_s: float, scans: str, number: int) -> Row:
    """Return what a robot did in a random world."""
    row = run(scenario(rays, speed_m_s, scans, number), seed=number).row
    return Row(row["collisions"], row["distance_m"])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=96, help="for each speed and kind of scans")
    worlds: int = parser.parse_args().worlds
    print("| rays | scans | runs | runs with contacts | contacts | median m |")
    print("|---" * 6 + "|")
    for rays, scans in product(RAYS, SCANS):
        rows = [
            measured(rays, speed, scans, number)
            for speed, number in product(SPEEDS_M_S, range(worlds))
        ]
        touched = sum(row.contacts > 0 for row in rows)
        contacts = sum(row.contacts for row in rows)
        median_m = statistics.median(row.distance_m for row in rows)
        print(
            f"| {rays} | {scans} | {len(rows)} | {touched} | {contacts} | {median_m:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()

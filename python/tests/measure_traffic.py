"""Measures contacts and progress of robots that see each other late.

Robots with beliefs drive to the same waypoints, on both sides of pillars and of an aisle.
"""

import argparse
from itertools import product
from random import Random

from metric import world

from agent_economy import Scenario, run

WORLD = world("""
clock.time_limit_s = 120
world = {{ size_m = [16, 12], obstacles = [{obstacles}] }}
items.mine = {{ target = false, count = 1 }}
[robots.rover]
count = 6
radius_m = 0.25
[robots.rover.drive]
max_speed_m_s = {speed_m_s}
max_acceleration_m_s2 = {braking}
max_turn_rate_deg_s = 90
[robots.rover.sensors]
laser = {{ kind = "range", rays = 72, range_m = 8 }}
gps = {{ kind = "position", noise_m = 0.02, rate_hz = 5 }}
compass = {{ kind = "heading", noise_deg = 1, rate_hz = 5 }}
eye = {{ kind = "robots", range_m = 8, latency_s = {latency_s} }}
[robots.rover.brain]
arbitration = {{ kind = "goals" }}
behaviours = [{{ kind = "navigate", waypoints_m = {waypoints} }}]
beliefs.cell_m = 0.5
""")

LATENCIES_S = [0.0, 0.1, 0.3, 0.5, 1.0]
PILLARS = ", ".join(
    f"{{ circle = {{ at_m = [{x}, {y}], radius_m = 0.5 }} }}" for x in (4, 8, 12) for y in (4, 8)
)
AISLE = (
    "{ rectangle = { at_m = [8, 2.25], size_m = [6, 4.5] } }, "
    "{ rectangle = { at_m = [8, 9.75], size_m = [6, 4.5] } }"
)
WORLDS = {"pillars": PILLARS, "aisle of 3 m": AISLE}


def scenario(name: str, latency_s: float, number: int) -> Scenario:
    """Return a world with robots that see each other late; the same for the same number."""
    random = Random(number)  # noqa: S311
    left = [[random.uniform(1, 4), random.uniform(1, 11)] for _ in range(20)]
    right = [[random.uniform(12, 15), random.uniform(1, 11)] for _ in range(20)]
    waypoints = [list(at) for pair in zip(left, right, strict=True) for at in pair]
    text = WORLD.format(
        obstacles=WORLDS[name],
        speed_m_s=random.choice([1.0, 2.0]),
        braking=random.choice([1.0, 3.0]),
        latency_s=latency_s,
        waypoints=waypoints,
    )
    return Scenario.loads(text)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=16)
    runs: int = parser.parse_args().runs
    print("| world | latency | runs | runs with contacts | contacts | mean m |")
    print("|---" * 6 + "|")
    for name, latency_s in product(WORLDS, LATENCIES_S):
        rows = [run(scenario(name, latency_s, number), seed=number).row for number in range(runs)]
        contacts = [row["collisions"] for row in rows]
        touched = sum(count > 0 for count in contacts)
        mean_m = sum(row["distance_m"] for row in rows) / runs
        print(
            f"| {name} | {latency_s} s | {runs} | {touched} | {sum(contacts)} | {mean_m:.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()

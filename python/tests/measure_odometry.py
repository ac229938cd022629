"""Measures how well poses are known where odometry is wrong by constant factors.

A robot drives and turns. It measures its motion with a constant factor, and its heading and
position with noise once per second; a brain with beliefs steps with these percepts.
"""

import argparse
import math
from itertools import product
from random import Random
from typing import TYPE_CHECKING

from agent_economy import Brain

if TYPE_CHECKING:
    from agent_economy.types.brain import Body, Motion, Percept

SCALES = [1.0, 1.02, 1.05, 1.1, 1.2]
NOISES_M = [0.2, 0.5, 1.5]
NOISE_RAD = math.radians(3)
PERIOD_S = 0.1
STEPS, WARM_UP = 1800, 100


def brain(noise_m: float) -> Brain:
    """Return a brain with beliefs."""
    body: Body = {
        "radius_m": 0.25,
        "max_speed_m_s": 1.0,
        "max_acceleration_m_s2": None,
        "max_turn_rate_rad_s": 1.5,
        "period_s": PERIOD_S,
        "position_noise_m": noise_m,
        "heading_noise_rad": NOISE_RAD,
        "field": [[-500.0, -500.0], [500.0, 500.0]],
    }
    behaviours = [{"kind": "navigate", "waypoints_m": [[0.0, 0.0]]}]
    return Brain({"behaviours": behaviours, "beliefs": {"cell_m": 10.0}}, body)


def deviations(scales: tuple[float, float], noise_m: float, seed: int) -> list[float]:
    """Return the error of the position after each step, in stated standard deviations."""
    random = Random(seed)  # noqa: S311
    robot = brain(noise_m)
    x = y = heading = 0.0
    off = []
    for step in range(STEPS):
        turns = step // 50 % 4 == 3
        speed, rate = (0.0, random.choice([-0.5, 0.5])) if turns else (0.8, 0.1)
        heading += rate * PERIOD_S
        x += speed * PERIOD_S * math.cos(heading - rate * PERIOD_S / 2)
        y += speed * PERIOD_S * math.sin(heading - rate * PERIOD_S / 2)
        motion: Motion = {"speed_m_s": speed * scales[0], "turn_rate_rad_s": rate * scales[1]}
        percept: Percept = {
            "time_s": step * PERIOD_S,
            "motion": {"value": motion, "age_s": 0.0},
        }
        if step % 10 == 0:
            at = [x + random.gauss(0, noise_m), y + random.gauss(0, noise_m)]
            percept["position"] = {"value": at, "age_s": 0.0}
            measured_rad = math.remainder(heading + random.gauss(0, NOISE_RAD), math.tau)
            percept["heading_rad"] = {"value": measured_rad, "age_s": 0.0}
        robot.step(percept)
        state = robot.belief_state()
        pose = state["pose"] if state else None
        if pose and step >= WARM_UP:
            away_m = math.dist(pose["at"], (x, y))
            off.append(away_m / pose["deviation_m"])
    return off


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=8)
    seeds: int = parser.parse_args().seeds
    print("| error of | noise | " + " | ".join(f"{scale - 1:.0%}" for scale in SCALES) + " |")
    print("|---" * (len(SCALES) + 2) + "|")
    for (name, of), noise_m in product([("speed", 0), ("turn rate", 1)], NOISES_M):
        cells = []
        for scale in SCALES:
            scales = (scale, 1.0) if of == 0 else (1.0, scale)
            off = [each for seed in range(seeds) for each in deviations(scales, noise_m, seed)]
            within = [sum(each <= count for each in off) / len(off) for count in (2, 3)]
            cells.append("; ".join(f"{share:.2f}" for share in within))
        print(f"| {name} | {noise_m} m | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
